#include "sidestep/cli/stop_signals.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstring>

namespace sidestep::cli {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};
constexpr int kPatience = 2;

// A handler knows nothing but what is global.
std::atomic<int> received{0}, first_signal{0};
static_assert(std::atomic<int>::is_always_lock_free);

void Count(int signal) {
  int none = 0;
  first_signal.compare_exchange_strong(none, signal);
  if (received.fetch_add(1) < kPatience) return;
  // Nothing but write may be called here.
  static const char kLeft[] =
      "sidestep: left at the third signal; a robot that moves stops by itself, without us\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kLeft, sizeof(kLeft) - 1);
  _exit(128 + signal);
}

void Handle(void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  for (const int signal : kSignals) {
    struct sigaction before = {};
    sigaction(signal, nullptr, &before);
    // Of nohup: who is to outlive a terminal does.
    if (signal == SIGHUP && before.sa_handler == SIG_IGN) continue;
    sigaction(signal, &action, nullptr);
  }
}

}  // namespace

StopSignals::StopSignals() {
  received = first_signal = 0;
  Handle(&Count);
}

StopSignals::~StopSignals() { Handle(SIG_DFL); }

int StopSignals::count() const { return received; }

std::string StopSignals::first() const {
  switch (first_signal) {
    case 0:
      return "";
    case SIGINT:
      return "Ctrl-C";
    case SIGTERM:
      return "SIGTERM";
    default:
      return "SIGHUP";
  }
}

}  // namespace sidestep::cli
