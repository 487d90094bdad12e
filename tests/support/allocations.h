#pragma once

#include <cstddef>

namespace sidestep {

/// What this program has taken by operator new so far. Programs that link allocations.cc count.
struct Allocations {
  int count = 0;
  std::size_t bytes = 0;
};
Allocations CountAllocations();
/// How often this thread has.
int CountAllocationsOfThread();

}  // namespace sidestep
