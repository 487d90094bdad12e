#include "sidestep/bench/reproduce/csv_table.h"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>
#include <utility>

#include "sidestep/core/input_error.h"

namespace sidestep::bench {
namespace {

constexpr std::size_t kMaxShown = 40;  // characters of a broken field in a message

std::vector<std::string> Split(std::string line) {
  if (!line.empty() && line.back() == '\r') line.pop_back();
  std::vector<std::string> fields(1);
  for (const char c : line) {
    if (c == ',') {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

std::optional<double> ParseNumber(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

std::string Format(double value) {
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value);
  return std::string(text, end);
}

}  // namespace

CsvTable CsvTable::Read(const std::string& path, const std::vector<std::string>& required) {
  std::ifstream stream(path);
  if (!stream || std::filesystem::is_directory(path)) throw InputError(path, "cannot be read");
  std::string line;
  if (!std::getline(stream, line) || line.empty()) {
    throw InputError(path, 1, "", "needs a header of column names");
  }
  CsvTable table(Split(line));
  if (std::set(table.columns_.begin(), table.columns_.end()).size() != table.columns_.size()) {
    throw InputError(path, 1, "", "a column comes twice");
  }
  for (const std::string& column : required) {
    if (!table.Find(column)) throw InputError(path, 1, "", "has no column '" + column + "'");
  }
  for (int number = 2; std::getline(stream, line); ++number) {
    if (line.empty() || line == "\r") continue;
    const std::vector<std::string> fields = Split(line);
    if (fields.size() != table.columns_.size()) {
      throw InputError(path, number, "",
                       "has " + std::to_string(fields.size()) + " fields, the header " +
                           std::to_string(table.columns_.size()));
    }
    std::vector<std::optional<double>> row;
    for (std::size_t c = 0; c < fields.size(); ++c) {
      row.push_back(ParseNumber(fields[c]));
      if (!row.back() && !fields[c].empty()) {
        throw InputError(path, number, table.columns_[c],
                         "must be a finite number, is '" + fields[c].substr(0, kMaxShown) + "'");
      }
    }
    table.rows_.push_back(std::move(row));
  }
  return table;
}

std::string CsvTable::ToText() const {
  std::string text;
  for (std::size_t c = 0; c < columns_.size(); ++c) text += (c == 0 ? "" : ",") + columns_[c];
  text += '\n';
  for (const auto& row : rows_) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (c > 0) text += ',';
      if (row[c]) text += Format(*row[c]);
    }
    text += '\n';
  }
  return text;
}

std::optional<std::size_t> CsvTable::Find(const std::string& column) const {
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    if (columns_[c] == column) return c;
  }
  return {};
}

void CsvTable::AddRow(std::vector<std::optional<double>> row) {
  if (row.size() != columns_.size()) throw std::invalid_argument("CsvTable: one field a column");
  rows_.push_back(std::move(row));
}

}  // namespace sidestep::bench
