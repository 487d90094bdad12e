#include "sidestep/bench/sweep/sweep_rows.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <optional>
#include <utility>

#include "sidestep/core/fingerprint.h"
#include "sidestep/core/input_error.h"

namespace sidestep::bench {
namespace {

// The first string after `mark`, as RowText writes it.
std::string StringAfter(const std::string& text, const std::string& mark) {
  const std::size_t begin = text.find(mark);
  if (begin == std::string::npos) return "";
  const std::size_t from = begin + mark.size();
  return text.substr(from, text.find('"', from) - from);
}

}  // namespace

SweepRows::SweepRows(const SweepPlan& plan, std::string folder, const ShardMaker& maker,
                     const std::function<bool(const ShardName&)>& leave_out)
    : plan_(plan), folder_(std::move(folder)), maker_(maker), places_(plan.num_runs()) {
  for (const ShardName& shard : ShardsIn(folder_)) {
    if (leave_out && leave_out(shard)) continue;
    shards_.push_back(shard);
    ReadOne(shards_.size() - 1);
  }
}

void SweepRows::ReadOne(std::size_t shard) {
  const std::string path = folder_ + "/" + FileOf(shards_[shard]);
  const auto use = [&](const ShardLine& line, const ShardSession& session) {
    if (!(session.maker == maker_)) {
      ++num_of_others_;
      other_ = session.maker;
      return;
    }
    const std::optional<std::uint64_t> index = plan_.Find(line.key);
    if (!index) {
      ++num_unasked_;
      return;
    }
    Fingerprint same;
    same.Add(SameIn(line.text));
    const std::uint64_t hash = *KeyFromText(same.Text());
    Place& place = places_[*index];
    if (place.size > 0) {
      if (place.same != hash) contradicted_.push_back(*index);
      return;
    }
    place = {line.offset, hash, static_cast<std::uint32_t>(line.size),
             static_cast<std::uint32_t>(shard),
             static_cast<std::uint16_t>(NumberOf(session.machine))};
    ++num_done_;
    ++outcomes_[StringAfter(line.text, "{\"o\":\"")];
    if (line.text.find("\"d\":{}") == std::string::npos) {
      for (const auto& [key, value] : RowFromText(line.text, "", path).drawn) ++drawn_[key];
    }
  };
  const ShardReading reading = ReadShard(path, use);
  damage_.insert(damage_.end(), reading.damage.begin(), reading.damage.end());
  if (reading.is_being_written) being_written_.push_back(shards_[shard]);
}

int SweepRows::NumberOf(const std::map<std::string, std::string>& machine) {
  const auto found = std::find(machines_.begin(), machines_.end(), machine);
  if (found == machines_.end()) {
    machines_.push_back(machine);
    return static_cast<int>(machines_.size()) - 1;
  }
  return static_cast<int>(found - machines_.begin());
}

SweepRows::Found SweepRows::Read(std::uint64_t index) const {
  const Place& place = places_[index];
  const std::string path = folder_ + "/" + FileOf(shards_[place.shard]);
  std::ifstream stream(path, std::ios::binary);
  std::string line(place.size, '\0');
  stream.seekg(static_cast<std::streamoff>(place.offset));
  stream.read(line.data(), place.size);
  const std::size_t text = line.find('\t', line.find('\t') + 1) + 1;
  if (!stream || text == 0) throw InputError(path, "has changed meanwhile");
  return {RowFromText(line.substr(text), maker_.build, path), place.machine};
}

std::vector<std::string> SweepRows::Drawn() const {
  std::vector<std::string> keys;
  for (const auto& [key, count] : drawn_) keys.push_back(key);
  return keys;
}

}  // namespace sidestep::bench
