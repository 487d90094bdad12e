#pragma once

#include "sidestep/bench/reproduce/open_loop_experiment.h"
#include "sidestep/core/trajectory.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::bench {

/// How close a motion comes to the experiment's boxes as they are: exact, where they were meant to
/// stand, moving on between the steps. Least distance minus radius over the robot's spheres, mount
/// spheres left out [m]; negative: it hits.
struct TrueClearance {
  double moving_m = 0;  ///< to the moving box, along the whole motion
  double static_m = 0;  ///< to the static boxes, along the whole motion
  double states_m = 0;  ///< to all boxes, but at support states alone

  double motion_m() const { return moving_m < static_m ? moving_m : static_m; }
};

/// Sampled every 5 ms. The published verdict differs in three ways: it knows voxels (static ones a
/// cell low), it looks at support states alone, and outside its grid everything is free.
TrueClearance MeasureTrueClearance(const OpenLoopExperiment& experiment,
                                   const robot::RobotModel& robot, const Trajectory& trajectory,
                                   double speed_m_s);

}  // namespace sidestep::bench
