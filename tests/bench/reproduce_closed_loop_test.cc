// The closed-loop study: its settings, its 435 predictions, and what the report makes of figures.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "sidestep/bench/reproduce/closed_loop.h"
#include "sidestep/bench/reproduce/closed_loop_report.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench::reproduce_closed_loop_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(ClosedLoop, TakesThePublishedSettings) {
  Factors settings = PublishedSettings(1.2);
  EXPECT_EQ(settings.extract("speed_m_s").mapped(), "1.2") << "is no key of a scenario";
  settings[kCellsFactor] = CellsValue(64);
  const scenarios::Scenario scenario =
      scenarios::LoadScenario(SIDESTEP_SOURCE_DIR "/scenarios/hsr_walkway.yaml", settings);
  EXPECT_EQ(scenario.epsilon_m, 0.3);
  EXPECT_EQ(scenario.planner_parameters.at("sigma_obs"), "0.05");
  EXPECT_EQ(scenario.planner_parameters.at("n_int"), "0");
  EXPECT_EQ(scenario.sensor.rate_hz, scenario.replan_rate_hz) << "an observation each cycle";
  EXPECT_EQ(scenario.predictor, "two_frame");
  EXPECT_EQ(scenario.grid.size, (std::array<int, 3>{64, 64, 64}));
  EXPECT_EQ(scenario.grid.cell_m, 0.04);
}

TEST(ClosedLoop, PredictsAllRemainingStepsAtEachStep) {
  WholeRunTimes times;
  TimeWholeRun(LoadBoxScene(SIDESTEP_SOURCE_DIR "/scenarios/field_large_block.yaml"),
               PublishedTimingGrid(32), 0.2, times);
  EXPECT_EQ(times.predictions.size(), 435u);
  EXPECT_EQ(times.init_s.size(), 29u);
}

EpisodeResult Episode(const std::string& knowledge) {
  EpisodeResult result;
  result.outcome = Outcome::kGoal;
  result.times["cycle"] = {0.01, 0.02, 0.04};
  result.recording.header["knowledge"] = knowledge;
  result.recording.metrics = {{"min_clearance_m", 0.042}, {"time_to_goal_s", 3}, {"gp_cost", 7}};
  result.recording.q_start = Eigen::VectorXd::Zero(2);
  for (int tick = 0; tick <= 100; ++tick) {
    ControlSample sample;
    sample.t = EpisodeTime(tick / 1000.0);
    sample.q = Eigen::VectorXd::Constant(2, tick);
    sample.v = Eigen::VectorXd::Constant(2, -1.5);
    result.recording.control.push_back(sample);
  }
  return result;
}

ClosedLoopStudy Sample() {
  ClosedLoopStudy study;
  study.update = Episode("execute_and_update");
  study.prediction = Episode("prediction");
  study.rates.push_back({96, {0.01, 0.02, 0.04}, {{0.02, 0.001, 1e-5, 1e-6, 0}}});
  study.whole_run = {{0.003}, {{0.02, 0.001, 1e-5, 1e-6, 0}, {0.03, 0.002, 1e-5, 1e-6, 0}}};
  return study;
}

TEST(ClosedLoopReport, GivesRatesBesideThePublishedOnes) {
  PublishedRates published;
  published.loops = CsvTable({"voxels_per_side", "median_rate_hz"});
  published.loops->AddRow({64, 19});
  published.loops->AddRow({96, 10.9});
  published.predictions = CsvTable({"voxels_per_side", "composite_prediction_s"});
  for (const double prediction_s : {0.001, 0.0025, 0.007}) {
    published.predictions->AddRow({96, prediction_s});
  }
  const CsvTable rates = MakeRatesTable(Sample(), published);
  ASSERT_EQ(rates.num_rows(), 1u);
  const auto at = [&](const char* column) { return rates.At(0, rates.Find(column).value()); };
  EXPECT_DOUBLE_EQ(at("update_fastest_hz").value(), 100);
  EXPECT_DOUBLE_EQ(at("update_median_hz").value(), 50);
  EXPECT_DOUBLE_EQ(at("update_slowest_hz").value(), 25);
  EXPECT_DOUBLE_EQ(at("dense_prediction_hz").value(), 1000);
  EXPECT_DOUBLE_EQ(at("lazy_prediction_hz").value(), 1e6);
  EXPECT_DOUBLE_EQ(at("published_update_median_hz").value(), 10.9);
  EXPECT_DOUBLE_EQ(at("published_prediction_hz").value(), 400) << "of the median";
  EXPECT_FALSE(at("published_update_slowest_hz")) << "the file does not have it";
  EXPECT_THAT(DescribeClosedLoop(Sample(), published),
              AllOf(HasSubstr("50 Hz (10.9)"), HasSubstr("42 mm"), HasSubstr("1.50 rad/s")));
  EXPECT_EQ(MakeRatesFigure(rates).panels.at(0).series.size(), 7u) << "five of ours, two of theirs";
}

TEST(ClosedLoopReport, SumsUpTheWholeRun) {
  const CsvTable table = MakeWholeRunTable(Sample().whole_run);
  ASSERT_EQ(table.num_rows(), 5u);
  EXPECT_DOUBLE_EQ(table.At(0, 2).value(), 20) << "least full computation [ms]";
  EXPECT_DOUBLE_EQ(table.At(0, 4).value(), 25) << "its mean";
  EXPECT_DOUBLE_EQ(table.At(2, 5).value(), 2) << "greatest dense composite";
  EXPECT_EQ(table.At(1, 1).value(), 1) << "one initialisation";
}

TEST(ClosedLoopReport, PlotsEachJointAHundredTimesASecond) {
  const Figure figure = MakeJointsFigure(Sample());
  ASSERT_EQ(figure.panels.size(), 4u);
  for (const Panel& panel : figure.panels) {
    ASSERT_EQ(panel.series.size(), 2u);
    EXPECT_NEAR(static_cast<double>(panel.series[0].x.size()), 11, 1);
  }
  EXPECT_EQ(figure.panels[2].series[0].y[0], -1.5);
}

}  // namespace
}  // namespace sidestep::bench::reproduce_closed_loop_test
