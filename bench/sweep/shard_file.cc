#include "sidestep/bench/sweep/shard_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <utility>

#include "sidestep/bench/json_text.h"
#include "sidestep/bench/metrics/registry.h"
#include "sidestep/bench/sweep/sweep.h"
#include "sidestep/core/fingerprint.h"
#include "sidestep/core/input_error.h"

namespace sidestep::bench {
namespace {

// A line is CHECK, tab, KEY or kSession, tab, text; JSON holds no tab.
constexpr const char* kFormat = "sidestep-shard-1";
constexpr const char* kSession = "session";
constexpr const char* kEnding = ".rows";
constexpr std::size_t kCheckDigits = 16;
constexpr std::chrono::seconds kSyncEvery(1);

std::string CheckOf(const std::string& text) {
  Fingerprint check;
  check.Add(text);
  return check.Text();
}

std::string SessionText(const ShardMaker& maker,
                        const std::map<std::string, std::string>& machine) {
  std::vector<std::string> metrics;
  for (const Metric& metric : Metrics()) metrics.emplace_back(metric.name);
  return JsonLine({{"format", kFormat},
                   {"build", maker.build},
                   {"inputs", maker.inputs},
                   {"machine", machine},
                   {"metrics", metrics}});
}

// The text of a line that is whole, without its check; else nothing.
std::optional<std::string> Checked(const std::string& line) {
  if (line.size() < kCheckDigits + 1 || line[kCheckDigits] != '\t') return {};
  std::string text = line.substr(kCheckDigits + 1);
  if (CheckOf(text) != line.substr(0, kCheckDigits)) return {};
  return text;
}

// Of a file's first line.
bool IsOurs(const std::string& line) {
  return line.find(std::string("\t") + kSession + "\t{\"format\":\"" + kFormat + "\"") ==
         kCheckDigits;
}

// Who only asks (IsLocked) has it for a moment. Where a file system has no locks, the checks of the
// lines have to do.
bool Lock(int file) {
  for (int tries = 0; flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK; ++tries) {
    if (tries == 20) return false;
    usleep(25'000);
  }
  return true;
}

bool IsLocked(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool is_locked = flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(file);
  return is_locked;
}

}  // namespace

std::string RowText(const RunRow& row) {
  nlohmann::ordered_json metrics = nlohmann::ordered_json::array();
  for (const Metric& metric : Metrics()) {
    const auto found = row.metrics.find(metric.name);
    metrics.push_back(found == row.metrics.end() ? nlohmann::ordered_json()
                                                 : NumberOrNull(found->second));
  }
  if (row.metrics.empty()) metrics.clear();
  const RunSubject& subject = row.subject;
  // Short names: a sweep has a million of these.
  const nlohmann::ordered_json same = {
      {"o", row.outcome},
      {"e", row.error},
      {"t", row.touched},
      {"d", row.drawn},
      {"m", metrics},
      {"i", {row.identity.scenario, row.identity.models, row.identity.method}},
      {"r", !row.identity.build.empty()},
      {"s",
       {subject.robot, subject.planner, subject.knowledge, subject.predictor,
        NumberOrNull(subject.charged_latency_s)}}};
  const RunClock& clock = row.clock;
  const nlohmann::ordered_json times = {NumberOrNull(clock.episode_s),
                                        NumberOrNull(clock.cycle_p50_ms),
                                        NumberOrNull(clock.cycle_p95_ms),
                                        NumberOrNull(clock.cycle_p99_ms),
                                        NumberOrNull(clock.cycle_max_ms),
                                        clock.cycles_over_charge,
                                        clock.late_plans};
  return JsonLine(same) + "\t" + JsonLine(times);
}

std::string SameIn(const std::string& row_text) { return row_text.substr(0, row_text.find('\t')); }

RunRow RowFromText(const std::string& text, const std::string& build, const std::string& place) {
  RunRow row;
  try {
    const std::size_t tab = text.find('\t');
    const nlohmann::json same = nlohmann::json::parse(text.substr(0, tab));
    same.at("o").get_to(row.outcome);
    same.at("e").get_to(row.error);
    same.at("t").get_to(row.touched);
    same.at("d").get_to(row.drawn);
    const nlohmann::json& metrics = same.at("m");
    std::size_t i = 0;
    for (const Metric& metric : Metrics()) {
      if (!metrics.empty()) row.metrics[metric.name] = NumberOrNaN(metrics.at(i++));
    }
    const nlohmann::json& identity = same.at("i");
    row.identity = {identity.at(0), identity.at(1), same.at("r").get<bool>() ? build : "",
                    identity.at(2)};
    const nlohmann::json& subject = same.at("s");
    row.subject = {subject.at(0), subject.at(1), subject.at(2), subject.at(3),
                   NumberOrNaN(subject.at(4))};
    const nlohmann::json times = nlohmann::json::parse(text.substr(tab + 1));
    row.clock = {NumberOrNaN(times.at(0)), NumberOrNaN(times.at(1)), NumberOrNaN(times.at(2)),
                 NumberOrNaN(times.at(3)), NumberOrNaN(times.at(4)), times.at(5).get<int>(),
                 times.at(6).get<int>()};
  } catch (const nlohmann::json::exception&) {
    throw InputError(place, "is no row of this version of sidestep");
  }
  if (row.outcome != kFailed && !OutcomeFromString(row.outcome)) {
    throw InputError(place, "no outcome is '" + row.outcome + "'");
  }
  return row;
}

ShardWriter::ShardWriter(const std::string& path, const ShardMaker& maker,
                         const std::map<std::string, std::string>& machine)
    : path_(path) {
  file_ = open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file_ < 0) Fail("cannot be written");
  try {
    if (!std::filesystem::is_regular_file(path)) throw InputError(path, "is no regular file");
    if (!Lock(file_)) throw InputError(path, "another process is writing here just now");
    std::ifstream stream(path, std::ios::binary);
    std::string line;
    std::getline(stream, line);
    if (!stream.eof() && !IsOurs(line)) {
      throw InputError(path, "is no shard of this version of sidestep");
    }
    while (!stream.eof()) {  // the line is whole
      size_ += line.size() + 1;
      std::getline(stream, line);
    }
    if (ftruncate(file_, static_cast<off_t>(size_)) != 0) Fail("cannot be written");
    Write(std::string(kSession) + "\t" + SessionText(maker, machine));
    Sync();
  } catch (...) {
    close(file_);
    throw;
  }
}

ShardWriter::~ShardWriter() { Leave(); }

void ShardWriter::Leave() {
  if (file_ >= 0) close(std::exchange(file_, -1));
}

void ShardWriter::Append(std::uint64_t key, const std::string& row) {
  Write(KeyText(key) + "\t" + row);
  if (std::chrono::steady_clock::now() > synced_ + kSyncEvery) Sync();
}

void ShardWriter::Write(const std::string& text) {
  const std::string line = CheckOf(text) + "\t" + text + "\n";
  for (std::size_t done = 0; done < line.size();) {
    const ssize_t count = write(file_, line.data() + done, line.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      const int error = errno;
      // What there is of it goes, or it would stand in the way of the next one.
      [[maybe_unused]] const int cut = ftruncate(file_, static_cast<off_t>(size_));
      errno = error;
      Fail("cannot be written");
    }
    done += static_cast<std::size_t>(count);
  }
  size_ += line.size();
}

void ShardWriter::Sync() {
  synced_ = std::chrono::steady_clock::now();
  if (fsync(file_) != 0 && errno != EINVAL && errno != ENOSYS) Fail("cannot be written");
}

void ShardWriter::Fail(const std::string& what) const {
  throw InputError(path_, what + ": " + std::strerror(errno));
}

ShardReading ReadShard(const std::string& path,
                       const std::function<void(const ShardLine&, const ShardSession&)>& use) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(path, "cannot be read");
  ShardReading reading;
  reading.is_being_written = IsLocked(path);
  std::optional<ShardSession> session;
  std::string line;
  std::uint64_t offset = 0;
  for (int number = 1; std::getline(stream, line) && !stream.eof(); ++number) {
    ShardLine row{offset, line.size(), 0, {}};
    offset += line.size() + 1;
    const std::string place = path + ":" + std::to_string(number);
    if (number == 1 && !IsOurs(line)) {
      throw InputError(path, "is no shard of this version of sidestep");
    }
    const std::optional<std::string> text = Checked(line);
    const std::size_t tab = text ? text->find('\t') : std::string::npos;
    const std::string head = text ? text->substr(0, tab) : "";
    const std::optional<std::uint64_t> key = KeyFromText(head);
    if (tab != std::string::npos && head == kSession) {
      try {
        const nlohmann::json begun = nlohmann::json::parse(text->substr(tab + 1));
        session = {{begun.at("build"), begun.at("inputs")}, begun.at("machine")};
      } catch (const nlohmann::json::exception&) {
        throw InputError(place, "is no session of this version of sidestep");
      }
    } else if (tab != std::string::npos && key && session) {
      row.key = *key;
      row.text = text->substr(tab + 1);
      use(row, *session);
    } else {
      reading.damage.push_back(place + ": is damaged: the run that it told of counts as missing");
    }
  }
  return reading;
}

std::string FileOf(const ShardName& shard) {
  return std::to_string(shard.number) + "-of-" + std::to_string(shard.of) + kEnding;
}

std::vector<ShardName> ShardsIn(const std::string& folder) {
  std::vector<ShardName> shards;
  std::error_code error;
  for (auto entry = std::filesystem::directory_iterator(folder, error);
       !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    ShardName shard;
    const char* const end = name.data() + name.size();
    const auto number = std::from_chars(name.data(), end, shard.number);
    constexpr std::string_view kOf = "-of-";
    if (number.ec != std::errc() || !std::string_view(number.ptr, end).starts_with(kOf)) continue;
    const auto of = std::from_chars(number.ptr + kOf.size(), end, shard.of);
    if (of.ec == std::errc() && FileOf(shard) == name) shards.push_back(shard);
  }
  std::sort(shards.begin(), shards.end(), [](const ShardName& a, const ShardName& b) {
    return std::pair(a.of, a.number) < std::pair(b.of, b.number);
  });
  return shards;
}

}  // namespace sidestep::bench
