#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "sidestep/core/time.h"
#include "sidestep/core/trajectory.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sdf/distance_field.h"

namespace sidestep::bench {

struct FreePath {
  bool found = false;
  int guesses = 0;         ///< tried until then
  double clearance_m = 0;  ///< of the best motion: least over all spheres and times
  Trajectory trajectory;   ///< the best motion; its time 0 is when the search begins
};

/// Where and how a motion begins.
struct PathStart {
  EpisodeTime t;
  Eigen::VectorXd q, v;  ///< rad and rad/s, shape n each
};

/// Looks long for a motion from start to goal that touches nothing, knowing where everything will
/// be: the scenario's planner is run on the exact distance to the true shapes from many guesses,
/// the direct motion and `max_guesses` - 1 random ones (a via configuration off the straight line,
/// and the share of the time at which it is passed). What it finds is judged by the exact clearance
/// of the collision spheres, to each other too, each 5 ms, until half a second after the goal; the
/// robot rests for the scenario's latency first, as it does in an episode. A motion whose tool is
/// faster than `safety.tool_speed_m_s` does not count; where there is such a limit, every other
/// guess is tried with half as much time again. It proves that a free motion exists; not finding
/// one proves nothing.
/// @param scenario with its task resolved (bench/resolve.h).
FreePath SearchFreePath(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                        int max_guesses, std::uint64_t seed);

/// The same from the midst of an episode, in the world that `field` tells of: the motion begins at
/// once, with the velocity that the arm has.
/// @throws std::invalid_argument for a start of another shape, or one that is not finite.
FreePath SearchFreePathFrom(const PathStart& start, const sdf::DistanceField& field,
                            const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                            int max_guesses, std::uint64_t seed);

}  // namespace sidestep::bench
