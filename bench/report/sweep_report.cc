#include "sidestep/bench/report/sweep_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "sidestep/bench/outcome.h"
#include "sidestep/bench/report/html_page.h"
#include "sidestep/bench/report/report_figures.h"
#include "sidestep/bench/report/report_html.h"
#include "sidestep/bench/report/web_files.h"
#include "sidestep/bench/run_row.h"
#include "sidestep/bench/statistics.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/number_text.h"
#include "sidestep/core/page_template.h"

namespace sidestep::bench {
namespace {

constexpr std::size_t kMostGroups = 7, kMostLevelsTold = 40;
constexpr int kMostComparisons = 24;
constexpr int kMostFailuresListed = 200;

const std::vector<std::string> kColumns = {
    "min_clearance_m", "time_to_goal_s", "gp_cost",      "jerk_rms",           "charged_latency_s",
    "cycle_p50_ms",    "cycle_p95_ms",   "cycle_max_ms", "cycles_over_charge", "late_plans"};

const std::vector<ComparedMetric> kCompared = {{"min_clearance_m", false},
                                               {"time_to_goal_s", true},
                                               {"gp_cost", true},
                                               {"jerk_rms", true},
                                               {"cycle_p95_ms", false}};

std::vector<int> SomeLevels(const RunTable& runs, int factor) {
  std::vector<int> levels;
  if (factor < 0) return levels;
  const std::size_t count = runs.factors[static_cast<std::size_t>(factor)].values.size();
  for (std::size_t i = 0; i < std::min(count, kMostGroups); ++i) {
    levels.push_back(static_cast<int>(i));
  }
  return levels;
}

std::size_t NumLevels(const RunTable& runs, int factor) {
  return runs.factors[static_cast<std::size_t>(factor)].values.size();
}

// A name as part of a file's.
std::string FileWord(const std::string& text) {
  std::string word;
  for (const char c : text) word += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return word;
}

// What the page is put together from, and the figures that are files too.
class Page {
 public:
  Page(const RunDatabase& database, const ReportRequest& request, const RunTable& runs,
       const Question& question, int over)
      : database_(database), request_(request), runs_(runs), question_(question), over_(over) {}

  SweepReport Make(const ReportReplays& replays) {
    Head();
    Answers();
    Rates();
    Distributions();
    Latency();
    Failures();
    Replays(replays);
    Origin();
    report_.html = FillTemplate(
        kReportPageHtml,
        {{"title", Escaped(Title())},
         {"style", std::string(kReportCss) + replays.style},
         {"body", body_},
         {"scripts", replays.scripts + "<script>\n" + std::string(kReportJs) + "\n</script>"}});
    return std::move(report_);
  }

 private:
  std::string Title() const {
    const std::string title = database_.Fact("title");
    return title.empty() ? "Results" : title;
  }

  void Figure(const std::string& name, const Panel& panel, const std::string& caption) {
    body_ += FigureHtml(panel, caption);
    report_.figures.push_back({FileWord(name), panel});
  }

  void Head() {
    body_ += "<div class=\"head\"><h1>" + Escaped(Title()) +
             "</h1><button id=\"theme\" type=\"button\" hidden title=\"Light or dark\" "
             "aria-label=\"Light or dark\">◐</button></div>\n";
    const std::string description = database_.Fact("description");
    if (!description.empty()) body_ += Paragraph(Escaped(description));
    std::map<std::string, int> counts;
    for (const int outcome : runs_.outcome)
      ++counts[runs_.outcomes[static_cast<std::size_t>(outcome)]];
    std::vector<std::string> words;
    for (const auto& [outcome, count] : counts)
      words.push_back(fmt::format("{} {}", count, outcome));
    std::string line = fmt::format("{} runs", runs_.size());
    const std::string planned = database_.Fact("num_planned");
    if (!planned.empty() && planned != std::to_string(runs_.size())) {
      line += " of " + planned + " planned, so far";
    }
    body_ += Paragraph(Escaped(line + ": " + Joined(words) + "."), "quiet");
  }

  // --- The question ------------------------------------------------------------------------------

