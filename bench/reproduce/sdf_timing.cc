#include "sidestep/bench/reproduce/sdf_timing.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "sidestep/bench/report/html_page.h"
#include "sidestep/bench/reproduce/published_columns.h"
#include "sidestep/bench/reproduce/size_figure.h"
#include "sidestep/bench/statistics.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/number_text.h"

namespace sidestep::bench {
namespace {

constexpr double kFieldMargin_m = 0.2;
constexpr EpisodeTime kFirstSeen(0.2), kSecondSeen(0.6);
constexpr int kMoments = 31;

// A measure of each prediction, and what the published file calls the mean of the same thing.
struct TimedMeasure {
  const char* name;
  const char* words;
  const char* published;  // empty: not published
  double PredictionTimes::*value;
};
constexpr TimedMeasure kTimedMeasures[] = {
    {"full_computation_ms", "full computation", "full_computation_mean_ms",
     &PredictionTimes::full_s},
    {"dense_composite_ms", "dense composite", "composite_prediction_mean_ms",
     &PredictionTimes::dense_s},
    {"incremental_composite_ms", "incremental composite", "", &PredictionTimes::incremental_s},
    {"lazy_composite_ms", "lazy composite, making it", "", &PredictionTimes::lazy_s},
    {"lazy_query_ms", "lazy composite, a query", "", &PredictionTimes::query_s},
};
constexpr const char* kInit = "composite_init_ms";
constexpr const char* kPublishedInit = "composite_init_mean_ms";

std::string Name(const char* measure, const char* statistic) {
  return std::string(measure) + "_" + statistic;
}

void AppendQuantiles(std::vector<std::optional<double>>& row, const std::vector<double>& values_s) {
  for (const double p : {0.5, 0.1, 0.9}) row.emplace_back(1e3 * Quantile(values_s, p));
}

double Get(const CsvTable& table, std::size_t row, const std::string& column) {
  return table.At(row, table.Find(column).value()).value();
}

std::string FormatTime(double ms) {
  if (ms >= 1) return FiniteText("{:.3g} ms", ms);
  if (ms >= 1e-3) return FiniteText("{:.3g} us", 1e3 * ms);
  return FiniteText("{:.0f} ns", 1e6 * ms);
}

// What the table shows of a size: medians, in brackets the published means.
struct Entry {
  std::string words, text;
};
std::vector<Entry> Entries(const CsvTable& ours, std::size_t row,
                           const std::optional<CsvTable>& published) {
  const double voxels = Get(ours, row, kVoxelsColumn);
  const auto text = [&](const char* measure, const std::string& their_column) {
    std::string cell = FormatTime(Get(ours, row, Name(measure, "median")));
    if (const auto theirs = PublishedAt(published, voxels, their_column)) {
      cell += " (" + FiniteText("{:.3g}", *theirs) + ")";
    }
    return cell;
  };
  std::vector<Entry> entries = {{"initialisation", text(kInit, kPublishedInit)}};
  for (const TimedMeasure& measure : kTimedMeasures) {
    entries.push_back({measure.words, text(measure.name, measure.published)});
  }
  const auto ratio = [&](const char* measure) {
    return FiniteText("{:.3g}", Get(ours, row, "full_computation_ms_median") /
                                    Get(ours, row, Name(measure, "median")));
  };
  entries.push_back({"full / dense", ratio("dense_composite_ms")});
  const auto full = PublishedAt(published, voxels, "full_computation_mean_ms");
  const auto dense = PublishedAt(published, voxels, "composite_prediction_mean_ms");
  if (full && dense) entries.back().text += " (" + FiniteText("{:.3g}", *full / *dense) + ")";
  return entries;
}

}  // namespace

std::vector<SdfTimingSize> RunSdfTiming(const SdfTimingOptions& options,
                                        const std::string& scenarios_dir,
                                        const std::function<void(int done)>& on_size) {
  std::vector<SdfTimingSize> sizes;
  for (const int voxels : options.voxels_per_side) {
    SdfTimingSize size;
    const GridSpec grid = PublishedTimingGrid(voxels);
    size.voxels_per_side = voxels;
    size.cell_m = grid.cell_m;
    for (const std::string& name : options.scenes) {
      const scenarios::Scenario scene = LoadBoxScene(scenarios_dir + "/" + name + ".yaml");
      for (int repeat = 0; repeat < options.repeats; ++repeat) {
        FieldTimer timer(scene, grid, kFieldMargin_m, kFirstSeen, kSecondSeen);
        size.init_s.push_back(timer.init_s());
        for (int moment = 0; moment < kMoments; ++moment) {
          const EpisodeTime t(moment / 10.0);
          size.predictions.push_back(timer.Time(t));
          if (repeat > 0 || !timer.HoldsAllObjects(t)) continue;
          const CompositeError error = timer.Compare(t);
          ++size.num_compared;
          size.largest_error.free_m = std::max(size.largest_error.free_m, error.free_m);
          size.largest_error.inside_m = std::max(size.largest_error.inside_m, error.inside_m);
        }
      }
    }
    sizes.push_back(std::move(size));
    if (on_size) on_size(static_cast<int>(sizes.size()));
  }
  return sizes;
}

CsvTable MakeSdfTimingTable(const std::vector<SdfTimingSize>& sizes) {
  std::vector<std::string> columns = {kVoxelsColumn, "cell_size_m", "n_predictions",
                                      "n_init_values"};
  const auto add_columns = [&columns](const char* measure) {
    for (const char* const statistic : {"median", "q10", "q90"}) {
      columns.push_back(Name(measure, statistic));
    }
  };
  add_columns(kInit);
  for (const TimedMeasure& measure : kTimedMeasures) add_columns(measure.name);
  columns.insert(columns.end(), {"n_compared", "largest_error_free_m", "largest_error_inside_m"});
  CsvTable table(columns);
  for (const SdfTimingSize& size : sizes) {
    std::vector<std::optional<double>> row = {size.voxels_per_side, size.cell_m,
                                              static_cast<double>(size.predictions.size()),
                                              static_cast<double>(size.init_s.size())};
    AppendQuantiles(row, size.init_s);
    for (const TimedMeasure& measure : kTimedMeasures) {
      AppendQuantiles(row, Collect(size.predictions, measure.value));
    }
    row.insert(row.end(),
               {size.num_compared, size.largest_error.free_m, size.largest_error.inside_m});
    table.AddRow(std::move(row));
  }
  return table;
}

Figure MakeSdfTimingFigure(const CsvTable& ours, const std::optional<CsvTable>& published) {
  std::vector<SizeCurve> curves;
  const auto add = [&](const char* measure, const char* words, const char* their_column) {
    SizeCurve& curve = curves.emplace_back();
    curve.words = words;
    for (std::size_t row = 0; row < ours.num_rows(); ++row) {
      const double voxels = Get(ours, row, kVoxelsColumn);
      curve.voxels.push_back(voxels);
      curve.y.push_back(Get(ours, row, Name(measure, "median")));
      curve.low.push_back(Get(ours, row, Name(measure, "q10")));
      curve.high.push_back(Get(ours, row, Name(measure, "q90")));
      const auto value = PublishedAt(published, voxels, their_column);
      if (!value) continue;
      curve.published_voxels.push_back(voxels);
      curve.published_y.push_back(*value);
    }
  };
  add(kInit, "initialisation", kPublishedInit);
  for (const TimedMeasure& measure : kTimedMeasures)
    add(measure.name, measure.words, measure.published);
  return MakeSizeFigure("Cost of a field on one core", "ms", curves);
}

std::string DescribeSdfTiming(const CsvTable& ours, const std::optional<CsvTable>& published) {
  std::string text = "medians";
  text += published ? " (in brackets the published means, ms)\n" : "\n";
  for (std::size_t row = 0; row < ours.num_rows(); ++row) {
    text += fmt::format("{:.0f} voxels a side, {:g} m\n", Get(ours, row, kVoxelsColumn),
                        Get(ours, row, "cell_size_m"));
    for (const Entry& entry : Entries(ours, row, published)) {
      text += fmt::format("  {:<28} {}\n", entry.words, entry.text);
    }
    text += fmt::format("  {:<28} {:g} m in free space, {:g} m inside obstacles ({:.0f} fields)\n",
                        "composite off the exact by", Get(ours, row, "largest_error_free_m"),
                        Get(ours, row, "largest_error_inside_m"), Get(ours, row, "n_compared"));
  }
  return text;
}

std::string MakeSdfTimingPage(const SdfTimingOptions& options, const CsvTable& ours,
                              const std::optional<CsvTable>& published,
                              const std::string& svg_path) {
  HtmlPage page("sdf_timing: what a predicted distance field costs");
  page.Paragraph(
      "After table 1 of M. Finean, W. Merkt, I. Havoutis, \"Predicted Composite Signed-Distance "
      "Fields for Real-Time Motion Planning in Dynamic Environments\", ICAPS 2021. Objects are "
      "seen twice and predicted at 31 moments. The field of each moment is computed anew from the "
      "predicted map (full computation), or composed of the fields of the static part and the "
      "objects: as a grid (dense, as in the paper), as a grid from that of the moment before "
      "(incremental), or when it is asked (lazy).");
  page.Paragraph(fmt::format(
      "Scenes: {}. Times are CPU times of one core, medians over scenes, moments and {} repeats.",
      Joined(options.scenes), options.repeats));
  if (published) {
    page.Paragraph(
        "In brackets the published means in ms, of MATLAB's bwdist on another machine: "
        "compare the ratios, not the times.");
  }
  if (!svg_path.empty()) {
    page.Picture(svg_path, "Medians with 10 % and 90 % quantiles as bands, over the grid's size.");
  }
  TextTable times = {{"voxels a side"}};
  TextTable errors = {{"voxels a side", "fields compared", "largest difference in free cells [m]",
                       "inside obstacles [m]"}};
  for (std::size_t row = 0; row < ours.num_rows(); ++row) {
    times.push_back({FiniteText("{:.0f}", Get(ours, row, kVoxelsColumn))});
    errors.push_back({times.back().front(), FiniteText("{:.0f}", Get(ours, row, "n_compared")),
                      FiniteText("{:g}", Get(ours, row, "largest_error_free_m")),
                      FiniteText("{:g}", Get(ours, row, "largest_error_inside_m"))});
    for (const Entry& entry : Entries(ours, row, published)) {
      if (row == 0) times.front().push_back(entry.words);
      times.back().push_back(entry.text);
    }
  }
  page.Table(times);
  page.Heading("Is the composite the same field?");
  page.Paragraph(
      "At cell centres, where objects are moved by whole cells, the composite equals the exact "
      "field in all free cells within the margin. Inside obstacles that touch or overlap it may "
      "underestimate the depth. Compared where every object lies wholly in the grid: beyond it, "
      "the composite knows more than the grid.");
  page.Table(errors);
  return page.ToText();
}

}  // namespace sidestep::bench
