#include "bench/reproduce/open_loop_study.h"

#include <mutex>
#include <numeric>
#include <stdexcept>

#include "bench/reproduce/parallel.h"
#include "bench/reproduce/published_maps.h"

namespace sidestep {
namespace {

OpenLoopResult RunCase(const OpenLoopExperiment& experiment, const RobotModel& robot,
                       const OpenLoopTask& task, const std::vector<const DistanceField*>& truth,
                       Knowledge knowledge, bool once) {
  const auto map = [&](int step) -> const DistanceField& {
    return *truth[static_cast<std::size_t>(step)];
  };
  switch (knowledge) {
    case Knowledge::kStatic:
      return RunOpenLoop(
          experiment, robot, task, [&](int, int) -> auto& { return map(0); }, truth, once);
    case Knowledge::kExecuteAndUpdate:
      return RunOpenLoop(
          experiment, robot, task, [&](int now, int) -> auto& { return map(now); }, truth, false);
    case Knowledge::kFullKnowledge:
      return RunOpenLoop(
          experiment, robot, task, [&](int, int k) -> auto& { return map(k); }, truth, once);
    case Knowledge::kPrediction:
      break;
  }
  throw std::invalid_argument("no open-loop protocol for " + ToString(knowledge));
}

}  // namespace

OpenLoopStudy RunOpenLoopStudy(const OpenLoopExperiment& experiment, const std::string& models_dir,
                               const OpenLoopStudyOptions& options,
                               const std::function<void(int done, int all)>& on_row) {
  const int num_pairs = static_cast<int>(experiment.pairs.size());
  std::vector<int> pairs = options.pairs;
  if (pairs.empty()) {
    pairs.resize(experiment.pairs.size());
    std::iota(pairs.begin(), pairs.end(), 1);
  }
  const std::string& robot_file =
      options.intended_geometry ? experiment.own_robot : experiment.published_robot;
  const RobotModel robot = RobotModel::FromFile(models_dir + "/" + robot_file, experiment.X_WB);

  OpenLoopStudy study;
  study.ignored_spheres = robot.mount_spheres();
  for (const int pair : pairs) {
    if (pair < 1 || pair > num_pairs) {
      throw std::invalid_argument(experiment.name + " has pairs 1 to " + std::to_string(num_pairs) +
                                  ", not " + std::to_string(pair));
    }
    for (const double speed_m_s : experiment.speeds_m_s)
      study.rows.push_back({pair, speed_m_s, {}});
  }

  const PublishedMaps maps(
      experiment, options.intended_geometry ? BoxAlignment::kIntended : BoxAlignment::kOneCellLow,
      DistanceConvention::kBwdist, options.num_jobs);

  std::mutex mutex;
  int done = 0;
  const int num_rows = static_cast<int>(study.rows.size());
  ParallelFor(num_rows, options.num_jobs, [&](int i) {
    OpenLoopRow& row = study.rows[static_cast<std::size_t>(i)];
    const auto& [start, goal] = experiment.pairs[static_cast<std::size_t>(row.pair - 1)];
    const OpenLoopTask task{robot.configurations().at(start), robot.configurations().at(goal)};
    const std::vector<const DistanceField*> truth = maps.FieldsAt(row.speed_m_s);
    for (const Knowledge knowledge : options.cases) {
      row.results[knowledge] = RunCase(experiment, robot, task, truth, knowledge, options.once);
    }
    const std::lock_guard lock(mutex);
    ++done;
    if (on_row) on_row(done, num_rows);
  });
  return study;
}

}  // namespace sidestep
