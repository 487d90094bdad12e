#include "sidestep/scenarios/track_file.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "sidestep/core/csv.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/text_file.h"

namespace sidestep::scenarios {
namespace {

constexpr std::string_view kPositions = "t,x,y,z", kPoses = "t,x,y,z,qw,qx,qy,qz";
constexpr std::uintmax_t kMaxFileBytes = 4 << 20;  // what so many samples can need

std::string Trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t";
  const std::size_t begin = text.find_first_not_of(kSpace);
  if (begin == std::string_view::npos) return "";
  return std::string(text.substr(begin, text.find_last_not_of(kSpace) + 1 - begin));
}

std::string Joined(const std::vector<std::string>& fields) {
  std::string line;
  for (const std::string& field : fields) line += (line.empty() ? "" : ",") + Trimmed(field);
  return line;
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
  const CsvFile file = ParseCsv(ReadTextFile(path, kMaxFileBytes), path);
  const std::string header = Joined(file.columns);
  if (header != kPositions && header != kPoses) {
    throw InputError(path, 1, "",
                     "must be the header " + std::string(kPositions) + " or " +
                         std::string(kPoses) + ", is " + Quote(header));
  }
  std::vector<TrackSample> samples;
  for (const CsvRow& fields : file.rows) {
    std::vector<double> row;
    for (std::size_t i = 0; i < fields.fields.size(); ++i) {
      row.push_back(
          NumberOf(Trimmed(fields.fields[i]), path, fields.line, Trimmed(file.columns[i])));
    }
    if (const auto fault = AppendSample(row, &samples)) {
      throw InputError(path, fields.line, fault->column, fault->why);
    }
  }
  if (samples.size() < 2) {
    throw InputError(path, file.rows.empty() ? 1 : file.rows.back().line, "",
                     "must hold at least 2 samples, holds " + std::to_string(samples.size()));
  }
  return samples;
}

}  // namespace sidestep::scenarios
