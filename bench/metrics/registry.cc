#include "bench/metrics/registry.h"

namespace sidestep {

#define SIDESTEP_METRIC(name, unit, lower_is_better, meaning, compute, file) \
  double compute(const Recording&);
#include "bench/metrics/metrics.def"
#undef SIDESTEP_METRIC

namespace {

constexpr Metric kMetrics[] = {
#define SIDESTEP_METRIC(name, unit, lower_is_better, meaning, compute, file) \
  {name, unit, lower_is_better, meaning, &(compute)},
#include "bench/metrics/metrics.def"
#undef SIDESTEP_METRIC
};

}  // namespace

std::span<const Metric> Metrics() { return kMetrics; }

}  // namespace sidestep
