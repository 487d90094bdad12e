#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "sidestep/bench/run_row.h"

namespace sidestep::bench {

/// What the rows of a shard are worth: rows made otherwise are of other runs.
struct ShardMaker {
  std::string build;   ///< the linker's id of the program
  std::string inputs;  ///< a fingerprint of the scenarios and robots
  friend bool operator==(const ShardMaker&, const ShardMaker&) = default;
};

/// The rows of a part of a sweep's runs, as they are finished: a file of one process, lines of text
/// each of which tells whether it is whole. Everything that has been appended is there, whatever
/// becomes of the process.
class ShardWriter {
 public:
  /// Goes on with a file, or begins it; drops a last line that was cut off.
  /// @param machine what the machine is like that makes the rows to come.
  /// @throws InputError if it cannot be written, is none of ours, or another process has it.
  ShardWriter(const std::string& path, const ShardMaker& maker,
              const std::map<std::string, std::string>& machine);
  ~ShardWriter();
  ShardWriter(const ShardWriter&) = delete;
  ShardWriter& operator=(const ShardWriter&) = delete;

  /// Brings what there is to the disk now and then, too.
  /// @param row as RowText has it. @throws InputError if it cannot be written; then the file ends
  /// with the row before it.
  void Append(std::uint64_t key, const std::string& row);
  /// Brings it to the disk.
  void Sync();
  /// In a process that was forked off, which has no business with it.
  void Leave();

 private:
  void Write(const std::string& line);
  [[noreturn]] void Fail(const std::string& what) const;  // with the reason that errno tells

  std::string path_;
  int file_ = -1;
  std::uint64_t size_ = 0;
  std::chrono::steady_clock::time_point synced_;
};

/// A row as a line of text holds it, in two parts: what equal runs agree in, and the clock.
std::string RowText(const RunRow& row);
/// Reads it back, but for factors, trace and command. @throws InputError `PLACE: WHY`.
RunRow RowFromText(const std::string& text, const std::string& build, const std::string& place);
/// The part that equal runs agree in.
std::string SameIn(const std::string& row_text);

/// Where a line of a shard stands.
struct ShardLine {
  std::uint64_t offset = 0;
  std::size_t size = 0;
  std::uint64_t key = 0;
  std::string text;  ///< RowText
};

/// Who wrote a part of a shard.
struct ShardSession {
  ShardMaker maker;
  std::map<std::string, std::string> machine;
};

struct ShardReading {
  std::vector<std::string> damage;  ///< a line for each line of the file that is not whole
  bool is_being_written = false;    ///< by a process that has it now
};

/// Calls `use` with every row and who wrote it, in the file's order, in memory that does not grow
/// with them.
/// @throws InputError if it cannot be read or is none of ours.
ShardReading ReadShard(const std::string& path,
                       const std::function<void(const ShardLine&, const ShardSession&)>& use);

/// The shards of a sweep: `I-of-N.rows` in a folder.
struct ShardName {
  int number = 1, of = 1;
};
std::string FileOf(const ShardName& shard);
/// Those that are there, by their names' order; none if there is no folder.
std::vector<ShardName> ShardsIn(const std::string& folder);

}  // namespace sidestep::bench
