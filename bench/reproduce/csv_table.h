#pragma once

#include <optional>
#include <string>
#include <vector>

namespace sidestep::bench {

/// A table of numbers with a header, as the published results come. Fields may be empty.
class CsvTable {
 public:
  explicit CsvTable(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  /// Fields hold numbers or nothing.
  /// @throws InputError FILE:LINE: WHY as ReadCsv (core/csv.h), and for a field that is neither
  /// empty nor a finite number.
  /// @param required names columns that it must have. @throws InputError likewise without one.
  static CsvTable Read(const std::string& path, const std::vector<std::string>& required = {});

  /// As Read wants it, every number with the fewest digits that give it back exactly.
  std::string ToText() const;

  const std::vector<std::string>& columns() const { return columns_; }
  /// The index of a column, if there is one of that name.
  std::optional<std::size_t> Find(const std::string& column) const;

  std::size_t num_rows() const { return rows_.size(); }
  std::optional<double> At(std::size_t row, std::size_t column) const { return rows_[row][column]; }
  /// The field of `column` in the row whose `key_column` is `key`; of several such rows, the
  /// median. Nothing if there is none, or no such column.
  std::optional<double> Lookup(const std::string& key_column, double key,
                               const std::string& column) const;
  /// @throws std::invalid_argument for another number of fields than columns.
  void AddRow(std::vector<std::optional<double>> row);

 private:
  std::vector<std::string> columns_;
  std::vector<std::vector<std::optional<double>>> rows_;
};

}  // namespace sidestep::bench
