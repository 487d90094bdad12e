#include "sidestep/bench/study_log.h"

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "sidestep/bench/json_text.h"
#include "sidestep/core/input_error.h"

namespace sidestep::bench {
namespace {

using nlohmann::json;

json ToJson(const StudyRow& row) {
  json metrics = json::object();
  for (const auto& [name, value] : row.metrics) {
    metrics[name] = std::isnan(value) ? json() : json(value);
  }
  return {{"factors", row.factors},
          {"outcome", row.outcome},
          {"error", row.error},
          {"metrics", metrics}};
}

// Throws json::exception for anything else.
StudyRow FromJson(const json& line) {
  StudyRow row;
  line.at("factors").get_to(row.factors);
  line.at("outcome").get_to(row.outcome);
  line.at("error").get_to(row.error);
  for (const auto& [name, value] : line.at("metrics").items()) {
    row.metrics[name] =
        value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
  }
  return row;
}

}  // namespace

StudyLog::StudyLog(const std::string& path, const std::string& study, bool resume) : path_(path) {
  const bool goes_on = resume && std::filesystem::exists(path);
  if (goes_on) Read(study);
  file_.open(path, goes_on ? std::ios::app : std::ios::trunc);
  if (!goes_on) file_ << JsonLine({{"study", study}}) << std::endl;
  if (!file_) throw InputError(path, "cannot be written");
}

void StudyLog::Read(const std::string& study) {
  std::ifstream file(path_);
  if (!file) throw InputError(path_, "cannot be read");
  std::string text;
  std::uintmax_t complete = 0;  // bytes up to the end of the last whole line
  for (int number = 1; std::getline(file, text) && !file.eof(); ++number) {
    complete += text.size() + 1;
    try {
      const json line = json::parse(text);
      if (number > 1) {
        StudyRow row = FromJson(line);
        rows_[row.factors] = std::move(row);
      } else if (line.at("study").get<std::string>() != study) {
        throw InputError(path_, "is of a study with another scenario, version or other settings");
      }
    } catch (const json::exception&) {
      throw InputError(path_ + ":" + std::to_string(number), "is no row of a study");
    }
  }
  if (complete == 0) throw InputError(path_, "is no log of a study");
  file.close();
  std::filesystem::resize_file(path_, complete);
}

const StudyRow* StudyLog::Find(const std::map<std::string, std::string>& factors) const {
  const auto found = rows_.find(factors);
  return found == rows_.end() ? nullptr : &found->second;
}

void StudyLog::Append(const StudyRow& row) {
  file_ << JsonLine(ToJson(row)) << std::endl;
  if (!file_) throw InputError(path_, "cannot be written");
}

}  // namespace sidestep::bench
