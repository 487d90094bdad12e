#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/bench/run_row.h"
#include "sidestep/core/fingerprint.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench {

/// Something that is varied: a key of the scenario's file or one of its choices, as --set takes
/// them; keys that vary together, `KEY/OTHER` with values `VALUE/VALUE`; or `speed_m_s`, of all
/// that moves.
struct SweepAxis {
  std::string name;
  std::vector<std::string> values;  ///< one or more, none twice
};

/// What a sweep's report is to compare: two values of an axis.
struct SweepQuestion {
  std::string factor;  ///< empty: nothing was asked
  std::string of, with;
};

/// Which traces are kept.
enum class KeptTraces { kNone, kFailures, kAll };
inline constexpr const char* kKeptTracesWords[] = {"none", "failures", "all"};  ///< in that order

/// What a sweep file says: every combination of scenarios and values, with every seed.
struct Sweep {
  std::string name;  ///< of the file, without its ending
  std::string description;
  std::vector<std::string> scenarios;  ///< names or paths, as they are written
  scenarios::Settings settings;        ///< put in place in every run
  std::vector<SweepAxis> axes;
  std::vector<std::uint64_t> seeds;  ///< none twice
  int search = 0;                    ///< guesses, where `knowledge` is `search`
  KeptTraces traces = KeptTraces::kNone;
  SweepQuestion question;
  std::string file;  ///< that says all this; empty: none
  /// Where: of `scenarios`, `seeds`, `variations`, `set.KEY`, `axes.KEY`.
  std::map<std::string, int> lines;
};

/// Reads a sweep file; docs/sweeps.md has its keys.
/// @throws InputError FILE:LINE: KEY: WHY.
Sweep ReadSweep(const std::string& path);
/// The same from text; `path` stands for the file in messages.
Sweep ParseSweep(const std::string& text, const std::string& path);

/// One run of a sweep.
struct PlannedRun {
  std::string scenario;
  Factors factors;  ///< the values of the axes
  std::uint64_t seed = 1;
  std::uint64_t combination = 0;  ///< counts those of scenario and values
};

/// A sweep's runs in their order: scenarios outermost, then axes in the file's order, seeds
/// innermost. Nothing of it is held in memory run by run but, once Find is asked, 16 bytes.
class SweepPlan {
 public:
  /// @throws InputError if there are more runs than anybody has time for.
  explicit SweepPlan(Sweep sweep);

  const Sweep& sweep() const { return sweep_; }
  std::uint64_t num_runs() const { return num_combinations_ * sweep_.seeds.size(); }
  std::uint64_t num_combinations() const { return num_combinations_; }
  /// @param index below num_runs().
  PlannedRun At(std::uint64_t index) const;
  /// The runs of a combination begin here.
  std::uint64_t FirstOf(std::uint64_t combination) const {
    return combination * sweep_.seeds.size();
  }

  /// What a run is called, whatever else the sweep holds: a hash of the scenario's name, every
  /// setting and value, and the seed. It knows neither what is in the scenario's file nor the
  /// program.
  std::uint64_t KeyOf(std::uint64_t index) const;
  /// Where the run of that key stands. Only from one thread at a time.
  std::optional<std::uint64_t> Find(std::uint64_t key) const;

  /// One word for all that is planned.
  std::string Hash() const;

 private:
  Fingerprint HashOf(std::uint64_t combination) const;
  void SortKeys() const;

  Sweep sweep_;
  std::uint64_t num_combinations_ = 1;
  mutable std::vector<std::pair<std::uint64_t, std::uint64_t>> by_key_;  // sorted
};

/// 16 hexadecimal digits, and back.
std::string KeyText(std::uint64_t key);
std::optional<std::uint64_t> KeyFromText(const std::string& text);

}  // namespace sidestep::bench
