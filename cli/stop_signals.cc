#include "sidestep/cli/stop_signals.h"

#include <unistd.h>

#include <atomic>
#include <csignal>

namespace sidestep::cli {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM};
constexpr int kPatience = 2;

// A handler knows nothing but what is global.
std::atomic<int> received{0};
static_assert(std::atomic<int>::is_always_lock_free);

void Count(int signal) {
  if (received.fetch_add(1) >= kPatience) _exit(128 + signal);
}

void Handle(void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  for (const int signal : kSignals) sigaction(signal, &action, nullptr);
}

}  // namespace

StopSignals::StopSignals() {
  received = 0;
  Handle(&Count);
}

StopSignals::~StopSignals() { Handle(SIG_DFL); }

int StopSignals::count() const { return received; }

}  // namespace sidestep::cli
