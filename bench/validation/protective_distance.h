#pragma once

namespace sidestep::bench {

/// What the protective separation distance depends on.
struct Separation {
  double obstacle_m_s = 0;  ///< towards the arm
  double robot_m_s = 0;     ///< towards the obstacle
  double reaction_s = 0.12;
  double stop_s = 0, stop_m = 0;  ///< how long the arm takes to stop, and how far it goes
  double uncertainty_m = 0.03;    ///< of both places
};

/// The distance that an arm has to keep from what comes, so as to rest before they touch [m]:
/// S_p = S_h + S_r + S_s + Z. A measure, no safety function.
/// Source: J. Marvel, R. Norcross, "Implementing speed and separation monitoring in collaborative
/// robot workcells", Robotics and Computer-Integrated Manufacturing 44, 2017.
inline double ProtectiveDistance(const Separation& s) {
  const double obstacle_m = s.obstacle_m_s * (s.reaction_s + s.stop_s);
  return obstacle_m + s.robot_m_s * s.reaction_s + s.stop_m + s.uncertainty_m;
}

}  // namespace sidestep::bench
