#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

namespace sidestep::control {

/// A log from one thread, which may not wait, to another, without a lock: of fixed length, made
/// once. What comes while it is full is left out and counted.
template <class Entry>
class RingLog {
 public:
  explicit RingLog(std::size_t capacity) : entries_(capacity + 1) {}

  /// By the writing thread.
  void Append(const Entry& entry) noexcept {
    const std::size_t end = end_.load(std::memory_order_relaxed);
    const std::size_t next = Next(end);
    if (next == begin_.load(std::memory_order_acquire)) {
      lost_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    entries_[end] = entry;
    end_.store(next, std::memory_order_release);
  }

  /// By the reading thread: calls take(entry) for everything that has come since the last time.
  template <class Take>
  void Drain(const Take& take) {
    std::size_t begin = begin_.load(std::memory_order_relaxed);
    const std::size_t end = end_.load(std::memory_order_acquire);
    for (; begin != end; begin = Next(begin)) {
      take(entries_[begin]);
      begin_.store(Next(begin), std::memory_order_release);
    }
  }

  /// How many were left out.
  std::size_t lost() const { return lost_.load(std::memory_order_relaxed); }

 private:
  std::size_t Next(std::size_t i) const { return i + 1 == entries_.size() ? 0 : i + 1; }

  std::vector<Entry> entries_;  // one is always free, so that full and empty differ
  std::atomic<std::size_t> begin_{0}, end_{0}, lost_{0};
};

}  // namespace sidestep::control
