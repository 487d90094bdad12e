#pragma once

#include <string>

#include "sidestep/record/recording.h"

namespace sidestep::render {

/// How the sample episode goes.
struct SampleEpisode {
  std::string knowledge = "prediction";
  bool contact = false;     ///< the arm touches the trolley at 1.00 s, for 0.1 s
  double duration_s = 2.0;  ///< the trolley passes within it
};

/// A three-link arm (green) on a table (brown) swings towards another table, while a trolley (blue)
/// drives through between them; in the second half of each sample, the plan of the last cycle is in
/// force. Made by hand: nothing is simulated.
record::Recording MakeSampleRecording(const SampleEpisode& episode);

/// Where the trolley is expected to be, and is: X_WO at time t, and half its size [m].
Pose TrolleyPoseAt(double t_s);
inline constexpr double kTrolleySpeed_m_s = 1.2;

}  // namespace sidestep::render
