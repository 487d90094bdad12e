#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <utility>

#include "sidestep/bench/sweep/sweep.h"
#include "sidestep/core/fingerprint.h"
#include "sidestep/core/input_error.h"

namespace sidestep::bench {
namespace {

constexpr std::uint64_t kMostRuns = 100'000'000;

std::uint64_t WithSeed(Fingerprint hash, std::uint64_t seed) {
  hash.Add(std::to_string(seed));
  return *KeyFromText(hash.Text());
}

}  // namespace

SweepPlan::SweepPlan(Sweep sweep) : sweep_(std::move(sweep)) {
  const auto multiply = [&](std::size_t count) {
    if (num_combinations_ * count > kMostRuns / sweep_.seeds.size()) {
      throw InputError(sweep_.file.empty() ? sweep_.name : sweep_.file,
                       "holds more than 100 million runs");
    }
    num_combinations_ *= count;
  };
  multiply(sweep_.scenarios.size());
  for (const SweepAxis& axis : sweep_.axes) multiply(axis.values.size());
}

PlannedRun SweepPlan::At(std::uint64_t index) const {
  PlannedRun run;
  run.seed = sweep_.seeds[index % sweep_.seeds.size()];
  run.combination = index / sweep_.seeds.size();
  std::uint64_t rest = run.combination;
  for (auto axis = sweep_.axes.rbegin(); axis != sweep_.axes.rend(); ++axis) {
    run.factors[axis->name] = axis->values[rest % axis->values.size()];
    rest /= axis->values.size();
  }
  run.scenario = sweep_.scenarios[rest];
  return run;
}

// Of the combination's settings and values by their keys' order, so that it is the same run however
// the axes stand in the file, and whether a value is fixed or varied.
Fingerprint SweepPlan::HashOf(std::uint64_t combination) const {
  PlannedRun run = At(FirstOf(combination));
  Factors all(sweep_.settings.begin(), sweep_.settings.end());
  all.merge(run.factors);
  Fingerprint hash;
  hash.Add(run.scenario);
  for (const auto& [key, value] : all) {
    hash.Add(key);
    hash.Add(value);
  }
  const auto knowledge = all.find("knowledge");
  if (knowledge != all.end() && knowledge->second == "search") {
    hash.Add("search " + std::to_string(sweep_.search));
  }
  return hash;
}

std::uint64_t SweepPlan::KeyOf(std::uint64_t index) const {
  return WithSeed(HashOf(index / sweep_.seeds.size()), sweep_.seeds[index % sweep_.seeds.size()]);
}

void SweepPlan::SortKeys() const {
  by_key_.reserve(num_runs());
  for (std::uint64_t combination = 0; combination < num_combinations_; ++combination) {
    const Fingerprint hash = HashOf(combination);
    for (const std::uint64_t seed : sweep_.seeds) {
      by_key_.emplace_back(WithSeed(hash, seed), by_key_.size());
    }
  }
  std::sort(by_key_.begin(), by_key_.end());
  const auto twice =
      std::adjacent_find(by_key_.begin(), by_key_.end(),
                         [](const auto& a, const auto& b) { return a.first == b.first; });
  if (twice != by_key_.end()) {
    throw InputError(sweep_.name,
                     fmt::format("its runs {} and {} have one key: they would be taken "
                                 "for the same run",
                                 twice->second, std::next(twice)->second));
  }
}

std::optional<std::uint64_t> SweepPlan::Find(std::uint64_t key) const {
  if (by_key_.empty()) SortKeys();
  const auto found =
      std::lower_bound(by_key_.begin(), by_key_.end(), std::pair(key, std::uint64_t{0}));
  if (found == by_key_.end() || found->first != key) return {};
  return found->second;
}

std::string SweepPlan::Hash() const {
  Fingerprint all;
  for (std::uint64_t combination = 0; combination < num_combinations_; ++combination) {
    all.Add(HashOf(combination).Text());
  }
  for (const std::uint64_t seed : sweep_.seeds) all.Add(std::to_string(seed));
  return all.Text();
}

std::string KeyText(std::uint64_t key) { return fmt::format("{:016x}", key); }

std::optional<std::uint64_t> KeyFromText(const std::string& text) {
  std::uint64_t key = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), key, 16);
  const bool is_whole = parsed.ec == std::errc() && parsed.ptr == text.data() + text.size();
  return is_whole && text.size() == 16 ? std::optional(key) : std::nullopt;
}

}  // namespace sidestep::bench
