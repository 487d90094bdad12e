#include "tests/support/subprocess.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace sidestep {
namespace {

std::string Slurp(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace

// Files, not pipes: a pipe that nobody empties stops the program.
RunningProgram::RunningProgram(const std::vector<std::string>& command,
                               const std::vector<std::string>& environment,
                               const std::string& working_directory)
    : name_(command.at(0)) {
  const std::string out = folder_.path() / "out", err = folder_.path() / "err";
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);

  child_ = fork();
  if (child_ < 0) throw std::runtime_error("cannot fork");
  if (child_ > 0) return;
  for (const std::string& assignment : environment) putenv(const_cast<char*>(assignment.c_str()));
  const bool moved = working_directory.empty() || chdir(working_directory.c_str()) == 0;
  const int out_file = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  const int err_file = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  const int no_input = open("/dev/null", O_RDONLY);
  dup2(no_input, STDIN_FILENO);
  dup2(out_file, STDOUT_FILENO);
  dup2(err_file, STDERR_FILENO);
  if (moved) execvp(arguments[0], arguments.data());
  _exit(127);
}

RunningProgram::~RunningProgram() {
  if (child_ < 0) return;
  kill(child_, SIGKILL);
  waitpid(child_, nullptr, 0);
}

void RunningProgram::Signal(int number) const {
  if (child_ >= 0) kill(child_, number);
}

std::string RunningProgram::OutSoFar() const { return Slurp(folder_.path() / "out"); }

Finished RunningProgram::Wait() {
  int status = 0;
  waitpid(std::exchange(child_, -1), &status, 0);
  Finished finished;
  finished.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  finished.out = Slurp(folder_.path() / "out");
  finished.err = Slurp(folder_.path() / "err");
  if (finished.exit_code == 127) throw std::runtime_error("cannot run " + name_);
  return finished;
}

Finished RunProgram(const std::vector<std::string>& command,
                    const std::vector<std::string>& environment,
                    const std::string& working_directory) {
  return RunningProgram(command, environment, working_directory).Wait();
}

}  // namespace sidestep
