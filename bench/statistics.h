#pragma once

#include <vector>

namespace sidestep::bench {

/// The p-quantile (0 <= p <= 1) by linear interpolation between order statistics (Hyndman & Fan's
/// type 7, the default of R and NumPy). NaN for no values.
double Quantile(std::vector<double> values, double p);

}  // namespace sidestep::bench
