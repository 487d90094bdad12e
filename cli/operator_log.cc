#include "sidestep/cli/operator_log.h"

#include <fmt/chrono.h>

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <utility>
#include <vector>

#include "sidestep/core/atomic_file.h"
#include "sidestep/core/csv.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/text_file.h"

namespace sidestep::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostRows = 1000;  // the latest
constexpr const char* kRecovered = "recovered";
const std::vector<std::string> kColumns = {"time_utc", "boot",  "since_boot_s", "robot", "check",
                                           "reaction", "value", "limit",        "why"};
enum Column { kBoot = 1, kSinceBoot = 2, kRobot = 3, kReaction = 5 };

fs::path StateFolder() {
  if (const char* state = std::getenv("XDG_STATE_HOME"); state != nullptr && *state != '\0') {
    return state;
  }
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') {
    return fs::path(home) / ".local/state";
  }
  throw InputError("XDG_STATE_HOME", "is not set, and neither is HOME: hardware.csv has no place");
}

// One session of the machine.
std::string Boot() {
  std::string id = ReadTextFile("/proc/sys/kernel/random/boot_id", 100);
  while (!id.empty() && id.back() == '\n') id.pop_back();
  return id;
}

double SinceBoot_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

CsvFile Read(const std::string& path) {
  if (!fs::exists(path)) return {kColumns, {}};
  CsvFile file = ReadCsv(path);
  if (file.columns != kColumns) throw InputError(path, "is not a log of sidestep hardware");
  return file;
}

}  // namespace

OperatorLog::OperatorLog(std::string robot)
    : robot_(std::move(robot)), path_(StateFolder() / "sidestep/hardware.csv") {}

std::string TodayUtc() { return fmt::format("{:%F}", fmt::gmtime(std::time(nullptr))); }

void OperatorLog::Refused(const hardware::Objection& objection) const {
  Append(objection, control::ToString(control::Reaction::kRefuse));
}

void OperatorLog::Recovered(const std::string& why) const {
  Append({control::SafetyCheck::kRecovery, why}, kRecovered);
}

void OperatorLog::Append(const hardware::Objection& entry, const char* reaction) const {
  std::error_code error;
  fs::create_directories(fs::path(path_).parent_path(), error);  // else it cannot be written
  const CsvFile before = Read(path_);
  CsvWriter csv(kColumns);
  const std::size_t num_old = std::min(before.rows.size(), kMostRows - 1);
  for (std::size_t i = before.rows.size() - num_old; i < before.rows.size(); ++i) {
    csv.AddRow(before.rows[i].fields);
  }
  csv.AddRow({fmt::format("{:%FT%TZ}", fmt::gmtime(std::time(nullptr))), Boot(),
              CsvNumber(SinceBoot_s()), robot_, control::ToString(entry.check), reaction,
              CsvNumber(entry.value), CsvNumber(entry.limit), entry.why});
  WriteFile(path_, csv.text());
}

std::optional<double> OperatorLog::SecondsSinceRecovery() const {
  const CsvFile file = Read(path_);
  const std::string boot = Boot();
  for (auto row = file.rows.rbegin(); row != file.rows.rend(); ++row) {
    const std::vector<std::string>& fields = row->fields;
    if (fields[kBoot] != boot || fields[kRobot] != robot_ || fields[kReaction] != kRecovered) {
      continue;
    }
    return SinceBoot_s() -
           ParseCsvNumber(fields[kSinceBoot], path_, row->line, kColumns[kSinceBoot]);
  }
  return std::nullopt;
}

}  // namespace sidestep::cli
