#include "sidestep/bench/report/gnuplot.h"

#include <array>
#include <cstdio>
#include <filesystem>

#include "sidestep/core/atomic_file.h"

namespace sidestep::bench {
namespace {

// Runs a shell command; returns what it printed, or nothing at all if it failed.
std::string Capture(const std::string& command, bool& succeeded) {
  succeeded = false;
  std::FILE* const pipe = popen((command + " 2> /dev/null").c_str(), "r");
  if (pipe == nullptr) return "";
  std::string text;
  std::array<char, 256> buffer{};
  while (const std::size_t length = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    text.append(buffer.data(), length);
  }
  succeeded = pclose(pipe) == 0;
  return text;
}

// A word that the shell takes as it is.
std::string ShellWord(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? "'\\''" : std::string(1, c);
  return word + "'";
}

}  // namespace

std::string GnuplotVersion() {
  bool succeeded = false;
  const std::string text = Capture("gnuplot --version", succeeded);
  return succeeded ? text.substr(0, text.find('\n')) : "";
}

bool DrawFigure(const Figure& figure, const std::string& stem) {
  const std::filesystem::path script = std::filesystem::absolute(stem + ".gp");
  WriteFile(script.string(), ToGnuplot(figure, stem));
  bool succeeded = false;
  Capture("cd " + ShellWord(script.parent_path().string()) + " && gnuplot " +
              ShellWord(script.filename().string()),
          succeeded);
  return succeeded;
}

}  // namespace sidestep::bench
