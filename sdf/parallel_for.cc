#include "sidestep/sdf/parallel_for.h"

#include <algorithm>
#include <atomic>
#include <stdexcept>

// Debian's TBB is not built for the thread sanitizer, which then sees races in it that are none.
#ifdef __SANITIZE_THREAD__
#include <thread>
#include <vector>
#else
#include <tbb/parallel_for.h>
#endif

namespace sidestep::sdf {
namespace {

// Calls work(0) ... work(num_workers - 1), at the same time as far as there are threads.
template <class Work>
void RunWorkers(int num_workers, const Work& work) {
#ifdef __SANITIZE_THREAD__
  std::vector<std::jthread> threads;
  for (int worker = 0; worker < num_workers; ++worker) threads.emplace_back(work, worker);
#else
  tbb::parallel_for(0, num_workers, work, tbb::simple_partitioner());
#endif
}

}  // namespace

void RunParallelFor(int num_threads, int count, const ParallelBody& body) {
  if (num_threads < 1) throw std::invalid_argument("ParallelFor: needs at least one thread");
  if (num_threads == 1) {
    for (int i = 0; i < count; ++i) body.call(body.body, 0, i);
    return;
  }
  std::atomic<int> next = 0;
  RunWorkers(std::min(num_threads, count), [&](int worker) {
    for (int i = next++; i < count; i = next++) body.call(body.body, worker, i);
  });
}

}  // namespace sidestep::sdf
