#include "sidestep/bench/report/report_html.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "sidestep/bench/report/html_page.h"
#include "sidestep/bench/report/svg.h"
#include "sidestep/core/number_text.h"

namespace sidestep::bench {
namespace {

constexpr const char* kNoNumber = "–";
constexpr int kFigureWidth = 450, kFigureHeight = 300;  // so that letters can be read on a phone

const FactorColumn& ComparedFactor(const RunTable& runs, const Question& question) {
  return runs.factors[static_cast<std::size_t>(question.factor)];
}

std::string LevelOf(const RunTable& runs, const Question& question, int level) {
  return ComparedFactor(runs, question).values[static_cast<std::size_t>(level)];
}

// How a column is told to people.
struct ToldColumn {
  const char *column, *label;
  double scale;
};
constexpr ToldColumn kTold[] = {{"min_clearance_m", "least clearance [mm]", 1e3},
                                {"time_to_goal_s", "time to the goal [s]", 1},
                                {"gp_cost", "GP cost", 1},
                                {"jerk_rms", "jerk, RMS [rad/s³]", 1},
                                {"cycle_p95_ms", "planning cycle, 95th percentile [ms]", 1}};

ToldColumn ToldOf(const std::string& column) {
  for (const ToldColumn& told : kTold) {
    if (told.column == column) return told;
  }
  return {column.c_str(), column.c_str(), 1};
}

std::string ShortNumber(double value) { return FiniteText("{:.4g}", value, kNoNumber); }
std::string Signed(double value) { return FiniteText("{:+.3g}", value, kNoNumber); }

}  // namespace

std::string Heading(const std::string& text) { return "<h2>" + Escaped(text) + "</h2>\n"; }

std::string Paragraph(const std::string& text_html, const std::string& css_class) {
  const std::string open = css_class.empty() ? "<p>" : "<p class=\"" + css_class + "\">";
  return open + text_html + "</p>\n";
}

std::string FigureHtml(const Panel& panel, const std::string& caption) {
  return "<figure>" + ToSvg(panel, SvgPlace::kPage, kFigureWidth, kFigureHeight) +
         (caption.empty() ? "" : "<figcaption>" + Escaped(caption) + "</figcaption>") +
         "</figure>\n";
}

std::string Breakable(const std::string& name) {
  std::string text;
  for (const char c : Escaped(name)) text += c == '_' ? "_<wbr>" : std::string(1, c);
  return text;
}

std::string TableHtml(const std::vector<std::vector<std::string>>& rows_html,
                      const std::vector<std::string>& column_classes) {
  std::string text = "<div class=\"scroll\"><table>\n";
  const char* tag = "th";
  for (const std::vector<std::string>& row : rows_html) {
    if (row.size() == 1 && rows_html.front().size() > 1) {
      text += fmt::format("<tr><td class=\"across\" colspan=\"{}\">{}</td></tr>\n",
                          rows_html.front().size(), row.front());
      continue;
    }
    text += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c) {
      const bool has_class = c < column_classes.size() && !column_classes[c].empty();
      text += fmt::format("<{}{}>{}</{}>", tag,
                          has_class ? " class=\"" + column_classes[c] + "\"" : "", row[c], tag);
    }
    text += "</tr>\n";
    tag = "td";
  }
  return text + "</table></div>\n";
}

std::string CommandHtml(const std::string& command) {
  return "<div class=\"command\"><button type=\"button\" class=\"copy\" "
         "hidden>copy</button><code>" +
         Escaped(command) + "</code></div>";
}

std::string Percent(double share) { return FiniteText("{:.1f} %", 100 * share, kNoNumber); }

std::string PText(double p) { return p < 1e-4 ? "p < 0.0001" : fmt::format("p = {:.2g}", p); }

