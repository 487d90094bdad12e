#include "sidestep/cli/memory_watch.h"

#include <malloc.h>

#include <algorithm>

namespace sidestep::cli {

double HeldBytes() {
  const struct mallinfo2 heap = mallinfo2();
  return static_cast<double>(heap.uordblks) + static_cast<double>(heap.hblkhd);
}

MemoryWatch::MemoryWatch(int count) : count_(count), tenth_(std::max(1, count / 10)) {}

void MemoryWatch::Count(double bytes) {
  const bool is_second_tenth = done_ >= tenth_ && done_ < 2 * tenth_;
  if (is_second_tenth) first_ = std::min(first_.value_or(bytes), bytes);
  if (done_ >= count_ - tenth_) last_ = std::min(last_.value_or(bytes), bytes);
  ++done_;
}

std::optional<double> MemoryWatch::Growth() const {
  if (done_ < count_ || !first_ || !last_) return std::nullopt;
  return *last_ - *first_;
}

}  // namespace sidestep::cli
