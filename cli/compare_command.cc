#include <memory>
#include <string>
#include <vector>

#include "sidestep/bench/result_file.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/core/number_text.h"

namespace sidestep::cli {
namespace {

std::string Number(const bench::ResultSummary& result, const char* metric, double scale,
                   const char* format) {
  return FiniteText(format, scale * result.metrics.at(metric));
}

std::string Verdict(const bench::ResultSummary& result) {
  return bench::Describe(result.outcome, !std::isnan(result.metrics.at("time_to_goal_s")));
}

int Compare(const std::vector<std::string>& folders) {
  std::vector<bench::ResultSummary> results;
  for (const std::string& folder : folders)
    results.push_back(bench::ReadResult(folder + "/result.json"));
  Print("{:<20} {:<34} {:>10} {:>10} {:>10} {:>8} {:>10} {:>9}\n", "planner knows", "what happened",
        "contact", "clearance", "goal", "GP cost", "jerk RMS", "cycle");
  Print("{:<20} {:<34} {:>10} {:>10} {:>10} {:>8} {:>10} {:>9}\n", "", "", "at [s]", "least [mm]",
        "after [s]", "", "[rad/s^3]", "[ms CPU]");
  for (const bench::ResultSummary& result : results) {
    Print("{:<20} {:<34} {:>10} {:>10} {:>10} {:>8} {:>10} {:9.1f}\n", result.knowledge,
          Verdict(result), Number(result, "first_contact_s", 1, "{:.2f}"),
          Number(result, "min_clearance_m", 1e3, "{:.0f}"),
          Number(result, "time_to_goal_s", 1, "{:.2f}"), Number(result, "gp_cost", 1, "{:.1f}"),
          Number(result, "jerk_rms", 1, "{:.0f}"), result.cycle_p50_ms);
  }
  return 0;
}

}  // namespace

void AddCompareCommand(CommandLine& line) {
  auto folders = std::make_shared<std::vector<std::string>>();
  CLI::App* const compare =
      line.app.add_subcommand("compare", "Print the results of several runs as one table");
  compare->add_option("DIR", *folders, "Folders written by `sidestep run`")->required();
  compare->callback([&line, folders] { line.exit_code = Compare(*folders); });
}

}  // namespace sidestep::cli