  // What may be compared: what was asked first, then other levels of its factor, then other
  // factors.
  std::vector<Question> Questions() const {
    std::vector<Question> questions;
    const auto add = [&](const Question& question) {
      const auto same = [&](const Question& other) {
        return other.factor == question.factor &&
               std::minmax(other.of, other.with) == std::minmax(question.of, question.with);
      };
      if (question.of == question.with || static_cast<int>(questions.size()) >= kMostComparisons ||
          std::any_of(questions.begin(), questions.end(), same)) {
        return;
      }
      questions.push_back(question);
    };
    if (question_.factor < 0) return questions;
    add(question_);
    const auto add_pairs = [&](int factor) {
      const int count = static_cast<int>(std::min(NumLevels(runs_, factor), kMostGroups));
      for (int of = 1; of < count; ++of) {
        for (int with = 0; with < of; ++with) add({factor, of, with});
      }
    };
    add_pairs(question_.factor);
    for (int factor = 0; factor < static_cast<int>(runs_.factors.size()); ++factor) {
      if (factor != question_.factor) add_pairs(factor);
    }
    return questions;
  }

  std::string NameOf(const Question& question) const {
    const FactorColumn& factor = runs_.factors[static_cast<std::size_t>(question.factor)];
    return factor.name + ": " + factor.values[static_cast<std::size_t>(question.of)] + " or " +
           factor.values[static_cast<std::size_t>(question.with)];
  }

  // Along which factor a question is shown: as asked, else the one with most levels.
  int OverOf(const Question& question) const {
    if (over_ >= 0 && over_ != question.factor) return over_;
    int over = -1;
    std::size_t most = 1;
    for (int factor = 0; factor < static_cast<int>(runs_.factors.size()); ++factor) {
      const std::size_t levels = NumLevels(runs_, factor);
      if (factor == question.factor || levels <= most || levels > kMostLevelsTold) continue;
      most = levels;
      over = factor;
    }
    return over;
  }

  void Answers() {
    const std::vector<Question> questions = Questions();
    body_ += "<section class=\"answer\">\n";
    std::string options, articles;
    int number = 0;
    for (const Question& question : questions) {
      const Comparison comparison = Compare(runs_, question, kCompared);
      if (comparison.rates.num_pairs == 0) continue;
      const std::string id = "comparison-" + std::to_string(number);
      options += "<option value=\"" + id + "\">" + Escaped(NameOf(question)) + "</option>";
      articles += "<article class=\"comparison\" id=\"" + id + "\"" +
                  (number == 0 ? "" : " hidden") + ">\n" +
                  Answer(question, comparison, number == 0) + "</article>\n";
      if (number++ == 0) report_.answer = AnswerSentence(runs_, comparison, /*bold_html=*/false);
    }
    if (number == 0) {
      const Share share = ShareOf(runs_, -1, -1);
      report_.answer = fmt::format(
          "The robot reached its goal and touched nothing in {} of {} runs ({}, 95 % interval {} "
          "to "
          "{}); nothing was varied that could be compared.",
          share.goals, share.runs, Percent(static_cast<double>(share.goals) / share.runs),
          Percent(share.interval.low), Percent(share.interval.high));
      articles = Paragraph(Escaped(report_.answer), "sentence");
    }
    body_ +=
        "<div class=\"choose\" hidden><label for=\"comparison\">Compared: </label><select "
        "id=\"comparison\">" +
        options + "</select></div>\n" + articles + "</section>\n";
  }

  std::string Answer(const Question& question, const Comparison& comparison, bool is_asked) {
    const int over = OverOf(question);
    const std::vector<int> levels = {question.of, question.with};
    const Panel panel = over >= 0 ? RatePanel(runs_, over, question.factor, levels)
                                  : RatePanel(runs_, question.factor, -1, {});
    if (is_asked) report_.figures.push_back({"answer", panel});
    return Paragraph(AnswerSentence(runs_, comparison, /*bold_html=*/true), "sentence") +
           "<div class=\"columns\">" +
           FigureHtml(panel, "The share of runs, with Wilson's intervals of 95 %.") + "<div>" +
           MetricsTableHtml(runs_, comparison) +
           Paragraph(Escaped(AnswerNote(runs_, comparison)), "note") + "</div></div>\n";
  }

  // --- Every axis --------------------------------------------------------------------------------

