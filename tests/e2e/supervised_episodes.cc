// Runs supervised episodes, prints a row of each and at the end, on the error stream, what came of
// them all. docs/safety.md holds what it found.
//
//   supervised_episodes within|beyond FIRST COUNT GUESSES
//
// of the seeds from FIRST on; GUESSES is how long to search each for a motion that is free, 0: not.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/core/csv.h"
#include "tests/support/supervised_episode.h"

namespace sidestep {
namespace {

std::string Field(const std::optional<double>& value) { return value ? CsvNumber(*value) : ""; }

std::string Field(const std::map<std::string, int>& findings) {
  std::string text;
  for (const auto& [what, count] : findings) {
    text += (text.empty() ? "" : "; ") + what + " " + std::to_string(count);
  }
  return text;
}

int HoldsOf(const SupervisedEpisode& run) {
  int holds = 0;
  for (const auto& [what, count] : run.findings) {
    if (what == "stop_path hold" || what == "clearance hold") holds += count;
  }
  return holds;
}

// Prints rows as they come, and adds up.
class Table {
 public:
  Table() { Print(); }

  void Add(const SupervisedEpisode& run, const std::optional<bench::FreePath>& path) {
    csv_.AddRow({std::to_string(run.seed), run.motion, CsvNumber(run.speed_m_s),
                 CsvNumber(run.acceleration_m_s2), ToString(run.outcome), Field(run.goal_s),
                 Field(run.touch_s), run.touched_in_motion ? "1" : "0", CsvNumber(run.touch_m_s),
                 Field(run.too_fast_m_s), Field(run.findings), run.reason,
                 path ? (path->found ? "1" : "0") : ""});
    Print();
    const bool reached = run.outcome == bench::Outcome::kGoal;
    ++episodes_;
    if (run.touched_in_motion) in_motion_m_s_.push_back(run.touch_m_s);
    if (run.touch_s && !run.touched_in_motion) ++at_rest_;
    if (run.too_fast_m_s) least_too_fast_m_s_ = std::min(least_too_fast_m_s_, *run.too_fast_m_s);
    holding_ += HoldsOf(run) > 0 ? 1 : 0;
    if (reached) {
      ++reached_;
      sum_goal_s_ += *run.goal_s;
      first_goal_s_ = std::min(first_goal_s_, *run.goal_s);
    }
    if (path && path->found) ++solvable_;
    if (path && path->found && reached) ++solved_;
  }

  void PrintSummary() {
    std::cerr << episodes_ << " episodes, " << holding_ << " with a hold\n"
              << in_motion_m_s_.size() << " touched in motion, " << at_rest_ << " at rest\n";
    if (!in_motion_m_s_.empty()) {
      std::sort(in_motion_m_s_.begin(), in_motion_m_s_.end());
      std::cerr << "the arm's fastest part then: median "
                << in_motion_m_s_[in_motion_m_s_.size() / 2] << " m/s, most "
                << in_motion_m_s_.back() << " m/s\n";
    }
    std::cerr << reached_ << " reached the goal, on average "
              << sum_goal_s_ / std::max(1, reached_) - first_goal_s_ << " s later than the first\n"
              << solved_ << " of " << solvable_ << " for which a free motion was found\n"
              << "obstacle_too_fast from " << least_too_fast_m_s_ << " m/s on\n";
  }

 private:
  void Print() {
    std::cout << csv_.text().substr(printed_) << std::flush;
    printed_ = csv_.text().size();
  }

  CsvWriter csv_{{"seed", "motion", "speed_m_s", "acceleration_m_s2", "outcome", "goal_s",
                  "touch_s", "touched_in_motion", "touch_m_s", "too_fast_m_s", "findings", "reason",
                  "free_path"}};
  std::size_t printed_ = 0;
  std::vector<double> in_motion_m_s_;
  int episodes_ = 0, at_rest_ = 0, holding_ = 0, reached_ = 0, solvable_ = 0, solved_ = 0;
  double sum_goal_s_ = 0, first_goal_s_ = std::numeric_limits<double>::infinity();
  double least_too_fast_m_s_ = std::numeric_limits<double>::infinity();
};

}  // namespace
}  // namespace sidestep

int main(int argc, char** argv) {
  using namespace sidestep;
  const std::string envelope = argc == 5 ? argv[1] : "";
  if (envelope != "within" && envelope != "beyond") {
    std::cerr << "usage: supervised_episodes within|beyond FIRST COUNT GUESSES\n";
    return 2;
  }
  const SupervisedEpisodes episodes(SIDESTEP_SOURCE_DIR,
                                    envelope == "within" ? Envelope::kWithin : Envelope::kBeyond);
  const std::uint64_t first = std::strtoull(argv[2], nullptr, 10);
  const std::uint64_t count = std::strtoull(argv[3], nullptr, 10);
  const int guesses = std::atoi(argv[4]);
  Table table;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    std::optional<bench::FreePath> path;
    if (guesses > 0) path = episodes.Search(seed, guesses);
    table.Add(episodes.Run(seed), path);
  }
  table.PrintSummary();
}
