#include "sidestep/bench/statistics/proportions.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sidestep::bench {

Interval WilsonInterval(int successes, int trials, double z) {
  if (trials < 1 || successes < 0 || successes > trials) {
    throw std::invalid_argument("WilsonInterval: needs 0 <= successes <= trials, trials >= 1");
  }
  const double n = trials, rate = successes / n;
  const double middle = (successes + z * z / 2) / (n + z * z);
  const double half = z / (n + z * z) * std::sqrt(rate * (1 - rate) * n + z * z / 4);
  return {successes == 0 ? 0 : middle - half, successes == trials ? 1 : middle + half};
}

double McNemarExactP(int only_first, int only_second) {
  if (only_first < 0 || only_second < 0) {
    throw std::invalid_argument("McNemarExactP: numbers of pairs must be >= 0");
  }
  const int n = only_first + only_second;
  double tail = 0;
  for (int i = 0; i <= std::min(only_first, only_second); ++i) {
    tail += std::exp(std::lgamma(n + 1.0) - std::lgamma(i + 1.0) - std::lgamma(n - i + 1.0) -
                     n * std::log(2.0));
  }
  return std::min(1.0, 2 * tail);
}

}  // namespace sidestep::bench
