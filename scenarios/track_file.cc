#include "sidestep/scenarios/track_file.h"

#include <cstdint>

#include "sidestep/core/csv.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/text_file.h"
#include "sidestep/core/utf8.h"

namespace sidestep::scenarios {
namespace {

const std::vector<std::string> kPositions = {"t", "x", "y", "z"};
const std::vector<std::string> kPoses = {"t", "x", "y", "z", "qw", "qx", "qy", "qz"};
constexpr std::uintmax_t kMaxFileBytes = 4 << 20;  // what so many samples can need
constexpr std::size_t kMaxShown = 60;              // bytes of a wrong header in a message

void Trim(std::vector<std::string>& fields) {
  constexpr const char* kSpace = " \t";
  for (std::string& field : fields) {
    field.erase(0, field.find_first_not_of(kSpace));
    field.erase(field.find_last_not_of(kSpace) + 1);
  }
}

}  // namespace

std::vector<TrackSample> ReadTrackFile(const std::string& path) {
  CsvFile file = ParseCsv(ReadTextFile(path, kMaxFileBytes), path);
  Trim(file.columns);
  if (file.columns != kPositions && file.columns != kPoses) {
    throw InputError(path, 1, "",
                     "must be the header " + Joined(kPositions, ",") + " or " +
                         Joined(kPoses, ",") + ", is '" +
                         Utf8Prefix(Joined(file.columns, ","), kMaxShown) + "'");
  }
  std::vector<TrackSample> samples;
  int line = 1;
  for (CsvRow& row : file.rows) {
    line = row.line;
    Trim(row.fields);
    std::vector<double> numbers;
    for (std::size_t i = 0; i < row.fields.size(); ++i) {
      numbers.push_back(ParseCsvNumber(row.fields[i], path, line, file.columns[i]));
    }
    if (const auto fault = AppendSample(numbers, &samples)) {
      throw InputError(path, line, fault->column, fault->why);
    }
  }
  if (samples.size() < 2) {
    throw InputError(path, line, "",
                     "must hold at least 2 samples, holds " + std::to_string(samples.size()));
  }
  return samples;
}

}  // namespace sidestep::scenarios
