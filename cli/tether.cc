#include "sidestep/cli/tether.h"

#include <sys/poll.h>
#include <unistd.h>

namespace sidestep::cli {
namespace {

bool IsForeground() { return tcgetpgrp(STDIN_FILENO) == getpgrp(); }

// Whether whoever writes to it has gone. A file and /dev/null never hang up; an end of input that
// is typed shows only by reading, which a program in the background must not.
bool HasInputEnded() {
  pollfd input{STDIN_FILENO, POLLIN | POLLRDHUP, 0};
  if (poll(&input, 1, 0) < 0) return false;
  if ((input.revents & (POLLHUP | POLLRDHUP | POLLERR | POLLNVAL)) != 0) return true;
  if ((input.revents & POLLIN) == 0 || isatty(STDIN_FILENO) == 0 || !IsForeground()) return false;
  char typed[256];
  return read(STDIN_FILENO, typed, sizeof(typed)) == 0;
}

}  // namespace

Tether::Tether() : parent_(getppid()), has_input_(!HasInputEnded()) {}

std::string Tether::WhatIsGone() const {
  if (getppid() != parent_) return "the program that started it has ended";
  if (has_input_ && HasInputEnded()) return "its standard input has ended";
  return "";
}

}  // namespace sidestep::cli
