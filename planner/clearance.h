#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "sidestep/core/time.h"
#include "sidestep/core/trajectory.h"
#include "sidestep/planner/objective/arm_group.h"
#include "sidestep/planner/self_clearance.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/sdf/distance_field.h"

namespace sidestep::planner {

/// How close a motion comes to what a field holds, and the robot to itself: the judge of plans,
/// because a small cost does not mean free, nor a large one collision.
struct Clearance {
  /// Least field distance - sphere radius [m], mount spheres left out, and least gap between links
  /// of the robot's self_collision(). At most the field's clamp less the smallest radius.
  double least_m = std::numeric_limits<double>::infinity();
  std::optional<EpisodeTime> first_contact;  ///< the first sample at which something touches
  /// Sphere positions outside the mapped box: judged against what is known exactly, the floor above
  /// all, and against moving things, but not against what else may be there.
  int samples_outside_grid = 0;
};

/// Free before not free. Of two that are free, the one that keeps more distance; of two that are
/// not, the one that is free for longer by more than 0.02 s, since until then a way out may be
/// found, else the one that keeps more distance.
bool IsSafer(const Clearance& a, const Clearance& b);

/// Measures motions of one robot, of whom what does not depend on the motion is worked out once.
/// Immutable; safe from many threads.
class ClearanceMeter {
 public:
  /// `robot` is borrowed.
  explicit ClearanceMeter(const robot::RobotModel& robot);

  /// Samples the motion along `trajectory`, which began at `start`, every `step_s` from `from` to
  /// `to`, and at `to`. Before its first and after its last state it rests.
  Clearance Measure(const sdf::DistanceField& field, const Trajectory& trajectory,
                    EpisodeTime start, EpisodeTime from, EpisodeTime to,
                    double step_s = 0.02) const;

 private:
  const robot::RobotModel& robot_;
  std::shared_ptr<const obstacle_kernels::Arm> arm_;
  std::vector<int> spheres_;  // that count
  SelfClearance links_;
};

/// The same for who has few motions.
Clearance MeasureClearance(const robot::RobotModel& robot, const sdf::DistanceField& field,
                           const Trajectory& trajectory, EpisodeTime start, EpisodeTime from,
                           EpisodeTime to, double step_s = 0.02);

}  // namespace sidestep::planner
