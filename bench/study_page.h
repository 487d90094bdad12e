#pragma once

#include <string>
#include <vector>

#include "sidestep/bench/study.h"

namespace sidestep::bench {

/// The factors that a table lists down and across.
struct TableAxes {
  std::string down, across;  ///< empty: none
};

/// A Markdown table: how many episodes reached the goal touching nothing, of how many, for each
/// value of one factor (down) and another (across), in the order in which they come; below it how
/// the others ended. Without `down` only the sums; without `across` one column.
std::string OutcomeTable(const std::vector<StudyRow>& rows, const TableAxes& axes);

/// What a study is of.
struct StudySubject {
  std::string scenario;     ///< its name
  std::string description;  ///< its own
  std::string command;      ///< what makes the study, quoted for a shell
};

/// A page in Markdown: of what the study is, what is varied, and its table.
std::string StudyPage(const StudySubject& subject, const std::vector<StudyRow>& rows,
                      const TableAxes& axes);

}  // namespace sidestep::bench
