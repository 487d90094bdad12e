#include "sidestep/bench/reproduce/closed_loop_report.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sidestep/bench/report/html_page.h"
#include "sidestep/bench/reproduce/published_columns.h"
#include "sidestep/bench/reproduce/size_figure.h"
#include "sidestep/bench/statistics.h"
#include "sidestep/core/number_text.h"

namespace sidestep::bench {
namespace {

constexpr double kPlotStep_s = 0.01;  // a point each, of the control rate's 1 kHz

// The columns of the rates: name, words, and whether a line of the figure.
struct RateColumn {
  const char* column;
  const char* words;
  const char* published;  // column of ours for the published figure; empty: none
};
constexpr RateColumn kRates[] = {
    {"update_fastest_hz", "update, shortest cycle", "published_update_fastest_hz"},
    {"update_median_hz", "update, median cycle", "published_update_median_hz"},
    {"update_slowest_hz", "update, longest cycle", "published_update_slowest_hz"},
    {"dense_prediction_hz", "prediction, dense composite", "published_prediction_hz"},
    {"lazy_prediction_hz", "prediction, lazy composite", ""},
};

// The authors' summary of 435 predictions in each of five scenes, ten times, at 96 voxels a side:
// least, median, mean, greatest [ms].
struct Summary {
  const char* words;
  double least_ms, median_ms, mean_ms, greatest_ms;
};
constexpr Summary kPublishedWholeRun[] = {{"full computation", 26.2, 29.7, 29.9, 41.2},
                                          {"initialisation", 26.8, 30.9, 30.8, 42.8},
                                          {"composite (dense)", 1.354, 1.539, 1.697, 6.759}};

Summary Summarise(const char* words, const std::vector<double>& values_s) {
  double mean = 0;
  for (const double value : values_s) mean += value / static_cast<double>(values_s.size());
  return {words, 1e3 * Quantile(values_s, 0), 1e3 * Quantile(values_s, 0.5), 1e3 * mean,
          1e3 * Quantile(values_s, 1)};
}

std::vector<Summary> SummariseWholeRun(const WholeRunTimes& times) {
  return {Summarise("full computation", Collect(times.predictions, &PredictionTimes::full_s)),
          Summarise("initialisation", times.init_s),
          Summarise("composite (dense)", Collect(times.predictions, &PredictionTimes::dense_s)),
          Summarise("composite (incremental)",
                    Collect(times.predictions, &PredictionTimes::incremental_s)),
          Summarise("composite (lazy)", Collect(times.predictions, &PredictionTimes::lazy_s))};
}

std::vector<std::string> Cells(const Summary& summary) {
  return {summary.words, FiniteText("{:.3g}", summary.least_ms),
          FiniteText("{:.3g}", summary.median_ms), FiniteText("{:.3g}", summary.mean_ms),
          FiniteText("{:.3g}", summary.greatest_ms)};
}

Panel JointPanel(const std::string& title, const std::string& y_label,
                 const record::Recording& recording, Eigen::VectorXd ControlSample::*value,
                 bool with_key) {
  Panel panel;
  panel.title = title;
  panel.x_label = "s";
  panel.y_label = y_label;
  const int num_joints = static_cast<int>(recording.q_start.size());
  for (int j = 0; j < num_joints; ++j) {
    Series series;
    series.style = Series::Style::kPlainLine;
    series.color = j;
    if (with_key) series.title = "joint " + std::to_string(j + 1);
    double next_s = 0;
    for (const ControlSample& sample : recording.control) {
      if (sample.t.seconds() < next_s) continue;
      next_s += kPlotStep_s;
      series.x.push_back(sample.t.seconds());
      series.y.push_back((sample.*value)(j));
    }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

std::vector<std::string> RunCells(const char* words, const EpisodeResult& result) {
  const auto& metrics = result.recording.metrics;
  double fastest = 0;
  for (const ControlSample& sample : result.recording.control) {
    fastest = std::max(fastest, sample.v.cwiseAbs().maxCoeff());
  }
  return {words,
          ToString(result.outcome),
          FiniteText("{:.0f} mm", 1e3 * metrics.at("min_clearance_m")),
          FiniteText("{:.2f} s", metrics.at("time_to_goal_s")),
          FiniteText("{:.1f}", metrics.at("gp_cost")),
          FiniteText("{:.2f} rad/s", fastest),
          FiniteText("{:.1f} ms", 1e3 * Quantile(result.times.at("cycle"), 0.5))};
}

TextTable RunRows(const ClosedLoopStudy& study) {
  return {{"planner knows", "outcome", "least clearance", "time to goal", "GP cost",
           "fastest joint", "median cycle"},
          RunCells("execute and update", study.update),
          RunCells("prediction", study.prediction)};
}

TextTable WholeRunRows(const WholeRunTimes& times) {
  TextTable rows = {{"", "least", "median", "mean", "greatest"}};
  for (const Summary& summary : SummariseWholeRun(times)) rows.push_back(Cells(summary));
  for (const Summary& summary : kPublishedWholeRun) {
    rows.push_back(Cells(summary));
    rows.back()[0] = "published: " + rows.back()[0];
  }
  return rows;
}

// Ours, and in brackets the published figure if there is one.
TextTable RateRows(const CsvTable& rates) {
  TextTable rows = {{"voxels a side"}};
  for (const RateColumn& rate : kRates) rows[0].push_back(rate.words);
  for (std::size_t row = 0; row < rates.num_rows(); ++row) {
    rows.push_back({FiniteText("{:.0f}", rates.At(row, 0).value())});
    for (const RateColumn& rate : kRates) {
      std::string cell =
          FiniteText("{:.3g} Hz", rates.At(row, rates.Find(rate.column).value()).value());
      const auto column = rates.Find(rate.published);
      if (column && rates.At(row, *column)) {
        cell += " (" + FiniteText("{:.3g}", *rates.At(row, *column)) + ")";
      }
      rows.back().push_back(cell);
    }
  }
  return rows;
}

}  // namespace

CsvTable MakeRatesTable(const ClosedLoopStudy& study, const PublishedRates& published) {
  std::vector<std::string> columns = {kVoxelsColumn, "n_cycles"};
  for (const RateColumn& rate : kRates) columns.emplace_back(rate.column);
  for (const RateColumn& rate : kRates) {
    if (*rate.published != '\0') columns.emplace_back(rate.published);
  }
  CsvTable table(columns);
  for (const LoopRate& rate : study.rates) {
    const auto hz = [](const std::vector<double>& values_s, double p) {
      return std::optional(1 / Quantile(values_s, p));
    };
    std::vector<std::optional<double>> row = {
        rate.voxels_per_side,
        static_cast<double>(rate.cycle_s.size()),
        hz(rate.cycle_s, 0),
        hz(rate.cycle_s, 0.5),
        hz(rate.cycle_s, 1),
        hz(Collect(rate.predictions, &PredictionTimes::dense_s), 0.5),
        hz(Collect(rate.predictions, &PredictionTimes::lazy_s), 0.5)};
    for (const char* const column : {"fastest_rate_hz", "median_rate_hz", "slowest_rate_hz"}) {
      row.push_back(PublishedAt(published.loops, rate.voxels_per_side, column));
    }
    const auto prediction_s =
        PublishedAt(published.predictions, rate.voxels_per_side, "composite_prediction_s");
    row.push_back(prediction_s ? std::optional(1 / *prediction_s) : std::nullopt);
    table.AddRow(std::move(row));
  }
  return table;
}

CsvTable MakeWholeRunTable(const WholeRunTimes& times) {
  CsvTable table({"kind", "n_values", "least_ms", "median_ms", "mean_ms", "greatest_ms"});
  double kind = 0;
  for (const Summary& summary : SummariseWholeRun(times)) {
    const bool is_init = kind == 1;
    table.AddRow({++kind,
                  static_cast<double>(is_init ? times.init_s.size() : times.predictions.size()),
                  summary.least_ms, summary.median_ms, summary.mean_ms, summary.greatest_ms});
  }
  return table;
}

Figure MakeJointsFigure(const ClosedLoopStudy& study) {
  Figure figure;
  figure.columns = 2;
  figure.panel_height_px = 340;
  const record::Recording &update = study.update.recording,
                          &prediction = study.prediction.recording;
  figure.panels = {
      JointPanel("Execute and update: positions", "rad", update, &ControlSample::q, false),
      JointPanel("Prediction: positions", "rad", prediction, &ControlSample::q, false),
      JointPanel("Execute and update: velocities", "rad/s", update, &ControlSample::v, true),
      JointPanel("Prediction: velocities", "rad/s", prediction, &ControlSample::v, true)};
  return figure;
}

Figure MakeRatesFigure(const CsvTable& rates) {
  std::vector<SizeCurve> curves;
  for (const RateColumn& rate : kRates) {
    SizeCurve& curve = curves.emplace_back();
    curve.words = rate.words;
    const auto their_column = rates.Find(rate.published);
    for (std::size_t row = 0; row < rates.num_rows(); ++row) {
      const double voxels = rates.At(row, 0).value();
      curve.voxels.push_back(voxels);
      curve.y.push_back(rates.At(row, rates.Find(rate.column).value()).value());
      if (!their_column || !rates.At(row, *their_column)) continue;
      curve.published_voxels.push_back(voxels);
      curve.published_y.push_back(*rates.At(row, *their_column));
    }
  }
  return MakeSizeFigure("Rates on one core", "Hz", curves);
}

std::string DescribeClosedLoop(const ClosedLoopStudy& study, const PublishedRates& published) {
  std::string text = ToText(RunRows(study)) + "\nrates (published)\n" +
                     ToText(RateRows(MakeRatesTable(study, published))) +
                     "\n435 predictions in each of five scenes, 96 voxels a side [ms]\n";
  return text + ToText(WholeRunRows(study.whole_run));
}

std::string MakeClosedLoopPage(const ClosedLoopOptions& options, const ClosedLoopStudy& study,
                               const PublishedRates& published, const std::string& joints_svg,
                               const std::string& rates_svg) {
  HtmlPage page("closed_loop: the published closed-loop study");
  page.Paragraph(
      "After M. Finean, W. Merkt, I. Havoutis, \"Predicted Composite Signed-Distance Fields for "
      "Real-Time Motion Planning in Dynamic Environments\", ICAPS 2021. A Panda on one table "
      "reaches for another while an HSR drives through between them at " +
      FiniteText("{:g} m/s", options.speed_m_s) +
      ". The loop is this product's own: predictions hold for the right moments, plans take effect "
      "after their latency, and a tracker within the arm's limits follows them.");
  page.Table(RunRows(study));
  if (!joints_svg.empty()) {
    page.Picture(joints_svg,
                 "Measured joint positions and velocities, execute and update (left) "
                 "and prediction (right).");
  }
  page.Heading("Rates");
  page.Paragraph(
      "Update rate: one over the CPU time of a planning cycle, from the observation to the plan, "
      "of the shortest, the median and the longest cycle of a run. Prediction rate: one over the "
      "median time of making the field of one later step. In brackets and as rings the stored "
      "figures of the authors, of another machine.");
  if (!rates_svg.empty()) page.Picture(rates_svg, "Rates over the size of the grid.");
  page.Table(RateRows(MakeRatesTable(study, published)));
  page.Heading("The predictions of a whole run");
  page.Paragraph(
      "Each step from the second on predicts the fields of all the steps that remain: 435 in a "
      "run, in each of the five field scenes, at 96 voxels a side. Times in ms.");
  page.Table(WholeRunRows(study.whole_run));
  return page.ToText();
}

}  // namespace sidestep::bench
