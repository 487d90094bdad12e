#include "sidestep/bench/statistics/pairwise_means.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <numeric>

namespace sidestep::bench {
namespace {

// Doubles in their order as whole numbers in theirs: between two neighbours there is no other.
std::int64_t OrderOf(double value) {
  const auto bits = std::bit_cast<std::int64_t>(value);
  return bits >= 0 ? bits : std::numeric_limits<std::int64_t>::min() - bits;
}
double InOrder(std::int64_t order) {
  return std::bit_cast<double>(order >= 0 ? order
                                          : std::numeric_limits<std::int64_t>::min() - order);
}

double Mean(double a, double b) { return (a + b) / 2; }

// How many means of pairs are at most `limit`: as i ascends, the last j that fits descends, since
// rounding keeps sums in order.
std::uint64_t CountUpTo(double limit, const std::vector<double>& sorted) {
  std::uint64_t count = 0;
  std::size_t end = sorted.size();  // pairs with j < end fit
  for (std::size_t i = 0; i < end; ++i) {
    while (end > i && Mean(sorted[i], sorted[end - 1]) > limit) --end;
    count += end - i;
  }
  return count;
}

// The mean that `rank` others stand before, found by halving the range of doubles that it is in.
double MeanOfRank(std::uint64_t rank, const std::vector<double>& sorted) {
  std::int64_t low = OrderOf(sorted.front()), high = OrderOf(sorted.back());
  while (low < high) {
    const std::int64_t middle = std::midpoint(low, high);
    if (CountUpTo(InOrder(middle), sorted) > rank) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return InOrder(low);
}

}  // namespace

double MedianOfPairwiseMeans(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  // One zero, so that equal means are one double.
  for (double& value : values) value += 0.0;
  std::sort(values.begin(), values.end());
  const std::uint64_t count = std::uint64_t{values.size()} * (values.size() + 1) / 2;
  const double below = MeanOfRank((count - 1) / 2, values);
  return count % 2 == 1 ? below : Mean(below, MeanOfRank(count / 2, values));
}

}  // namespace sidestep::bench
