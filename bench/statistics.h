#pragma once

#include <limits>
#include <vector>

namespace sidestep::bench {

/// A number that is none: where nothing was, or nothing applies.
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The p-quantile (0 <= p <= 1) by linear interpolation between order statistics (Hyndman & Fan's
/// type 7, the default of R and NumPy). NaN for no values.
double Quantile(std::vector<double> values, double p);

}  // namespace sidestep::bench