  void Rates() {
    bool has_heading = false;
    for (int factor = 0; factor < static_cast<int>(runs_.factors.size()); ++factor) {
      if (NumLevels(runs_, factor) < 2) continue;
      if (!has_heading) body_ += Heading("What each thing that was varied does");
      has_heading = true;
      const std::string& name = runs_.factors[static_cast<std::size_t>(factor)].name;
      const int group = factor == question_.factor ? -1 : question_.factor;
      const std::vector<int> groups = SomeLevels(runs_, group);
      body_ += "<h3>" + Escaped(name) + "</h3>\n";
      if (NumLevels(runs_, factor) <= kMostLevelsTold) {
        body_ += "<div class=\"figures\">\n";
        Figure("rate_over_" + name, RatePanel(runs_, factor, group, groups),
               "Goals, with Wilson's intervals of 95 %.");
        if (HasNumbers(runs_, "min_clearance_m")) {
          Figure("clearance_over_" + name,
                 MetricPanel(runs_, "min_clearance_m", "least clearance [mm]", 1e3, factor, group,
                             groups),
                 "Medians; half of the runs lie between the bounds.");
        }
        if (HasNumbers(runs_, "time_to_goal_s")) {
          Figure("time_over_" + name,
                 MetricPanel(runs_, "time_to_goal_s", "time to the goal [s]", 1, factor, group,
                             groups),
                 "Medians of runs that arrived; half of them lie between the bounds.");
        }
        body_ += "</div>\n";
      }
      LevelTable(factor);
    }
  }

  void LevelTable(int factor) {
    std::vector<std::string> others;  // outcomes that are no goals
    for (const std::string& outcome : runs_.outcomes) {
      if (outcome != ToString(Outcome::kGoal)) others.push_back(outcome);
    }
    const FactorColumn& column = runs_.factors[static_cast<std::size_t>(factor)];
    std::vector<std::vector<std::string>> rows = {
        {Escaped(column.name), "runs", "goals", "rate", "95 % interval"}};
    for (const std::string& outcome : others) rows.front().push_back(Escaped(outcome));
    for (const char* const name : {"clearance [mm]", "time [s]", "GP cost", "jerk [rad/s³]"}) {
      rows.front().emplace_back(name);
    }
    const std::vector<int>& level_of = runs_.levels[static_cast<std::size_t>(factor)];
    for (std::size_t l = 0; l < std::min(column.values.size(), kMostLevelsTold); ++l) {
      const int level = static_cast<int>(l);
      const Share share = ShareOf(runs_, factor, level);
      std::vector<std::string>& row = rows.emplace_back();
      row = {Escaped(column.values[l]), std::to_string(share.runs + share.failed),
             std::to_string(share.goals),
             share.runs > 0 ? Percent(static_cast<double>(share.goals) / share.runs) : "–",
             Percent(share.interval.low) + " to " + Percent(share.interval.high)};
      for (const std::string& outcome : others) {
        int count = 0;
        for (std::size_t run = 0; run < runs_.size(); ++run) {
          count += level_of[run] == level && runs_.Is(run, outcome) ? 1 : 0;
        }
        row.push_back(std::to_string(count));
      }
      const struct {
        const char *metric, *format;
        double scale;
      } medians[] = {{"min_clearance_m", "{:.1f}", 1e3},
                     {"time_to_goal_s", "{:.3f}", 1},
                     {"gp_cost", "{:.4g}", 1},
                     {"jerk_rms", "{:.1f}", 1}};
      for (const auto& [metric, format, scale] : medians) {
        const std::vector<double> numbers =
            SortedNumbers(runs_, metric, [&](std::size_t run) { return level_of[run] == level; });
        row.push_back(FiniteText(format, scale * Quantile(numbers, 0.5), "–"));
      }
    }
    body_ += TableHtml(rows);
    if (column.values.size() > kMostLevelsTold) {
      body_ += Paragraph(
          fmt::format("The first {} of {} values.", kMostLevelsTold, column.values.size()), "note");
    }
  }

  // --- Distributions -----------------------------------------------------------------------------

  void Distributions() {
    const std::vector<int> groups = SomeLevels(runs_, question_.factor);
    const struct {
      const char *name, *column, *label, *caption;
      double scale;
      bool log_x;
    } shown[] = {
        {"clearance_ecdf", "min_clearance_m", "least clearance of the run [mm]",
         "How many runs came at least this near to something; below 0 they touched it.", 1e3,
         false},
        {"cycle_time_ecdf", "cycle_p50_ms", "median planning cycle of the run [ms of CPU time]",
         "How long runs' planning cycles took.", 1, true}};
    body_ += Heading("Distributions");
    body_ += "<div class=\"figures\">\n";
    for (const auto& [name, column, label, caption, scale, log_x] : shown) {
      if (!HasNumbers(runs_, column)) continue;
      Figure(name, DistributionPanel(runs_, column, label, scale, log_x, question_.factor, groups),
             caption);
    }
    body_ += "</div>\n";
  }

