#include "sidestep/bench/study_log.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "sidestep/bench/json_text.h"
#include "sidestep/core/input_error.h"

namespace sidestep::bench {
namespace {

using nlohmann::json;

constexpr const char* kFirstLine = "{\"format\":\"sidestep-study-2\"}\n";

json ToJson(const RunRow& row) {
  json metrics = json::object();
  for (const auto& [name, value] : row.metrics) {
    metrics[name] = std::isnan(value) ? json() : json(value);
  }
  return {{"factors", row.factors},
          {"drawn", row.drawn},
          {"outcome", row.outcome},
          {"error", row.error},
          {"metrics", metrics},
          {"identity",
           {{"scenario", row.identity.scenario},
            {"models", row.identity.models},
            {"build", row.identity.build},
            {"method", row.identity.method}}}};
}

// Throws json::exception for anything else.
RunRow FromJson(const json& line) {
  RunRow row;
  line.at("factors").get_to(row.factors);
  line.at("drawn").get_to(row.drawn);
  line.at("outcome").get_to(row.outcome);
  line.at("error").get_to(row.error);
  for (const auto& [name, value] : line.at("metrics").items()) {
    row.metrics[name] =
        value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
  }
  const json& identity = line.at("identity");
  identity.at("scenario").get_to(row.identity.scenario);
  identity.at("models").get_to(row.identity.models);
  identity.at("build").get_to(row.identity.build);
  identity.at("method").get_to(row.identity.method);
  return row;
}

}  // namespace

StudyLog::StudyLog(const std::string& path, bool resume) : path_(path) {
  file_ = open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file_ < 0) Fail("cannot be written");
  try {
    if (!std::filesystem::is_regular_file(path)) throw InputError(path, "is no regular file");
    if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
      if (errno == EWOULDBLOCK) throw InputError(path, "another study is writing here just now");
      Fail("cannot be locked");
    }
    Read(resume);
  } catch (...) {
    close(file_);
    throw;
  }
}

StudyLog::~StudyLog() { close(file_); }

void StudyLog::Read(bool resume) {
  std::ifstream file(path_, std::ios::binary);
  if (!file) throw InputError(path_, "cannot be read");
  const std::string all(std::istreambuf_iterator<char>(file), {});
  const std::string first_line = kFirstLine;
  if (first_line.starts_with(all)) {  // nothing, or a first line that was cut off
    if (ftruncate(file_, 0) != 0) Fail("cannot be written");
    Write(first_line);
    return;
  }
  if (!all.starts_with(first_line)) {
    throw InputError(path_, "is no log of a study by this version of sidestep");
  }
  if (!resume)
    throw InputError(path_,
                     "holds a study: go on with it by --resume, or choose "
                     "another folder by --out");
  std::size_t begin = first_line.size();
  int number = 2;
  for (std::size_t end; (end = all.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::string place = path_ + ":" + std::to_string(number);
    try {
      RunRow row = FromJson(json::parse(all.substr(begin, end - begin)));
      if (row.outcome != kFailed && !OutcomeFromString(row.outcome)) {
        throw InputError(place, "outcome: no outcome is '" + row.outcome + "'");
      }
      rows_[row.factors] = std::move(row);
    } catch (const json::exception&) {
      throw InputError(place, "is no row of a study");
    }
    ++number;
  }
  if (ftruncate(file_, static_cast<off_t>(begin)) != 0) Fail("cannot be written");
}

const RunRow* StudyLog::Find(const Factors& factors) const {
  const auto found = rows_.find(factors);
  return found == rows_.end() ? nullptr : &found->second;
}

void StudyLog::Append(const RunRow& row) { Write(JsonLine(ToJson(row)) + "\n"); }

void StudyLog::Write(const std::string& line) {
  for (std::size_t done = 0; done < line.size();) {
    const ssize_t count = write(file_, line.data() + done, line.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) Fail("cannot be written");
    done += static_cast<std::size_t>(count);
  }
  if (fsync(file_) != 0) Fail("cannot be written");
}

void StudyLog::Fail(const std::string& what) const {
  throw InputError(path_, what + ": " + std::strerror(errno));
}

}  // namespace sidestep::bench
