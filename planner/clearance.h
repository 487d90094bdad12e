#pragma once

#include <limits>
#include <vector>

#include "core/time.h"
#include "core/trajectory.h"
#include "robot/robot_model.h"
#include "sdf/distance_field.h"

namespace sidestep {

/// The spheres that obstacle costs and checks look at, all but mount spheres: indices, ascending.
std::vector<int> GuardedSpheres(const RobotModel& robot);

/// How close a motion comes to what a field holds.
struct Clearance {
  /// Least field distance - sphere radius [m]; no more than the field's clamp - smallest radius.
  double least_m = std::numeric_limits<double>::infinity();
  EpisodeTime t;                 ///< when
  int samples_outside_grid = 0;  ///< sphere positions outside the mapped box, not judged
};

/// Samples the cubics of `trajectory`, which began at `start`, from `from` to its end, every 0.02 s
/// and at the end: the judge of plans, because a small cost does not mean free nor a large one
/// collision. Before its start and after its end the motion rests; `from` past the end judges the
/// last state at `from`.
Clearance MeasureClearance(const RobotModel& robot, const DistanceField& field,
                           const Trajectory& trajectory, EpisodeTime start, EpisodeTime from);

}  // namespace sidestep
