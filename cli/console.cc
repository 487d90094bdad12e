#include "sidestep/cli/console.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "sidestep/core/input_error.h"
#include "sidestep/core/utf8.h"

namespace sidestep::cli {
namespace {

bool Write(std::string_view text, std::FILE* stream) {
  const std::string escaped = EscapeControls(text);
  return std::fwrite(escaped.data(), 1, escaped.size(), stream) == escaped.size();
}

// The stream keeps no reason of a failure, so it is told where it happens.
void CheckOutput(bool is_written) {
  if (is_written || errno == EPIPE) return;
  throw InputError("standard output", std::string("cannot be written: ") + std::strerror(errno));
}

}  // namespace

void PrintText(std::string_view text) { CheckOutput(Write(text, stdout)); }
void PrintErrorText(std::string_view text) { Write(text, stderr); }

std::string OneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

void FinishOutput() { CheckOutput(std::fflush(stdout) == 0); }

}  // namespace sidestep::cli
