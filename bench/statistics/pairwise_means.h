#pragma once

#include <vector>

namespace sidestep::bench {

/// Hodges and Lehmann's estimate of a shift: the median of the means of all pairs of values, each
/// value with itself too. In O(n log n) and as much memory as the values need: the means are
/// counted, not made. NaN for no values.
/// @param values finite.
double MedianOfPairwiseMeans(std::vector<double> values);

}  // namespace sidestep::bench
