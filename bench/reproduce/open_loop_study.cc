#include "sidestep/bench/reproduce/open_loop_study.h"

#include <algorithm>
#include <mutex>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "sidestep/bench/reproduce/predicted_maps.h"
#include "sidestep/bench/reproduce/published_maps.h"
#include "sidestep/bench/task_pool.h"

namespace sidestep::bench {
namespace {

// What the planner believes at solve `now` of step k; `predicted` is asked under prediction only.
BelievedField MakeBelief(sdf::Knowledge knowledge,
                         const std::vector<const sdf::DistanceField*>& truth,
                         const BelievedField& predicted) {
  const auto map = [&truth](int step) -> const sdf::DistanceField& {
    return *truth[static_cast<std::size_t>(step)];
  };
  switch (knowledge) {
    case sdf::Knowledge::kStatic:
      return [map](int, int) -> const sdf::DistanceField& { return map(0); };
    case sdf::Knowledge::kExecuteAndUpdate:
      return [map](int now, int) -> const sdf::DistanceField& { return map(now); };
    case sdf::Knowledge::kPrediction:
      return predicted;
    case sdf::Knowledge::kFullKnowledge:
      return [map](int, int k) -> const sdf::DistanceField& { return map(k); };
  }
  throw std::invalid_argument("not a kind of knowledge");
}

bool KnowsTheWorldBeforehand(sdf::Knowledge knowledge) {
  return knowledge == sdf::Knowledge::kStatic || knowledge == sdf::Knowledge::kFullKnowledge;
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
  const scenarios::Scenario& scene = experiment.scene;
  const robot::RobotModel own_robot = robot::RobotModel::Load(models_dir, scene.robot, scene.X_WB);
  const robot::RobotModel robot =
      options.intended_geometry
          ? own_robot
          : robot::RobotModel::FromFile(models_dir + "/" + experiment.published_robot, scene.X_WB);

  OpenLoopStudy study;
  study.ignored_spheres = robot.mount_spheres();
  for (const int pair : pairs) {
    if (pair < 1 || pair > num_pairs) {
      throw std::invalid_argument(experiment.name + " has pairs 1 to " + std::to_string(num_pairs) +
                                  ", not " + std::to_string(pair));
    }
    for (const double speed_m_s : experiment.speeds_m_s) {
      study.rows.push_back({pair, speed_m_s, {}});
    }
  }

  const PublishedMaps maps(
      experiment, options.intended_geometry ? BoxAlignment::kIntended : BoxAlignment::kOneCellLow,
      kPublishedConvention, options.num_jobs);

  std::optional<PredictedMaps> predicted;
  if (std::find(options.cases.begin(), options.cases.end(), sdf::Knowledge::kPrediction) !=
      options.cases.end()) {
    predicted.emplace(experiment, maps, kPublishedConvention, options.predictor,
                      experiment.epsilon_m + robot.largest_sphere_radius_m(), options.num_jobs);
  }

  std::mutex mutex;
  int done = 0;
  const int num_rows = static_cast<int>(study.rows.size());
  RunTasks(num_rows, options.num_jobs, [&](int i) {
    OpenLoopRow& row = study.rows[static_cast<std::size_t>(i)];
    const auto& [start, goal] = experiment.pairs[static_cast<std::size_t>(row.pair - 1)];
    const OpenLoopTask task{robot.configurations().at(start), robot.configurations().at(goal)};
    const std::vector<const sdf::DistanceField*> truth = maps.FieldsAt(row.speed_m_s);
    const BelievedField ask_prediction = [&](int now, int k) -> const sdf::DistanceField& {
      return predicted->At(row.speed_m_s, now, k);
    };
    for (const sdf::Knowledge knowledge : options.cases) {
      OpenLoopRow::Case& entry = row.cases[knowledge];
      entry.result =
          RunOpenLoop(experiment, robot, task, MakeBelief(knowledge, truth, ask_prediction), truth,
                      options.once && KnowsTheWorldBeforehand(knowledge));
      entry.clearance =
          MeasureTrueClearance(experiment, own_robot, entry.result.trajectory, row.speed_m_s);
    }
    const std::lock_guard lock(mutex);
    ++done;
    if (on_row) on_row(done, num_rows);
  });
  return study;
}

}  // namespace sidestep::bench