std::string AnswerSentence(const RunTable& runs, const Comparison& comparison, bool bold_html) {
  const auto word = [&](const std::string& text) { return bold_html ? Escaped(text) : text; };
  const auto strong = [&](const std::string& text) {
    return bold_html ? "<b>" + Escaped(text) + "</b>" : text;
  };
  const PairedRates& rates = comparison.rates;
  const Question& question = comparison.question;
  const auto share = [&](int successes) {
    return strong(fmt::format("{} of {}", successes, rates.num_pairs)) +
           word(" runs (" + Percent(static_cast<double>(successes) / rates.num_pairs) + ")");
  };
  const Interval& interval = rates.interval;
  const std::string interval_text = std::isfinite(interval.low)
                                        ? fmt::format(" (95 % interval {:+.1f} to {:+.1f})",
                                                      100 * interval.low, 100 * interval.high)
                                        : " (no interval: all pairs are of one seed)";
  return word("With " + ComparedFactor(runs, question).name + " ") +
         strong(LevelOf(runs, question, question.of)) +
         word(" the robot reached its goal and touched nothing in ") +
         share(rates.first_successes) + word(", with ") +
         strong(LevelOf(runs, question, question.with)) + word(" in ") +
         share(rates.second_successes) + word(": a difference of ") +
         strong(fmt::format("{:+.1f} percentage points", 100 * rates.difference)) +
         word(interval_text) + word(", n = ") +
         word(fmt::format("{} pairs{}, ", rates.num_pairs,
                          rates.num_clusters < rates.num_pairs
                              ? fmt::format(" of {} seeds", rates.num_clusters)
                              : "")) +
         word(PText(rates.p)) + ".";
}

std::string AnswerNote(const RunTable& runs, const Comparison& comparison) {
  const PairedRates& rates = comparison.rates;
  const std::string name = ComparedFactor(runs, comparison.question).name;
  std::string note = fmt::format(
      "Pairs agree in everything but {}, the seed included. {} pairs differ: in {} only the first "
      "arrived, in {} only the second. ",
      name, rates.only_first + rates.only_second, rates.only_first, rates.only_second);
  note += comparison.by_seed && rates.num_clusters < rates.num_pairs
              ? fmt::format(
                    "Pairs of one seed ({} seeds) resemble each other: the interval is a "
                    "bootstrap over seeds (or Newcombe's, if all agree), p an exact test that "
                    "swaps the two seed by seed.",
                    rates.num_clusters)
              : "The interval is Newcombe's for pairs, p McNemar's exact test.";
  if (rates.least_p > 0.05) {
    note += fmt::format(" So few {} could not give a p below {:.2g}: more seeds tell more.",
                        comparison.by_seed ? "seeds" : "pairs", rates.least_p);
  }
  if (comparison.num_left_out > 0) {
    note += fmt::format(" {} pairs are left out, because one of their runs failed.",
                        comparison.num_left_out);
  }
  if (comparison.num_unpaired > 0) {
    note += fmt::format(" {} runs have no counterpart.", comparison.num_unpaired);
  }
  return note;
}

std::string MetricsTableHtml(const RunTable& runs, const Comparison& comparison) {
  if (comparison.metrics.empty()) return "";
  const Question& question = comparison.question;
  std::vector<std::vector<std::string>> rows = {
      {"median of", Breakable(LevelOf(runs, question, question.of)),
       Breakable(LevelOf(runs, question, question.with)), "difference (95 %)", "pairs"}};
  for (const MetricComparison& metric : comparison.metrics) {
    const ToldColumn told = ToldOf(metric.column);
    std::string difference = Signed(told.scale * metric.difference);
    if (std::isfinite(metric.interval.low)) {
      difference += " (" + Signed(told.scale * metric.interval.low) + " to " +
                    Signed(told.scale * metric.interval.high) + ")";
    }
    rows.push_back({Escaped(told.label), ShortNumber(told.scale * metric.first),
                    ShortNumber(told.scale * metric.second), difference,
                    std::to_string(metric.num_pairs)});
  }
  return TableHtml(rows);
}

}  // namespace sidestep::bench
