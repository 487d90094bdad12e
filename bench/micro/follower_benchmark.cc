// One tick of the control path, with and without the supervisor.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "sidestep/control/follower.h"

namespace sidestep::control {
namespace {

// A Panda that swings to and fro while things pass it, far off or so near that it would slow down.
void BM_FollowerTick(benchmark::State& state) {
  const robot::RobotModel panda =
      robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", "panda", Pose());
  SafetySettings safety;
  if (state.range(0) > 0) safety.profile = SafetyProfile::kObserve;
  Follower follower(panda, TrackerLimits::Of(panda), safety);

  const bool is_near = state.range(1) != 0;
  constexpr int kStates = 101;
  Trajectory swing;
  swing.t_s = Eigen::VectorXd::LinSpaced(kStates, 0, 10);
  const Eigen::VectorXd home = panda.configurations().at("ready");
  swing.q = home.replicate(1, kStates);
  swing.v = Eigen::MatrixXd::Zero(7, kStates);
  for (int k = 0; k < kStates; ++k) {
    const double w = 3.14159265358979;
    swing.q(0, k) += 0.4 * (1 - std::cos(w * swing.t_s(k)));
    swing.v(0, k) = 0.4 * w * std::sin(w * swing.t_s(k));
  }

  JointPoint commanded = RestAt(home);
  std::vector<double> ticks_us;
  double t_s = 0;
  for (auto _ : state) {
    if (std::fmod(t_s, 10) < 1e-3) follower.Submit(swing, EpisodeTime(t_s));
    if (std::fmod(t_s, 0.03) < 1e-3) {
      ObstacleReport report{EpisodeTime(t_s), {}};
      for (int i = 0; i < state.range(0); ++i) {
        ObstacleState& box = report.obstacles.emplace_back();
        box.t = report.t;
        box.X_WO = Pose::Translation({is_near ? 0.65 : 1.2, 0.3 * i, 0.5});
        box.half_extents_m.setConstant(0.2);
        box.v_W = {0, 0.3, 0};
      }
      follower.Watch(report);
    }
    const auto begin = std::chrono::steady_clock::now();
    commanded =
        follower.Tick({EpisodeTime(t_s), commanded.q, commanded.v, commanded}, HorizonOffset(1e-3))
            .motion;
    const std::chrono::duration<double, std::micro> tick_us =
        std::chrono::steady_clock::now() - begin;
    ticks_us.push_back(tick_us.count());
    state.SetIterationTime(1e-6 * tick_us.count());
    follower.DrainLog([](const TickRecord&) {});
    follower.DrainFindings([](const Finding&) {});
    t_s += 1e-3;
  }
  std::sort(ticks_us.begin(), ticks_us.end());
  const auto at = [&](double share) {
    return ticks_us[static_cast<std::size_t>(share * static_cast<double>(ticks_us.size() - 1))];
  };
  state.counters["p50_us"] = at(0.5);
  state.counters["p99.9_us"] = at(0.999);
}
// No obstacles: without a supervisor.
BENCHMARK(BM_FollowerTick)
    ->ArgNames({"obstacles", "near"})
    ->Args({0, 0})
    ->ArgsProduct({{1, 4, 16}, {0, 1}})
    ->UseManualTime();

}  // namespace
}  // namespace sidestep::control