  // --- Latency -----------------------------------------------------------------------------------

  void Latency() {
    if (!HasNumbers(runs_, "cycle_max_ms")) return;
    body_ += Heading("Latency: what was charged, and what was needed");
    body_ += Paragraph(
        "A planning cycle is charged a time, whatever it takes. What it took of CPU time on the "
        "machine "
        "of these runs stands beside it; where that is more, the charge promises too much.");
    std::map<double, std::vector<std::size_t>> by_charge;
    std::vector<std::size_t> measured;
    const std::vector<double>& charges = runs_.numbers.at("charged_latency_s");
    for (std::size_t run = 0; run < runs_.size(); ++run) {
      if (runs_.Is(run, kFailed)) continue;
      if (std::isfinite(charges[run])) {
        by_charge[charges[run]].push_back(run);
      } else {
        measured.push_back(run);
      }
    }
    std::vector<std::vector<std::string>> rows = {
        {"charged [ms]", "runs", "median cycle [ms]", "95th percentile", "slowest",
         "runs with a cycle over it", "cycles over it", "late plans"}};
    const auto add = [&](const std::string& name, const std::vector<std::size_t>& chosen) {
      const auto middle = [&](const char* column, double p) {
        std::vector<double> numbers;
        for (const std::size_t run : chosen) {
          const double number = runs_.numbers.at(column)[run];
          if (std::isfinite(number)) numbers.push_back(number);
        }
        return FiniteText("{:.2f}", Quantile(numbers, p), "–");
      };
      double over = 0, late = 0;
      int runs_over = 0;
      for (const std::size_t run : chosen) {
        const double count = runs_.numbers.at("cycles_over_charge")[run];
        if (count > 0) ++runs_over;
        over += std::isfinite(count) ? count : 0;
        const double late_plans = runs_.numbers.at("late_plans")[run];
        late += std::isfinite(late_plans) ? late_plans : 0;
      }
      rows.push_back({name, std::to_string(chosen.size()), middle("cycle_p50_ms", 0.5),
                      middle("cycle_p95_ms", 0.5), middle("cycle_max_ms", 1),
                      std::to_string(runs_over), fmt::format("{:.0f}", over),
                      fmt::format("{:.0f}", late)});
    };
    std::size_t told = 0;
    for (const auto& [charge, chosen] : by_charge) {
      if (told++ == kMostLevelsTold) break;
      add(fmt::format("{:.6g}", 1e3 * charge), chosen);
    }
    if (!measured.empty()) add("as measured", measured);
    body_ += TableHtml(rows);
    if (by_charge.empty()) return;

    Panel panel = DistributionPanel(runs_, "cycle_max_ms",
                                    "slowest planning cycle of the run [ms of CPU time]", 1, true,
                                    question_.factor, SomeLevels(runs_, question_.factor));
    told = 0;
    for (const auto& [charge, chosen] : by_charge) {
      if (charge <= 0 || told++ == 4) continue;
      Series& line = panel.series.emplace_back();
      line.title = fmt::format("charged {:.6g} ms", 1e3 * charge);
      line.style = Series::Style::kPlainLine;
      line.color = 0;
      line.x = {1e3 * charge, 1e3 * charge};
      line.y = {0, 100};
    }
    body_ += "<div class=\"figures\">\n";
    Figure("charged_and_needed", panel,
           "Left of its charge a run would have kept to it on this machine, in every cycle.");
    body_ += "</div>\n";
  }

  // --- Failures ----------------------------------------------------------------------------------

  void Failures() {
    SqlStatement causes = database_.sql().Prepare(
        "SELECT outcome, coalesce(nullif(touched, ''), nullif(error, ''), '') AS cause, count(*) "
        "AS n "
        "FROM results WHERE outcome <> 'goal' GROUP BY outcome, cause ORDER BY n DESC, outcome, "
        "cause "
        "LIMIT 40");
    std::vector<std::vector<std::string>> rows = {{"outcome", "touched, or why", "runs", "of all"}};
    while (causes.Step()) {
      rows.push_back(
          {Escaped(causes.Text(0)), Escaped(causes.Text(1)), causes.Text(2),
           Percent(static_cast<double>(causes.Integer(2)) / static_cast<double>(runs_.size()))});
    }
    body_ += Heading("What went wrong");
    if (rows.size() == 1) {
      body_ += Paragraph("Nothing: every run reached its goal and touched nothing.");
      return;
    }
    body_ += TableHtml(rows, {"text", "wrap"});
    ListFailures();
  }

