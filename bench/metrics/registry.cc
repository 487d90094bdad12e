#include "sidestep/bench/metrics/registry.h"

namespace sidestep::bench {

#define SIDESTEP_METRIC(name, unit, lower_is_better, meaning, compute, file) \
  double compute(const record::Recording&);
#include "sidestep/bench/metrics/metrics.def"
#undef SIDESTEP_METRIC

namespace {

constexpr Metric kMetrics[] = {
#define SIDESTEP_METRIC(name, unit, lower_is_better, meaning, compute, file) \
  {name, unit, lower_is_better, meaning, &(compute)},
#include "sidestep/bench/metrics/metrics.def"
#undef SIDESTEP_METRIC
};

}  // namespace

std::span<const Metric> Metrics() { return kMetrics; }

void ComputeMetrics(record::Recording& recording) {
  for (const Metric& metric : Metrics()) recording.metrics[metric.name] = metric.compute(recording);
}

}  // namespace sidestep::bench
