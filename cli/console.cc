#include "sidestep/cli/console.h"

#include <sys/poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "sidestep/core/input_error.h"
#include "sidestep/core/utf8.h"

namespace sidestep::cli {
namespace {

void Write(std::string_view text, std::FILE* stream) {
  const std::string escaped = EscapeInvalidUtf8(text);
  std::fwrite(escaped.data(), 1, escaped.size(), stream);
}

bool ReaderIsGone() {
  pollfd output = {STDOUT_FILENO, 0, 0};
  return poll(&output, 1, 0) > 0 && (output.revents & POLLERR) != 0;
}

}  // namespace

void PrintText(std::string_view text) { Write(text, stdout); }
void PrintErrorText(std::string_view text) { Write(text, stderr); }

void FinishOutput() {
  errno = 0;
  const bool flushed = std::fflush(stdout) == 0;
  const int error = errno;
  if (flushed && std::ferror(stdout) == 0) return;
  if (error == EPIPE || (flushed && ReaderIsGone())) return;
  // An earlier failure left its mark on the stream, but not its reason.
  throw InputError("standard output",
                   flushed ? "could not take everything"
                           : std::string("cannot be written: ") + std::strerror(error));
}

}  // namespace sidestep::cli
