#pragma once

#include <map>
#include <string>

#include "sidestep/bench/run_row.h"

namespace sidestep::bench {

/// The rows of a study in the order in which they are finished, so that nothing is lost when it is
/// interrupted: a file of one JSON object a line, the first of which says what the file is. One
/// process at a time has it.
class StudyLog {
 public:
  /// Opens the file, and begins it if it is not there or does not even hold its first line; drops a
  /// last line that was cut off.
  /// @param resume whether rows may be there; else they are refused.
  /// @throws InputError if the file cannot be written, is none of ours, or another process has it.
  StudyLog(const std::string& path, bool resume);
  ~StudyLog();
  StudyLog(const StudyLog&) = delete;
  StudyLog& operator=(const StudyLog&) = delete;

  /// Of the rows that were there: the latest with these factors, or null. Its trace and command are
  /// not filled.
  const RunRow* Find(const Factors& factors) const;
  /// All rows that were there, the latest with its factors each.
  const std::map<Factors, RunRow>& rows() const { return rows_; }
  /// On the disk when it returns. Only from one thread at a time.
  /// @throws InputError if it cannot be written.
  void Append(const RunRow& row);

 private:
  void Read(bool resume);
  void Write(const std::string& line);
  [[noreturn]] void Fail(const std::string& what) const;  // with the reason that errno tells

  std::string path_;
  int file_ = -1;
  std::map<Factors, RunRow> rows_;
};

}  // namespace sidestep::bench
