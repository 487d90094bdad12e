#include "tests/support/locks.h"

#include <dlfcn.h>
#include <pthread.h>

#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)

namespace sidestep {
int CountLocksOfThread() { return 0; }
bool AreLocksCounted() { return false; }
}  // namespace sidestep

#else

namespace {
thread_local int locks = 0;

using Lock = int (*)(pthread_mutex_t*);
Lock Original(const char* name) {
  return reinterpret_cast<Lock>(dlsym(RTLD_NEXT, name));  // NOLINT: what dlsym is for
}
}  // namespace

extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) {
  static const Lock original = Original("pthread_mutex_lock");
  ++locks;
  return original(mutex);
}
extern "C" int pthread_mutex_trylock(pthread_mutex_t* mutex) {
  static const Lock original = Original("pthread_mutex_trylock");
  ++locks;
  return original(mutex);
}

namespace sidestep {
int CountLocksOfThread() { return locks; }
bool AreLocksCounted() { return true; }
}  // namespace sidestep

#endif
