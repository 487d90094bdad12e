#pragma once

#include <fstream>
#include <map>
#include <string>

#include "sidestep/bench/study.h"

namespace sidestep::bench {

/// The rows of a study in the order in which they are finished, so that nothing is lost when it is
/// interrupted: a file of one JSON object a line, the first of which says what the study is.
class StudyLog {
 public:
  /// Begins the file anew; with `resume` goes on with the one that is there, if any, and drops a
  /// last line that was cut off.
  /// @param study what rows must have in common to belong together.
  /// @throws InputError if the file cannot be written, is none of ours, or is of another study.
  StudyLog(const std::string& path, const std::string& study, bool resume);

  /// Of the rows that were there: the one with these factors, or null.
  const StudyRow* Find(const std::map<std::string, std::string>& factors) const;
  /// On the disk when it returns. Only from one thread at a time.
  /// @throws InputError if it cannot be written.
  void Append(const StudyRow& row);

 private:
  void Read(const std::string& study);

  std::string path_;
  std::map<std::map<std::string, std::string>, StudyRow> rows_;
  std::ofstream file_;
};

}  // namespace sidestep::bench
