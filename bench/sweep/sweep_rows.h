#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "sidestep/bench/sweep/shard_file.h"
#include "sidestep/bench/sweep/sweep.h"

namespace sidestep::bench {

/// Which runs of a plan are finished, and where in the shards of its folder their rows stand. Of a
/// run that was finished twice the first row counts.
class SweepRows {
 public:
  /// @param plan must outlive it.
  /// @param folder of the shards.
  /// @param maker rows made otherwise do not count; they are told in other_makers().
  /// @param leave_out a shard whose rows cannot be of interest, and need not be read.
  SweepRows(const SweepPlan& plan, std::string folder, const ShardMaker& maker,
            const std::function<bool(const ShardName&)>& leave_out = {});

  bool Has(std::uint64_t index) const { return places_[index].size > 0; }
  std::uint64_t num_done() const { return num_done_; }
  /// How many ended how.
  const std::map<std::string, std::uint64_t>& outcomes() const { return outcomes_; }
  /// Rows of a run that a later one of another content contradicts: it did not repeat.
  const std::vector<std::uint64_t>& contradicted() const { return contradicted_; }
  /// What a person should know of the files: damaged lines.
  const std::vector<std::string>& damage() const { return damage_; }
  /// Rows of other builds or inputs, by who made them as text.
  std::uint64_t num_of_other_makers() const { return num_of_others_; }
  ShardMaker other_maker() const { return other_; }
  /// Rows of runs that the plan does not hold.
  std::uint64_t num_unasked() const { return num_unasked_; }
  const std::vector<ShardName>& shards() const { return shards_; }
  /// Those that another process is writing.
  const std::vector<ShardName>& being_written() const { return being_written_; }

  /// A finished run: its row, but for its factors and command, and on which machine it was made.
  struct Found {
    RunRow row;
    int machine = 0;
  };
  Found Read(std::uint64_t index) const;
  const std::vector<std::map<std::string, std::string>>& machines() const { return machines_; }
  /// The keys of RunRow::drawn.
  std::vector<std::string> Drawn() const;

 private:
  struct Place {
    std::uint64_t offset = 0, same = 0;  // a hash of what equal runs agree in
    std::uint32_t size = 0, shard = 0;
    std::uint16_t machine = 0;
  };

  void ReadOne(std::size_t shard);
  int NumberOf(const std::map<std::string, std::string>& machine);

  const SweepPlan& plan_;
  std::string folder_;
  ShardMaker maker_, other_;
  std::vector<ShardName> shards_, being_written_;
  std::vector<Place> places_;
  std::map<std::string, std::uint64_t> outcomes_;
  std::map<std::string, int> drawn_;
  std::vector<std::uint64_t> contradicted_;
  std::vector<std::string> damage_;
  std::vector<std::map<std::string, std::string>> machines_;
  std::uint64_t num_done_ = 0, num_of_others_ = 0, num_unasked_ = 0;
};

}  // namespace sidestep::bench
