#include "sidestep/bench/reproduce/closed_loop.h"

#include "sidestep/core/number_text.h"

namespace sidestep::bench {
namespace {

constexpr int kMainGrid = 96;           // voxels per side of the publication's figures
constexpr int kStepOfRates = 10;        // predictions are timed from this step on
constexpr double kSceneMargin_m = 0.2;  // of the published timings
constexpr int kSteps = 31;
constexpr double kPublishedStep_s = 0.1;

EpisodeTime TimeOfStep(int step) { return EpisodeTime(step * kPublishedStep_s); }

// The fields of all later steps, as step `now` predicts them.
void TimeStep(const scenarios::Scenario& scene, const GridSpec& grid, double margin_m, int now,
              std::vector<double>& init_s, std::vector<PredictionTimes>& predictions) {
  FieldTimer timer(scene, grid, margin_m, TimeOfStep(now - 1), TimeOfStep(now));
  init_s.push_back(timer.init_s());
  for (int k = now + 1; k < kSteps; ++k) predictions.push_back(timer.Time(TimeOfStep(k)));
}

}  // namespace

Factors PublishedSettings(double speed_m_s) {
  return {{"planner.epsilon_m", "0.3"}, {"planner.sigma_obs", "0.05"},
          {"planner.n_int", "0"},       {"sensor.rate_hz", "10"},
          {"predictor", "two_frame"},   {"speed_m_s", ShortestText(speed_m_s)}};
}

std::string CellsValue(int voxels_per_side) {
  const std::string side = std::to_string(voxels_per_side);
  return "[" + side + ", " + side + ", " + side + "]";
}

void TimeWholeRun(const scenarios::Scenario& scene, const GridSpec& grid, double margin_m,
                  WholeRunTimes& times) {
  for (int now = 1; now + 1 < kSteps; ++now) {
    TimeStep(scene, grid, margin_m, now, times.init_s, times.predictions);
  }
}

ClosedLoopStudy RunClosedLoopStudy(const ClosedLoopLoader& load, const WorldFactory& make_world,
                                   const std::string& scenarios_dir,
                                   const ClosedLoopOptions& options,
                                   const std::function<void(const std::string&)>& on_part) {
  const auto say = [&on_part](const std::string& what) {
    if (on_part) on_part(what);
  };
  ClosedLoopStudy study;
  const auto load_with = [&](const Factors& varied) {
    Factors all = PublishedSettings(options.speed_m_s);
    all.insert(varied.begin(), varied.end());
    return load(all);
  };
  const auto run = [&](const std::string& knowledge, int voxels_per_side) {
    say(knowledge + ", " + std::to_string(voxels_per_side) + " voxels per side");
    const Factors varied = {{"knowledge", knowledge}, {kCellsFactor, CellsValue(voxels_per_side)}};
    const ClosedLoopCase published = load_with(varied);
    EpisodeResult result = RunEpisode(published.scenario, published.robot, make_world);
    RequireWhole(result);
    RunRow& row = study.rows.emplace_back(RowOf(result, published.scenario));
    row.factors = varied;
    row.identity = published.identity;
    return result;
  };
  study.update = run("execute_and_update", kMainGrid);
  study.prediction = run("prediction", kMainGrid);

  for (const int voxels : options.voxels_per_side) {
    LoopRate& rate = study.rates.emplace_back();
    rate.voxels_per_side = voxels;
    rate.cycle_s =
        (voxels == kMainGrid ? study.prediction : run("prediction", voxels)).times.at("cycle");
    const ClosedLoopCase published = load_with({{kCellsFactor, CellsValue(voxels)}});
    const scenarios::Scenario& scene = published.scenario;
    std::vector<double> init_s;
    TimeStep(scene, scene.grid, scene.epsilon_m + published.robot.largest_sphere_radius_m(),
             kStepOfRates, init_s, rate.predictions);
  }
  for (const std::string& name : FieldSceneNames()) {
    say("435 predictions of " + name);
    TimeWholeRun(LoadBoxScene(scenarios_dir + "/" + name + ".yaml"), PublishedTimingGrid(kMainGrid),
                 kSceneMargin_m, study.whole_run);
  }
  return study;
}

}  // namespace sidestep::bench
