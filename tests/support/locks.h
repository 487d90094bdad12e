#pragma once

namespace sidestep {

/// How many mutexes this thread has locked so far. Programs that link locks.cc count; not with the
/// sanitizers, which take the same calls for themselves.
int CountLocksOfThread();
/// Whether they do.
bool AreLocksCounted();

}  // namespace sidestep
