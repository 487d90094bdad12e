#pragma once

#include "sidestep/core/cpu_time.h"

namespace sidestep::sdf {

/// Measures the CPU time of stages on this thread, for reports. Nothing may depend on it.
class Stopwatch {
 public:
  /// Seconds since the last call, or since it was made.
  double Lap() {
    const double now_s = ThreadCpuSeconds();
    const double elapsed_s = now_s - start_s_;
    start_s_ = now_s;
    return elapsed_s;
  }

 private:
  double start_s_ = ThreadCpuSeconds();
};

}  // namespace sidestep::sdf