  // What replays a kept trace. Names of traces are plain, in databases of ours.
  std::string ViewCommand(const std::string& trace) const {
    const bool is_plain = std::all_of(trace.begin(), trace.end(), [](unsigned char c) {
      return std::isalnum(c) != 0 || c == '/' || c == '_' || c == '-' || c == '.';
    });
    if (trace.empty() || !is_plain) return "";
    return CommandHtml("sidestep view " + request_.folder + trace);
  }

  void ListFailures() {
    std::string factors;
    std::vector<std::string> head = {"run", "outcome", "touched, or why"};
    for (const FactorColumn& factor : runs_.factors) {
      factors += ", " + SqlName(factor.column);
      head.push_back(Escaped(factor.name));
    }
    head.insert(head.end(), {"seed", "clearance [mm]"});
    SqlStatement run = database_.sql().Prepare(
        "SELECT id, outcome, coalesce(nullif(touched, ''), nullif(error, ''), ''), seed, "
        "min_clearance_m, command, trace" +
        factors +
        " FROM results WHERE outcome <> 'goal' ORDER BY outcome, min_clearance_m, id LIMIT " +
        std::to_string(kMostFailuresListed));
    std::vector<std::vector<std::string>> rows = {head};
    std::int64_t listed = 0;
    for (; run.Step(); ++listed) {
      std::vector<std::string>& row = rows.emplace_back();
      const std::string outcome = run.Text(1);
      row = {run.Text(0),
             "<span class=\"outcome-" + Escaped(outcome) + "\">" + Escaped(outcome) + "</span>",
             Escaped(run.Text(2))};
      for (std::size_t f = 0; f < runs_.factors.size(); ++f) {
        row.push_back(Escaped(run.Text(7 + static_cast<int>(f))));
      }
      row.push_back(run.Text(3));
      row.push_back(FiniteText("{:.1f}", 1e3 * run.Number(4), "–"));
      const std::string again =
          (run.IsNull(5) ? "" : CommandHtml(run.Text(5))) + ViewCommand(run.Text(6));
      if (!again.empty()) rows.push_back({again});
    }
    const auto all = static_cast<std::size_t>(
        std::count_if(runs_.outcome.begin(), runs_.outcome.end(), [&](int outcome) {
          return runs_.outcomes[static_cast<std::size_t>(outcome)] != ToString(Outcome::kGoal);
        }));
    const std::string which = static_cast<std::int64_t>(all) > listed
                                  ? fmt::format("{} of {} runs", listed, all)
                                  : fmt::format("{} runs", listed);
    body_ += "<details" + std::string(listed <= 24 ? " open" : "") + "><summary>" +
             Escaped("Each of them, and how to run it again (" + which + ")") + "</summary>\n" +
             TableHtml(rows, {"", "text", "wrap"}) + "</details>\n";
    body_ += Paragraph("Videos of the worst of them, where their traces are kept:", "note") +
             CommandHtml(
                 "sidestep render --from " + request_.database +
                 " --where \"outcome = 'collision'\" --order min_clearance_m --top 4 --out films");
  }

  // --- Replays, and where it all comes from
  // --------------------------------------------------------

  void Replays(const ReportReplays& replays) {
    if (replays.replays.empty()) return;
    body_ += "<section class=\"replays\">\n" + Heading("Replays");
    int number = 0;
    for (const ReportReplay& replay : replays.replays) {
      const std::string id = "replay-" + std::to_string(number++);
      body_ += "<h3>" + Escaped(replay.title) + "</h3>\n" +
               "<button type=\"button\" class=\"open-replay\" hidden data-replay=\"" + id +
               "\">▶ replay in 3-D</button>\n<script type=\"application/json\" id=\"" + id + "\">" +
               replay.json + "</script>\n";
    }
    body_ += "</section>\n";
  }

