#pragma once

#include <ctime>

namespace sidestep {

/// CPU time that the calling thread has used so far [s]. For reports only: it differs from run to
/// run, so nothing that is simulated or planned may depend on it.
inline double ThreadCpuSeconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace sidestep
