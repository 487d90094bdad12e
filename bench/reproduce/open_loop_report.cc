#include "sidestep/bench/reproduce/open_loop_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <utility>

#include "sidestep/bench/report/html_page.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/number_text.h"

namespace sidestep::bench {
namespace {

constexpr double kPercent = 100;

std::string Words(sdf::Knowledge knowledge) {
  std::string words = ToString(knowledge);
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string IntervalText(const char* format, const Interval& interval, double scale = 1) {
  return "[" + FiniteText(format, scale * interval.low) + ", " +
         FiniteText(format, scale * interval.high) + "]";
}

// Two curves a kind of knowledge, one point a speed.
void AddCurves(Figure& figure, const std::vector<MatchedOutcomes>& rows, bool is_published) {
  struct Curves {
    Series rate, cost;
  };
  std::map<sdf::Knowledge, Curves> by_knowledge;
  for (const FreeRate& at_speed : FreeRatesBySpeed(rows)) {
    auto& [rate, cost] = by_knowledge[at_speed.knowledge];
    rate.x.push_back(at_speed.speed_m_s);
    rate.y.push_back(kPercent * at_speed.num_free / at_speed.num_rows);
    cost.x.push_back(at_speed.speed_m_s);
    cost.y.push_back(at_speed.mean_gp_cost);
    if (is_published) continue;
    rate.low.push_back(kPercent * at_speed.wilson.low);
    rate.high.push_back(kPercent * at_speed.wilson.high);
  }
  for (auto& [knowledge, curves] : by_knowledge) {
    for (Series* series : {&curves.rate, &curves.cost}) {
      series->color = static_cast<int>(knowledge);
      if (is_published) series->style = Series::Style::kOpenPoints;
      if (!is_published) series->title = Words(knowledge);
    }
    figure.panels[0].series.push_back(std::move(curves.rate));
    figure.panels[1].series.push_back(std::move(curves.cost));
  }
}

std::string DescribeSetup(const OpenLoopExperiment& experiment,
                          const OpenLoopStudyOptions& options) {
  std::string text = fmt::format(
      "sigma_obs {:g}, epsilon {:g} m, {} interpolated obstacle costs an interval, {} speeds from "
      "{:g} to {:g} m/s. ",
      experiment.sigma_obs, experiment.epsilon_m, experiment.num_interpolated,
      experiment.speeds_m_s.size(), experiment.speeds_m_s.front(), experiment.speeds_m_s.back());
  text += options.once ? "Static and full knowledge are solved once. "
                       : "Each motion is solved as often as it has states, pinning one more state "
                         "each time. ";
  text += options.intended_geometry
              ? "Static boxes stand where they were meant to (not as published)."
              : "Static boxes stand one cell low, as in the published maps.";
  return text;
}

std::string DescribeIgnored(const std::vector<int>& spheres) {
  std::string text =
      "Ignored in planning and in both verdicts, because they overlap what the robot "
      "stands on: sphere";
  for (const int s : spheres) text += " " + std::to_string(s);
  return text + ".";
}

std::string InShort(const OpenLoopStudy& study,
                    const std::optional<PublishedComparison>& published) {
  std::string text = "In short: ";
  if (published) {
    text += fmt::format(
        "the counts of colliding states agree with the published ones in {} of {} entries. ",
        published->table.CountsAgreeing(), published->table.CountsCompared());
  }
  const auto verdicts = [](const VerdictCounts& counts) {
    return fmt::format("{} {} and {}", Words(counts.knowledge), counts.free, counts.truly_free);
  };
  return text + fmt::format(
                    "Of {} rows, so many are collision-free by the published verdict, and so many "
                    "by the exact boxes all along the motion: {}.",
                    study.rows.size(), Joined(CountVerdicts(study), ", ", verdicts));
}

void AddPublished(HtmlPage& page, const TableComparison& comparison) {
  page.Heading("Against the published table");
  page.Paragraph(fmt::format(
      "Counts of colliding states agree in {} of {} entries of {} rows. Costs agree if they differ "
      "by no more than a millionth.",
      comparison.CountsAgreeing(), comparison.CountsCompared(), comparison.rows_compared));
  page.Table(MakeTextTable(comparison));
  if (comparison.differences.empty()) return;
  page.Paragraph("Entries that differ:");
  TextTable rows = {{"column", "pair", "m/s", "ours", "published"}};
  for (const EntryDifference& entry : comparison.differences) {
    rows.push_back({entry.column, std::to_string(entry.pair), FiniteText("{:g}", entry.speed_m_s),
                    FiniteText("{:.9g}", entry.ours), FiniteText("{:.9g}", entry.published)});
  }
  page.Table(rows);
}

void AddVerdicts(HtmlPage& page, const OpenLoopStudy& study) {
  page.Heading("Is collision-free free?");
  page.Paragraph(
      "The published verdict looks at the support states alone, in the voxel field that planned, "
      "and takes everything outside the grid as free. Here the same motions are judged by the "
      "exact boxes where they were meant to stand, at the states and then every 5 ms between "
      "them.");
  page.Table(MakeVerdictTable(study));
}

void AddRates(HtmlPage& page, const OpenLoopStatistics& statistics) {
  TextTable rows = {{"planner knows", "free", "rate", "Wilson 95 %", "mean GP cost"}};
  for (const FreeRate& rate : statistics.pooled) {
    rows.push_back({Words(rate.knowledge), Of(rate.num_free, rate.num_rows),
                    FiniteText("{:.1f} %", kPercent * rate.num_free / rate.num_rows),
                    IntervalText("{:.1f}", rate.wilson, kPercent),
                    FiniteText("{:.2f}", rate.mean_gp_cost)});
  }
  page.Table(rows);
}

void AddComparisons(HtmlPage& page, const OpenLoopStatistics& statistics) {
  TextTable rows = {{"matched by start, goal and speed", "only one free", "points of free rate",
                     "McNemar, speeds", "median GP cost", "Wilcoxon, speeds", "of both free"}};
  for (const KnowledgeComparison& c : statistics.comparisons) {
    const int num_speeds = static_cast<int>(c.levels.size());
    rows.push_back({Words(c.first) + " minus " + Words(c.second),
                    std::to_string(c.only_first) + " : " + std::to_string(c.only_second),
                    FiniteText("{:+.1f}", kPercent * c.rate_difference) + " " +
                        IntervalText("{:.1f}", c.rate_interval, kPercent),
                    Of(c.CountSignificantOutcomes(), num_speeds),
                    FiniteText("{:+.2f}", c.median_cost_difference) + " " +
                        IntervalText("{:.2f}", c.cost_interval),
                    Of(c.CountSignificantCosts(&LevelComparison::all), num_speeds),
                    Of(c.CountSignificantCosts(&LevelComparison::both_succeed), num_speeds)});
  }
  page.Table(rows);
}

void AddStatistics(HtmlPage& page, const std::vector<OpenLoopStatistics>& statistics) {
  page.Heading("Statistics");
  page.Paragraph(
      "Brackets hold 95 %: Wilson's for rates; for differences a bootstrap over pairs of start and "
      "goal, whose rows at different speeds resemble each other. \"Speeds\" counts at how many of "
      "them a two-sided test gives p < 0.05 after Holm's adjustment over the speeds: McNemar's "
      "exact test of the outcomes, Wilcoxon's signed ranks of the costs, of all rows and of those "
      "in which both are free. Every figure, with the Hodges-Lehmann shift at each speed, is in "
      "statistics.json.");
  for (const OpenLoopStatistics& filtered : statistics) {
    page.Paragraph(fmt::format(
        "Filter {}: {} rows; excluded {} by their speed and {} in which no published kind of "
        "knowledge is free.",
        ToString(filtered.filter), filtered.num_rows, filtered.excluded_by_speed,
        filtered.excluded_none_free));
    if (filtered.num_rows == 0) continue;
    if (std::none_of(filtered.comparisons.begin(), filtered.comparisons.end(),
                     [](const KnowledgeComparison& c) { return c.CanBeSignificant(); })) {
      page.Paragraph(
          "With so few pairs at so many speeds, no single speed can reach p < 0.05 after "
          "the adjustment, whatever comes out: look at the intervals.");
    }
    AddRates(page, filtered);
    AddComparisons(page, filtered);
  }
}

}  // namespace

std::vector<VerdictCounts> CountVerdicts(const OpenLoopStudy& study) {
  std::map<sdf::Knowledge, VerdictCounts> counts;
  for (const OpenLoopRow& row : study.rows) {
    for (const auto& [knowledge, entry] : row.cases) {
      VerdictCounts& sums = counts[knowledge];
      sums.knowledge = knowledge;
      ++sums.num_rows;
      sums.mean_gp_cost += entry.result.gp_cost;
      if (entry.result.colliding_states != 0) continue;
      ++sums.free;
      sums.truly_free_states += entry.clearance.states_m > 0 ? 1 : 0;
      // A motion has its states too.
      sums.truly_free += entry.clearance.motion_m() > 0 ? 1 : 0;
      sums.deepest_m = std::max(sums.deepest_m, -entry.clearance.motion_m());
    }
  }
  std::vector<VerdictCounts> list;
  for (auto& [knowledge, sums] : counts) {
    sums.mean_gp_cost /= sums.num_rows;
    list.push_back(sums);
  }
  return list;
}

TextTable MakeVerdictTable(const OpenLoopStudy& study) {
  TextTable rows = {{"planner knows", "free as published", "truly free at the states",
                     "and all along", "deepest hit", "mean GP cost"}};
  for (const VerdictCounts& counts : CountVerdicts(study)) {
    rows.push_back({Words(counts.knowledge), Of(counts.free, counts.num_rows),
                    std::to_string(counts.truly_free_states), std::to_string(counts.truly_free),
                    FiniteText("{:.0f} mm", 1e3 * counts.deepest_m),
                    FiniteText("{:.4f}", counts.mean_gp_cost)});
  }
  return rows;
}

Figure MakeOpenLoopFigure(const std::vector<MatchedOutcomes>& ours,
                          const std::vector<MatchedOutcomes>& published) {
  Figure figure;
  figure.columns = 2;
  const std::string rings = published.empty() ? "" : " (rings: published)";
  figure.panels = {
      {"Collision-free" + rings, "speed of the obstacle [m/s]", "%", false, {-3, 103}, {}},
      {"Mean GP cost" + rings, "speed of the obstacle [m/s]", "GP cost", true, {}, {}}};
  AddCurves(figure, ours, false);
  AddCurves(figure, published, true);
  return figure;
}

std::string MakeOpenLoopPage(const OpenLoopExperiment& experiment,
                             const OpenLoopStudyOptions& options, const OpenLoopStudy& study,
                             const std::optional<PublishedComparison>& published,
                             const std::vector<OpenLoopStatistics>& statistics,
                             const std::string& svg_path) {
  HtmlPage page(experiment.name + ": the published open-loop experiment");
  page.Paragraph(
      "After M. Finean, W. Merkt, I. Havoutis, \"Predicted Composite Signed-Distance Fields for "
      "Real-Time Motion Planning in Dynamic Environments\", ICAPS 2021. An arm moves from rest to "
      "rest in 3 s while a box moves through its workspace. The same planner runs under several "
      "kinds of knowledge of that box, so that a difference shows what the knowledge is worth.");
  page.Paragraph(DescribeSetup(experiment, options));
  page.Paragraph(InShort(study, published));
  if (!study.ignored_spheres.empty()) page.Paragraph(DescribeIgnored(study.ignored_spheres));
  if (!svg_path.empty()) {
    page.Picture(svg_path,
                 "Collision-free rate by the published verdict, with Wilson's 95 % "
                 "intervals as bands, and mean GP cost, over the obstacle's speed.");
  }
  if (published) AddPublished(page, published->table);
  AddVerdicts(page, study);
  AddStatistics(page, statistics);
  return page.ToText();
}

}  // namespace sidestep::bench
