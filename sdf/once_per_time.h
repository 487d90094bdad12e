#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "sidestep/core/time.h"

namespace sidestep::sdf {

/// A pure function of time that computes its value once for each time it is asked about: a planner
/// asks about its few support times in every iteration. Copies share what is known. Safe from many
/// threads.
template <class Value>
class OncePerTime {
 public:
  explicit OncePerTime(std::function<Value(EpisodeTime)> compute)
      : known_(std::make_shared<Known>()) {
    known_->compute = std::move(compute);
  }

  Value operator()(EpisodeTime t) const {
    const std::lock_guard<std::mutex> lock(known_->mutex);
    const auto found = known_->values.find(t.seconds());
    if (found != known_->values.end()) return found->second;
    if (known_->values.size() >= kMostTimes) known_->values.clear();
    return known_->values.emplace(t.seconds(), known_->compute(t)).first->second;
  }

 private:
  // No planner has as many; who asks about ever other times shall not fill the memory.
  static constexpr std::size_t kMostTimes = 4096;

  struct Known {
    std::function<Value(EpisodeTime)> compute;
    std::mutex mutex;
    std::map<double, Value> values;
  };
  std::shared_ptr<Known> known_;
};

}  // namespace sidestep::sdf
