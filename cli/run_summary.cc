#include "sidestep/cli/run_summary.h"

#include <map>
#include <string>
#include <vector>

#include "sidestep/bench/metrics/robot_limit_metrics.h"
#include "sidestep/bench/outcome.h"
#include "sidestep/bench/result_file.h"
#include "sidestep/bench/statistics.h"
#include "sidestep/cli/console.h"
#include "sidestep/control/safety.h"
#include "sidestep/core/number_text.h"

namespace sidestep::cli {
namespace {

// What planning took beside what it was charged.
void PrintPlanningTime(const bench::EpisodeResult& result, const scenarios::Scenario& scenario) {
  const std::vector<double>& cycle_s = result.times.at("cycle");
  if (cycle_s.empty()) {
    const bool took_time = !result.recording.cycles.empty();  // and nobody is left who knows it
    Print("planning cycle   - {}\n", took_time ? "(not known)" : "(there was none)");
    return;
  }
  Print("planning cycle   {:.1f} ms CPU (median of {}), ", 1e3 * bench::Quantile(cycle_s, 0.5),
        cycle_s.size());
  switch (scenario.latency) {
    case scenarios::Latency::kCharged:
      Print("charged {:.1f} ms; {} took longer\n", 1e3 * scenario.latency_s,
            result.cycles_over_charge);
      break;
    case scenarios::Latency::kMeasured:
      Print("charged as measured: no two such runs are alike\n");
      break;
    case scenarios::Latency::kNone:
      Print("charged nothing\n");
      break;
  }
  if (result.late_plans > 0) Print("late plans       {}, dropped\n", result.late_plans);
}

void PrintTrips(const std::map<std::string, double>& metrics) {
  std::string shares;
  for (const bench::TripMetric& metric : bench::kTripMetrics) {
    shares += (shares.empty() ? "" : ", ") + std::string(metric.words) + " " +
              FiniteText("{:.2f}", metrics.at(metric.name), "not known");
  }
  const std::string trips = bench::TellTrips(metrics);
  Print("would it trip    {}; of the robot's limits: {}\n",
        bench::TrippedBy(metrics).empty() ? trips : "yes, " + trips, shares);
}

}  // namespace

void PrintOutcome(const bench::EpisodeResult& result, const scenarios::Scenario& scenario) {
  const auto& metrics = result.recording.metrics;
  const auto number = [&](const char* name, double scale, const char* format) {
    return FiniteText(format, scale * metrics.at(name));
  };
  Print("outcome          {}\n",
        bench::Tell(result.outcome, bench::TouchedBy(result.recording), bench::Ending(metrics)));
  if (!result.reason.empty()) Print("reason           {}\n", result.reason);
  Print("first contact    {}\n", number("first_contact_s", 1, "{:.3f} s"));
  Print("least clearance  {}\n", number("min_clearance_m", 1e3, "{:.1f} mm"));
  Print("time to goal     {}\n",
        FiniteText("{:.3f} s", metrics.at("time_to_goal_s"), "- (not reached)"));
  if (scenario.dwell_s > 0) {
    Print("dwell of {:<7}  {}\n", fmt::format("{:g} s", scenario.dwell_s),
          number("time_to_dwell_s", 1, "over at {:.3f} s"));
  }
  Print("GP cost          {}\n", number("gp_cost", 1, "{:.2f}"));
  Print("jerk RMS         {}\n", number("jerk_rms", 1, "{:.1f} rad/s^3"));
  PrintTrips(metrics);
  if (metrics.at("samples_outside_grid") > 0) {
    Print("outside the map  {} places of planned motion: nothing is seen there\n",
          metrics.at("samples_outside_grid"));
  }
  const std::map<std::string, int> noticed = bench::TrackEventCounts(result.recording);
  if (const auto too_fast = noticed.find("too_fast"); too_fast != noticed.end()) {
    Print(
        "too fast         {} times something was farther off than tracking.max_speed_m_s, {:g} "
        "m/s, "
        "allows: it is not followed\n",
        too_fast->second, scenario.tracking.max_speed_m_s);
  }
  PrintPlanningTime(result, scenario);
  if (!result.answers_s.empty()) {
    Print("answers          {:.0f} us at p99.9, the longest {:.0f} us, of {}\n",
          1e6 * bench::Quantile(result.answers_s, 0.999),
          1e6 * bench::Quantile(result.answers_s, 1), result.answers_s.size());
  }
  const std::vector<SafetyEvent>& findings = result.recording.safety;
  if (!findings.empty()) {
    Print("supervisor       {} findings, the first at {:.3f} s: {}\n", findings.size(),
          findings.front().t.seconds(), findings.front().check);
  }
}

std::string FindingsText(const std::vector<SafetyEvent>& findings, bool is_real_robot) {
  std::string text;
  for (const SafetyEvent& event : findings) {
    const double t_s = event.t.seconds();
    if (event.check != control::ToString(control::SafetyCheck::kSlowAnswer)) {
      text += fmt::format("supervisor       {:.3f} s: {}: {}\n", t_s, event.check, event.reaction);
    } else if (is_real_robot) {
      text += fmt::format(
          "slow answer      {:.3f} s: a command took {:.2f} ms to make; Franka leaves {:.2f} ms\n",
          t_s, 1e3 * event.value, 1e3 * event.limit);
    }
  }
  return text;
}

}  // namespace sidestep::cli
