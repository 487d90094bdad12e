// The arm of hardware_single_table under the profile `lab`, and a box that moves at random but
// within what it is declared to do. The arm may be touched at rest, never in motion.
// SIDESTEP_EPISODES says how many episodes are run.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>
#include <memory>
#include <string>

#include "sidestep/bench/episode.h"
#include "sidestep/bench/resolve.h"
#include "sidestep/core/random.h"
#include "sidestep/record/questions.h"
#include "sidestep/sim/simulation.h"

namespace sidestep {
namespace {

using Eigen::Vector3d;

const std::string kSource = SIDESTEP_SOURCE_DIR;
constexpr double kMoving_rad_s = 1e-3;

// Comes from all sides, through where the arm works.
scenarios::Motion RandomMotion(RandomStream& random) {
  const double side_rad = random.Uniform(-2.6, 2.6);
  const double height_m = random.Uniform(0.2, 0.9);
  const Vector3d start_m(1.2 * std::cos(side_rad), 1.2 * std::sin(side_rad), height_m);
  const Vector3d through_m(random.Uniform(0.1, 0.6), random.Uniform(-0.6, 0.4), height_m);
  const Vector3d direction = (through_m - start_m).normalized();
  const double speed_m_s = random.Uniform(0.1, 0.48);
  constexpr double kNever = 1e9;
  switch (random.Bits() % 3) {
    case 0:
      return scenarios::LinearMotion{start_m, direction, speed_m_s, kNever, 0};
    case 1:
      return scenarios::AcceleratedMotion{
          start_m, direction, speed_m_s, random.Uniform(-1.9, 1.9), random.Uniform(0, 5),
          0.48,    kNever,    0};
    default: {
      // Its acceleration is v^2 / r.
      const double radius_m = std::max(speed_m_s * speed_m_s / 1.9, random.Uniform(0.2, 0.8));
      return scenarios::CircleMotion{through_m + Vector3d(radius_m, 0, 0),
                                     radius_m,
                                     random.Uniform(-1.5, 1.5),
                                     random.Bits() % 2 == 0,
                                     speed_m_s,
                                     kNever,
                                     0};
    }
  }
}

bool BeginsFarFromTheArm(const scenarios::MovingObstacle& box) {
  const Vector3d p_W = PoseAt(box, EpisodeTime(0)).translation();
  return (p_W - Vector3d(0, -0.3, 0.5)).norm() > 0.75;
}

// Whether the arm was told to move when it was touched first.
bool IsTouchedInMotion(const record::Recording& recording) {
  const auto touch = record::FirstTouch(recording);
  if (!touch) return false;
  for (const ControlSample& tick : recording.control) {
    if (std::abs((tick.t - touch->t).seconds()) < 2e-3 && tick.v_command.norm() > kMoving_rad_s) {
      return true;
    }
  }
  return false;
}

TEST(SupervisedEpisodes, InWhichTheBoxKeepsToItsEnvelopeNeverTouchAMovingArm) {
  const char* const wanted = std::getenv("SIDESTEP_EPISODES");
  const int episodes = wanted == nullptr ? 200 : std::atoi(wanted);
  ASSERT_GT(episodes, 0);
  scenarios::Scenario scenario = scenarios::LoadScenario(
      kSource + "/scenarios/hardware_single_table.yaml",
      {{"sensor",
        "{name: tags, rate_hz: 30, tags: {position_m: [2, 0, 2], across_noise: 0, "
        "along_noise_per_m: 0}}"}});
  ASSERT_EQ(scenario.safety.profile, scenarios::SafetyProfile::kLab);
  const robot::RobotModel robot =
      robot::RobotModel::Load(kSource + "/models", scenario.robot, scenario.X_WB);
  bench::ResolveTask(scenario, robot);
  const auto make_world = [](const scenarios::Scenario& of, const robot::RobotModel& model) {
    return bench::MakeEpisodeWorld(
        std::make_shared<sim::Simulation>(of, model, kSource + "/models"));
  };

  RandomStream random(1, "supervised episodes");
  std::map<std::string, int> outcomes, checks;
  int touched_in_motion = 0, touched_at_rest = 0;
  for (int episode = 0; episode < episodes; ++episode) {
    scenarios::MovingObstacle& box = scenario.moving_obstacles.front();
    do {
      box.motion = RandomMotion(random);
    } while (!BeginsFarFromTheArm(box));
    const bench::EpisodeResult result = bench::RunEpisode(scenario, robot, make_world);
    ++outcomes[ToString(result.outcome)];
    for (const SafetyEvent& event : result.recording.safety) ++checks[event.check];
    const bool in_motion = IsTouchedInMotion(result.recording);
    touched_in_motion += in_motion ? 1 : 0;
    touched_at_rest += !in_motion && record::FirstTouch(result.recording) ? 1 : 0;
    EXPECT_FALSE(in_motion) << "episode " << episode << ": "
                            << record::FirstTouch(result.recording)->t.seconds() << " s";
  }
  std::cout << episodes << " episodes; touched in motion " << touched_in_motion << ", at rest "
            << touched_at_rest << "\n";
  for (const auto& [outcome, count] : outcomes) std::cout << outcome << " " << count << "\n";
  for (const auto& [check, count] : checks) std::cout << check << " " << count << "\n";
  EXPECT_GT(checks["stop_path"] + checks["clearance"], 0) << "nothing came near";
}

}  // namespace
}  // namespace sidestep
