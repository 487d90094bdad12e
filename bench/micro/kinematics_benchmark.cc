#include <benchmark/benchmark.h>

#include "sidestep/robot/robot_model.h"

namespace sidestep::bench {
namespace {

// How long the centres of the Panda's spheres take, with and without their Jacobian.
void BM_SphereCenters(benchmark::State& state) {
  const bool with_jacobian = state.range(0) != 0;
  const robot::RobotModel robot =
      robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", "panda", Pose());
  const Eigen::VectorXd q = robot.configurations().at("right_ready");
  for (auto _ : state) benchmark::DoNotOptimize(robot.ComputeSphereCenters(q, with_jacobian));
  state.SetItemsProcessed(state.iterations() * robot.num_spheres());
}
BENCHMARK(BM_SphereCenters)->ArgName("jacobian")->Arg(0)->Arg(1);

}  // namespace
}  // namespace sidestep::bench
