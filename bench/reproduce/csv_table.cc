#include "sidestep/bench/reproduce/csv_table.h"

#include <stdexcept>
#include <utility>

#include "sidestep/bench/statistics.h"
#include "sidestep/core/csv.h"
#include "sidestep/core/input_error.h"

namespace sidestep::bench {

CsvTable CsvTable::Read(const std::string& path, const std::vector<std::string>& required) {
  const CsvFile file = ReadCsv(path);
  CsvTable table(file.columns);
  for (const std::string& column : required) {
    if (!table.Find(column)) throw InputError(path, 1, "", "has no column '" + column + "'");
  }
  for (const CsvRow& line : file.rows) {
    std::vector<std::optional<double>> row;
    for (std::size_t c = 0; c < line.fields.size(); ++c) {
      const std::string& field = line.fields[c];
      row.emplace_back();
      if (!field.empty()) row.back() = ParseCsvNumber(field, path, line.line, table.columns_[c]);
    }
    table.rows_.push_back(std::move(row));
  }
  return table;
}

std::string CsvTable::ToText() const {
  CsvWriter csv(columns_);
  for (const auto& row : rows_) {
    std::vector<std::string> fields;
    for (const std::optional<double>& value : row) fields.push_back(value ? CsvNumber(*value) : "");
    csv.AddRow(fields);
  }
  return csv.text();
}

std::optional<std::size_t> CsvTable::Find(const std::string& column) const {
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    if (columns_[c] == column) return c;
  }
  return {};
}

std::optional<double> CsvTable::Lookup(const std::string& key_column, double key,
                                       const std::string& column) const {
  const auto key_index = Find(key_column), index = Find(column);
  if (!key_index || !index) return {};
  std::vector<double> values;
  for (const auto& row : rows_) {
    if (row[*key_index] == key && row[*index]) values.push_back(*row[*index]);
  }
  if (values.empty()) return {};
  return Quantile(std::move(values), 0.5);
}

void CsvTable::AddRow(std::vector<std::optional<double>> row) {
  if (row.size() != columns_.size()) throw std::invalid_argument("CsvTable: one field a column");
  rows_.push_back(std::move(row));
}

}  // namespace sidestep::bench
