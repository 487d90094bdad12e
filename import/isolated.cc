#include "sidestep/import/isolated.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <exception>
#include <new>

namespace sidestep::imports {
namespace {

constexpr rlim_t kMostCpu_s = 60, kMostBytes = rlim_t{8} << 30;
constexpr char kDone = 'd', kFailed = 'f';  // the first byte that the child says

void Limit(decltype(RLIMIT_CPU) what, rlim_t most) {
  const rlimit limit = {most, most};
  setrlimit(what, &limit);
}

bool WriteAll(int pipe_end, const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t more = write(pipe_end, bytes.data() + done, bytes.size() - done);
    if (more < 0 && errno == EINTR) continue;
    if (more <= 0) return false;
    done += static_cast<std::size_t>(more);
  }
  return true;
}

[[noreturn]] void BeChild(int pipe_end, const std::function<std::string()>& work) {
  Limit(RLIMIT_CORE, 0);
  Limit(RLIMIT_CPU, kMostCpu_s);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  Limit(RLIMIT_AS, kMostBytes);  // sanitizers reserve more than there is
#endif
  const int nowhere = open("/dev/null", O_WRONLY);  // for what the library would say by itself
  if (nowhere >= 0) {
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
  }
  std::string answer;
  try {
    answer = kDone + work();
  } catch (const std::bad_alloc&) {
    answer = kFailed + std::string("needs more than 8 GiB of memory");
  } catch (const std::exception& error) {
    answer = kFailed + std::string(error.what());
  }
  _exit(WriteAll(pipe_end, answer) ? 0 : 1);  // nothing of the parent's is torn down
}

std::string ReadAll(int pipe_end) {
  std::string bytes;
  std::array<char, 1 << 16> part;
  while (true) {
    const ssize_t size = read(pipe_end, part.data(), part.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return bytes;
    bytes.append(part.data(), static_cast<std::size_t>(size));
  }
}

}  // namespace

std::string RunIsolated(const std::function<std::string()>& work) {
  int ends[2] = {-1, -1};
  if (pipe(ends) != 0) throw std::runtime_error("no pipe can be made");
  const pid_t child = fork();
  if (child < 0) {
    close(ends[0]);
    close(ends[1]);
    throw std::runtime_error("no process can be started");
  }
  if (child == 0) {
    close(ends[0]);
    BeChild(ends[1], work);
  }
  close(ends[1]);
  const std::string answer = ReadAll(ends[0]);
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && !answer.empty()) {
    if (answer[0] == kDone) return answer.substr(1);
    throw std::runtime_error(answer.substr(1));
  }
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL)) {
    throw std::runtime_error("takes more than a minute, or all memory, to read");
  }
  throw std::runtime_error("is so damaged that reading it crashes");
}

InputError AsInputError(const std::string& path, const std::runtime_error& error) {
  const std::string text = error.what();
  const std::size_t behind =
      text.starts_with(path) ? text.find(": ", path.size()) : std::string::npos;
  if (behind == std::string::npos) return InputError(path, text);
  return InputError(text.substr(0, behind), text.substr(behind + 2));
}

}  // namespace sidestep::imports
