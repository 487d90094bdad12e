#include "sidestep/bench/task_pool.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace sidestep::bench {

void RunTasks(int count, int num_jobs, const std::function<void(int)>& task) {
  std::atomic<int> next = 0;
  std::mutex mutex;
  std::exception_ptr error;
  const auto work = [&] {
    for (int i = next++; i < count; i = next++) {
      try {
        task(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!error) error = std::current_exception();
        next = count;
      }
    }
  };
  std::vector<std::thread> others;
  try {
    for (int j = 1; j < std::min(num_jobs, count); ++j) others.emplace_back(work);
  } catch (const std::system_error&) {
    // The system has no more threads to give: those that there are do it all.
  }
  work();
  for (std::thread& thread : others) thread.join();
  if (error) std::rethrow_exception(error);
}

int NumProcessors() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

}  // namespace sidestep::bench
