#include "sidestep/cli/jobs_option.h"

#include <algorithm>

#include "sidestep/bench/task_pool.h"
#include "sidestep/cli/number_range.h"

namespace sidestep::cli {
namespace {

constexpr int kMaxJobs = 256;

}  // namespace

void AddJobsOption(CLI::App& command, int& jobs) {
  command.add_option("-j,--jobs", jobs, "Episodes at a time [the number of cores]")
      ->check(NumberFrom(1, kMaxJobs));
  jobs = std::min(bench::NumProcessors(), kMaxJobs);
}

}  // namespace sidestep::cli
