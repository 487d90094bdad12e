#include "tests/support/subprocess.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <thread>

#include "tests/support/bytes_of.h"

namespace sidestep {
namespace {}  // namespace

Running::Running(const std::vector<std::string>& command,
                 const std::vector<std::string>& environment, const std::string& working_directory,
                 int input)
    : folder_(std::make_unique<TemporaryFolder>()), name_(command.at(0)) {
  // Files, not pipes: a pipe that nobody empties stops the program.
  const std::string out = folder_->path() / "out", err = folder_->path() / "err";
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
  dup2(input >= 0 ? input : open("/dev/null", O_RDONLY), STDIN_FILENO);
  dup2(out_file, STDOUT_FILENO);
  dup2(err_file, STDERR_FILENO);
  if (moved) execvp(arguments[0], arguments.data());
  _exit(127);
}

Running::~Running() {
  if (HasEnded()) return;
  Signal(SIGKILL);
  Finish();
}

void Running::Signal(int signal) const { kill(child_, signal); }

bool Running::HasEnded() {
  int status = 0;
  if (!status_ && waitpid(child_, &status, WNOHANG) == child_) status_ = status;
  return status_.has_value();
}

std::string Running::out() const { return BytesOf(folder_->path() / "out"); }

bool Running::Prints(const std::string& text) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (std::chrono::steady_clock::now() < until) {
    const bool has_ended = HasEnded();
    if (out().find(text) != std::string::npos) return true;
    if (has_ended) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return false;
}

Finished Running::Finish() {
  int status = 0;
  if (!status_ && waitpid(child_, &status, 0) == child_) status_ = status;
  Finished finished;
  finished.exit_code = WIFEXITED(*status_) ? WEXITSTATUS(*status_) : -1;
  finished.signal = WIFSIGNALED(*status_) ? WTERMSIG(*status_) : 0;
  finished.out = out();
  finished.err = BytesOf(folder_->path() / "err");
  if (finished.exit_code == 127) throw std::runtime_error("cannot run " + name_);
  return finished;
}

Finished RunProgram(const std::vector<std::string>& command,
                    const std::vector<std::string>& environment,
                    const std::string& working_directory) {
  return Running(command, environment, working_directory).Finish();
}

}  // namespace sidestep
