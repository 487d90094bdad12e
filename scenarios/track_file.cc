#include "sidestep/scenarios/track_file.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>

#include "sidestep/core/input_error.h"

namespace sidestep::scenarios {
namespace {

constexpr std::string_view kPositions = "t,x,y,z", kPoses = "t,x,y,z,qw,qx,qy,qz";
constexpr std::uintmax_t kMaxFileBytes = 4 << 20;  // what so many samples can need

std::string ReadBytes(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) throw InputError(path, "is not a file");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size > kMaxFileBytes) {
    throw InputError(path, "must be at most " + std::to_string(kMaxFileBytes) + " bytes long");
  }
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  if (!stream) throw InputError(path, "cannot be read");
  return bytes.str();
}

std::string Trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r";
  const std::size_t begin = text.find_first_not_of(kSpace);
  if (begin == std::string_view::npos) return "";
  return std::string(text.substr(begin, text.find_last_not_of(kSpace) + 1 - begin));
}

std::vector<std::string> FieldsOf(const std::string& line) {
  std::vector<std::string> fields;
  std::size_t begin = 0, comma = 0;
  do {
    comma = line.find(',', begin);
    fields.push_back(Trimmed(std::string_view(line).substr(begin, comma - begin)));
    begin = comma + 1;
  } while (comma != std::string::npos);
  return fields;
}

// In quotes, fit for a message: short, and without bytes that a terminal may take for commands.
std::string Quote(std::string text) {
  constexpr std::size_t kLongest = 60;
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  for (char& c : text) {
    if (c < ' ' || c > '~') c = '?';
  }
  return "'" + text + "'";
}

double NumberOf(const std::string& field, const std::string& path, int line,
                const std::string& column) {
  double value = 0;
  const char* const end = field.data() + field.size();
  const auto parsed = std::from_chars(field.data(), end, value);
  if (field.empty() || parsed.ec != std::errc() || parsed.ptr != end) {
    throw InputError(path, line, column, "must be a number, is " + Quote(field));
  }
  if (!std::isfinite(value)) throw InputError(path, line, column, "must be finite, is " + field);
  return value;
}

}  // namespace

std::vector<TrackSample> ReadTrackFile(const std::string& path) {
  std::string bytes = ReadBytes(path);
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (bytes.starts_with(kByteOrderMark)) bytes.erase(0, kByteOrderMark.size());
  std::istringstream stream(bytes);
  std::vector<std::string> columns;
  std::vector<TrackSample> samples;
  int line = 0;
  for (std::string text; std::getline(stream, text);) {
    ++line;
    if (Trimmed(text).empty()) continue;
    const std::vector<std::string> fields = FieldsOf(text);
    if (columns.empty()) {
      if (fields != FieldsOf(std::string(kPositions)) && fields != FieldsOf(std::string(kPoses))) {
        throw InputError(path, line, "",
                         "must be the header " + std::string(kPositions) + " or " +
                             std::string(kPoses) + ", is " + Quote(Trimmed(text)));
      }
      columns = fields;
      continue;
    }
    if (fields.size() != columns.size()) {
      throw InputError(path, line, "",
                       "must have " + std::to_string(columns.size()) + " fields, has " +
                           std::to_string(fields.size()));
    }
    std::vector<double> row;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      row.push_back(NumberOf(fields[i], path, line, columns[i]));
    }
    if (const auto fault = AppendSample(row, &samples)) {
      throw InputError(path, line, fault->column, fault->why);
    }
  }
  if (columns.empty()) throw InputError(path, "is empty");
  if (samples.size() < 2) {
    throw InputError(path, line, "",
                     "must hold at least 2 samples, holds " + std::to_string(samples.size()));
  }
  return samples;
}

}  // namespace sidestep::scenarios
