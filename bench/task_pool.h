#pragma once

#include <functional>

namespace sidestep::bench {

/// Calls task(0) ... task(count - 1), each once, in `num_jobs` >= 1 threads; returns when all are
/// done. Tasks must not depend on each other's order, and so the result does not depend on
/// `num_jobs`. The first exception of a task is thrown here; tasks not begun by then are left out.
///
/// The one pool of whole jobs: the episodes of a study, the rows of an experiment. The pieces of a
/// single field are sdf/parallel_for's.
void RunTasks(int count, int num_jobs, const std::function<void(int)>& task);

/// How many threads this machine runs at a time; at least 1.
int NumProcessors();

}  // namespace sidestep::bench