  void Origin() {
    body_ += Heading("Where this comes from");
    std::vector<std::vector<std::string>> rows = {{"the sweep", ""}};
    for (const auto& [name, value] : database_.facts()) {
      if (name == "title" || name == "description") continue;
      rows.push_back({Escaped(name), "<code>" + Escaped(value) + "</code>"});
    }
    body_ += TableHtml(rows, {"text", "wrap"});
    SqlStatement fact = database_.sql().Prepare(
        "SELECT machine, name, value FROM wall_clock_machines ORDER BY machine, name");
    std::vector<std::vector<std::string>> machines;
    std::int64_t last = -1;
    while (fact.Step()) {
      if (fact.Integer(0) != last) {
        if (!machines.empty()) body_ += TableHtml(machines, {"text", "wrap"});
        machines = {{fmt::format("machine {}", fact.Integer(0) + 1), ""}};
        last = fact.Integer(0);
      }
      machines.push_back({Escaped(fact.Text(1)), Escaped(fact.Text(2))});
    }
    if (!machines.empty()) body_ += TableHtml(machines, {"text", "wrap"});
  }

  const RunDatabase& database_;
  const ReportRequest& request_;
  const RunTable& runs_;
  const Question& question_;
  int over_;
  std::string body_;
  SweepReport report_;
};

std::string FactorNames(const RunTable& runs) {
  std::vector<std::string> names;
  for (const FactorColumn& factor : runs.factors) names.push_back(factor.name);
  return names.empty() ? "none" : Joined(names);
}

int RequireFactor(const RunTable& runs, const std::string& flag, const std::string& name) {
  const int factor = runs.FindFactor(name);
  if (factor >= 0) return factor;
  throw InputError(flag, "'" + name + "' was not varied (there are: " + FactorNames(runs) + ")");
}

int RequireLevel(const RunTable& runs, int factor, const std::string& value) {
  const int level = runs.FindLevel(factor, value);
  if (level >= 0) return level;
  const FactorColumn& column = runs.factors[static_cast<std::size_t>(factor)];
  throw InputError("--compare", "'" + value + "' is no value of " + column.name +
                                    " (there are: " + Joined(column.values) + ")");
}

// The two levels that a report without a question compares: how the robot plans, before what it
// meets; the last level with the first.
Question AnyQuestion(const RunTable& runs) {
  for (const bool is_planner : {true, false}) {
    for (int factor = 0; factor < static_cast<int>(runs.factors.size()); ++factor) {
      const FactorColumn& column = runs.factors[static_cast<std::size_t>(factor)];
      if (column.is_planner != is_planner || column.values.size() < 2) continue;
      return {factor, static_cast<int>(column.values.size()) - 1, 0};
    }
  }
  return {};
}

}  // namespace

ReportSource::ReportSource(const RunDatabase& database, const ReportRequest& request)
    : database_(database), request_(request), runs_(ReadRunTable(database, kColumns)) {
  if (!request.over.empty()) over_ = RequireFactor(runs_, "--over", request.over);
  if (!request.factor.empty()) {
    question_.factor = RequireFactor(runs_, "--compare", request.factor);
    question_.of = RequireLevel(runs_, question_.factor, request.of);
    question_.with = RequireLevel(runs_, question_.factor, request.with);
    if (question_.of == question_.with)
      throw InputError("--compare", "compares a value with itself");
    return;
  }
  const int factor = runs_.FindFactor(database.Fact("compare.factor"));
  if (factor >= 0) {
    question_ = {factor, runs_.FindLevel(factor, database.Fact("compare.of")),
                 runs_.FindLevel(factor, database.Fact("compare.with"))};
  }
  if (factor < 0 || question_.of < 0 || question_.with < 0) question_ = AnyQuestion(runs_);
}

std::vector<std::pair<std::size_t, std::size_t>> ReportSource::TellingPairs() const {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  if (question_.factor < 0) return pairs;
  const std::string goal = ToString(Outcome::kGoal);
  pairs = PairsOf(runs_, question_);
  const auto& clearance = runs_.numbers.at("min_clearance_m");
  const auto kind = [&](const std::pair<std::size_t, std::size_t>& pair) {
    const bool of = runs_.Is(pair.first, goal), with = runs_.Is(pair.second, goal);
    return of == with ? 2 : of ? 0 : 1;
  };
  const auto difference = [&](const std::pair<std::size_t, std::size_t>& pair) {
    const double d = std::abs(clearance[pair.first] - clearance[pair.second]);
    return std::isfinite(d) ? d : -1;
  };
  std::stable_sort(pairs.begin(), pairs.end(), [&](const auto& a, const auto& b) {
    return std::make_pair(kind(a), -difference(a)) < std::make_pair(kind(b), -difference(b));
  });
  return pairs;
}

SweepReport ReportSource::Make(const ReportReplays& replays) const {
  return Page(database_, request_, runs_, question_, over_).Make(replays);
}

}  // namespace sidestep::bench
