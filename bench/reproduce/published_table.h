#pragma once

#include <string>
#include <vector>

#include "sidestep/bench/report/table.h"
#include "sidestep/bench/reproduce/csv_table.h"
#include "sidestep/bench/reproduce/open_loop_study.h"

namespace sidestep::bench {

/// The rows as a table: first the columns of the published files, under their names and in their
/// order, for the kinds of knowledge that were run; then ours. What is not finite is left empty.
CsvTable MakeOpenLoopTable(const OpenLoopStudy& study);

/// How one column compares, over the rows that both tables have.
struct ColumnComparison {
  std::string column;
  bool is_count = false;
  int compared = 0;
  int agreeing = 0;  ///< counts: equal; costs: within kCostTolerance
  double largest_relative_difference = 0;
  double mean_ours = 0, mean_published = 0;
};

/// One entry in which the tables do not agree.
struct EntryDifference {
  int pair = 0;
  double speed_m_s = 0;
  std::string column;
  double ours = 0, published = 0;
};

struct TableComparison {
  std::vector<ColumnComparison> columns;  ///< those that both tables have
  std::vector<EntryDifference> differences;
  int rows_compared = 0;
  int rows_only_ours = 0, rows_only_published = 0;

  int CountsCompared() const;
  int CountsAgreeing() const;
  /// False too where there was nothing to compare.
  bool AllCountsAgree() const {
    return CountsCompared() > 0 && CountsCompared() == CountsAgreeing();
  }
};

/// Costs that differ by more than this share are listed.
inline constexpr double kCostTolerance = 1e-6;

/// Compares row by row: rows belong together by pair and speed. Columns or fields that one of the
/// two does not have are not compared, nor are those of our own making.
/// @param published_path names the published table in errors.
/// @throws InputError if `published` has no column for the pair or the speed, an empty field there,
/// or the same row twice.
TableComparison CompareTables(const CsvTable& ours, const CsvTable& published,
                              const std::string& published_path);

/// One row a column that was compared.
TextTable MakeTextTable(const TableComparison& comparison);

/// The comparison in words, for a person to read.
std::string Describe(const TableComparison& comparison);

}  // namespace sidestep::bench
