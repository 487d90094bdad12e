#include "sidestep/core/csv.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <set>
#include <stdexcept>
#include <utility>

#include "sidestep/core/input_error.h"
#include "sidestep/core/number_text.h"
#include "sidestep/core/text_file.h"
#include "sidestep/core/utf8.h"

namespace sidestep {
namespace {

constexpr std::uintmax_t kMaxCsvBytes = std::uintmax_t{1} << 30;
constexpr std::size_t kMaxShown = 40;  // bytes of a broken field in a message

std::string Field(const std::string& bytes) {
  const std::string text = EscapeInvalidUtf8(bytes);
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

// Cuts a text into lines of fields.
class Parser {
 public:
  Parser(const std::string& text, const std::string& name) : text_(text), name_(name) {}

  // The next line that holds something; one without fields at the end.
  CsvRow Next() {
    while (at_ < text_.size()) {
      CsvRow row = Line();
      if (row.fields.size() > 1 || !row.fields.front().empty()) return row;
    }
    return {line_, {}};
  }

 private:
  CsvRow Line() {
    CsvRow row = {line_, {}};
    do {
      row.fields.push_back(at_ < text_.size() && text_[at_] == '"' ? InQuotes() : Plain());
    } while (at_ < text_.size() && text_[at_++] == ',');
    ++line_;
    return row;
  }
  std::string Plain() {
    const std::size_t end = std::min(text_.find_first_of(",\n", at_), text_.size());
    return text_.substr(std::exchange(at_, end), end - at_);
  }
  std::string InQuotes() {
    const int first_line = line_;
    std::string field;
    for (++at_; at_ < text_.size(); ++at_) {
      if (text_[at_] == '"') {
        ++at_;
        if (at_ == text_.size() || text_[at_] == ',' || text_[at_] == '\n') return field;
        if (text_[at_] != '"') throw InputError(name_, line_, "", "something follows a quote");
      }
      line_ += text_[at_] == '\n';
      field += text_[at_];
    }
    throw InputError(name_, first_line, "", "a quote is not closed");
  }

  const std::string& text_;
  const std::string& name_;
  std::size_t at_ = 0;
  int line_ = 1;
};

}  // namespace

CsvWriter::CsvWriter(const std::vector<std::string>& columns) : num_columns_(columns.size()) {
  AddLine(columns);
}

void CsvWriter::AddRow(const std::vector<std::string>& fields) {
  if (fields.size() != num_columns_) throw std::invalid_argument("CsvWriter: one field a column");
  AddLine(fields);
}

void CsvWriter::AddLine(const std::vector<std::string>& fields) {
  for (std::size_t i = 0; i < fields.size(); ++i) text_ += (i == 0 ? "" : ",") + Field(fields[i]);
  text_ += '\n';
}

std::string CsvNumber(double value) { return std::isfinite(value) ? ShortestText(value) : ""; }

double ParseCsvNumber(const std::string& field, const std::string& name, int line,
                      const std::string& column) {
  double value = 0;
  const char* const end = field.data() + field.size();
  const auto [parsed_to, error] = std::from_chars(field.data(), end, value);
  if (error != std::errc() || parsed_to != end || !std::isfinite(value)) {
    throw InputError(name, line, column,
                     "must be a finite number, is '" + Utf8Prefix(field, kMaxShown) + "'");
  }
  return value;
}

CsvFile ParseCsv(const std::string& bytes, const std::string& name) {
  const std::string text = DecodeText(bytes, name);
  Parser parser(text, name);
  CsvFile file;
  file.columns = parser.Next().fields;
  const std::vector<std::string>& columns = file.columns;
  if (columns.empty()) throw InputError(name, 1, "", "needs a header of column names");
  if (std::set(columns.begin(), columns.end()).size() != columns.size()) {
    throw InputError(name, 1, "", "a column comes twice");
  }
  for (CsvRow row = parser.Next(); !row.fields.empty(); row = parser.Next()) {
    if (row.fields.size() != columns.size()) {
      throw InputError(name, row.line, "",
                       "has " + std::to_string(row.fields.size()) + " fields, the header " +
                           std::to_string(columns.size()));
    }
    file.rows.push_back(std::move(row));
  }
  return file;
}

CsvFile ReadCsv(const std::string& path) {
  return ParseCsv(ReadTextFile(path, kMaxCsvBytes), path);
}

}  // namespace sidestep
