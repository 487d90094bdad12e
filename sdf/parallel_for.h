#pragma once

namespace sidestep::sdf {

/// A call of body(worker, index) without its type.
struct ParallelBody {
  const void* body = nullptr;
  void (*call)(const void* body, int worker, int index) = nullptr;
};

/// ParallelFor below, compiled once.
void RunParallelFor(int num_threads, int count, const ParallelBody& body);

/// Calls body(worker, index) once for each index in [0, count), on up to `num_threads` threads, and
/// returns when all calls have.
///
/// No two calls with the same worker, 0 <= worker < num_threads, overlap: a worker may have memory
/// of its own. Which worker gets which index differs from run to run, so what a call computes may
/// only depend on its index. With one thread it is a plain loop, and nothing is allocated.
///
/// It is for the many short pieces of one field computation, whose threads are kept from call to
/// call. Whole jobs, which may throw, run in bench/task_pool.
///
/// @param body must not throw.
/// @throws std::invalid_argument if num_threads < 1.
template <class Body>
void ParallelFor(int num_threads, int count, const Body& body) {
  RunParallelFor(num_threads, count, {&body, [](const void* erased, int worker, int index) {
                                        (*static_cast<const Body*>(erased))(worker, index);
                                      }});
}

}  // namespace sidestep::sdf
