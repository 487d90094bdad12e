#pragma once

#include <string>
#include <vector>

namespace sidestep {

/// Builds the text of a CSV file: a header, then rows; UTF-8, lines ended by LF, fields in quotes
/// where they must be (RFC 4180).
class CsvWriter {
 public:
  explicit CsvWriter(const std::vector<std::string>& columns);

  /// @throws std::invalid_argument for another number of fields than columns.
  void AddRow(const std::vector<std::string>& fields);
  const std::string& text() const { return text_; }

 private:
  void AddLine(const std::vector<std::string>& fields);

  std::size_t num_columns_;
  std::string text_;
};

/// A number as a field: the fewest digits that give it back; empty if it is not finite.
std::string CsvNumber(double value);

/// A field as a number.
/// @throws InputError `NAME:LINE: COLUMN: must be a finite number, is 'FIELD'`.
double ParseCsvNumber(const std::string& field, const std::string& name, int line,
                      const std::string& column);

struct CsvRow {
  int line = 0;  ///< of the file, from 1
  std::vector<std::string> fields;
};

struct CsvFile {
  std::vector<std::string> columns;  ///< no two alike
  std::vector<CsvRow> rows;          ///< each with as many fields as there are columns
};

/// Reads what CsvWriter and spreadsheets write: fields in quotes or not, lines ended by LF or CRLF;
/// empty lines are skipped.
/// @param name stands for the file in messages.
/// @throws InputError `NAME:LINE: WHY` if it is not UTF-8, has no header, a column twice, a row of
/// another length, or a quote that is not closed.
CsvFile ParseCsv(const std::string& bytes, const std::string& name);
/// The same from a file. @throws InputError likewise, or if it cannot be read.
CsvFile ReadCsv(const std::string& path);

}  // namespace sidestep
