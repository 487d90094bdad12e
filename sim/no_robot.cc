#include "sidestep/sim/no_robot.h"

#include <stdexcept>

namespace sidestep::sim {

void NoRobot::Submit(const Trajectory&, EpisodeTime) {
  throw std::invalid_argument("NoRobot: there is none to follow a trajectory");
}

void NoRobot::AdvanceTo(EpisodeTime t) {
  const std::int64_t last = World::TickNotBefore(t);
  while (world_.ticks() < last) world_.Step(Eigen::VectorXd());
}

}  // namespace sidestep::sim
