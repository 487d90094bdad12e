#include "sidestep/bench/process_pool.h"

#include <sys/poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <deque>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

namespace sidestep::bench {
namespace {

constexpr int kTick_ms = 500;  // `next` may have changed its mind meanwhile

// By a socket, since a pipe whose reader has ended would end this process too.
bool WriteWhole(int link, const char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t count = send(link, bytes, size, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes += count;
    size -= static_cast<std::size_t>(count);
  }
  return true;
}

bool ReadWhole(int link, char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t count = recv(link, bytes, size, 0);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes += count;
    size -= static_cast<std::size_t>(count);
  }
  return true;
}

// The life of a process of the pool.
[[noreturn]] void Serve(int link, const std::function<std::string(std::uint64_t)>& work) {
  std::uint64_t task = 0;
  while (ReadWhole(link, reinterpret_cast<char*>(&task), sizeof task)) {
    std::string text;
    try {
      text = work(task);
    } catch (...) {
      std::abort();  // is told as the end of this process
    }
    const std::uint64_t size = text.size();
    if (!WriteWhole(link, reinterpret_cast<const char*>(&size), sizeof size) ||
        !WriteWhole(link, text.data(), text.size())) {
      break;
    }
  }
  _exit(0);  // nothing of what the other process has begun is finished here
}

std::string EndOf(int status) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    return "its process was ended by signal " + std::to_string(signal) + " (" + strsignal(signal) +
           ")";
  }
  return "its process ended with exit code " + std::to_string(WEXITSTATUS(status));
}

bool WasKilled(int status) {
  return WIFSIGNALED(status) && (WTERMSIG(status) == SIGKILL || WTERMSIG(status) == SIGTERM);
}

class Pool {
 public:
  Pool(const ProcessPoolOptions& options, const std::function<std::string(std::uint64_t)>& work,
       const std::function<void()>& begin_process)
      : options_(options),
        num_jobs_(options.num_jobs),
        work_(work),
        begin_process_(begin_process) {}

  ~Pool() {
    for (Process& process : processes_) {
      kill(process.id, SIGKILL);
      Bury(process);
    }
  }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  void Run(const std::function<std::optional<std::uint64_t>()>& next,
           const std::function<void(std::uint64_t, const ProcessAnswer&)>& done) {
    for (;;) {
      while (NumAtWork() < num_jobs_) {
        const std::optional<std::uint64_t> task = NextTask(next);
        if (!task) break;
        Give(*task);
      }
      if (NumAtWork() == 0) break;
      Listen(done);
    }
    for (Process& process : processes_) shutdown(process.link, SHUT_WR);
    for (Process& process : processes_) Bury(process);
    processes_.clear();
  }

 private:
  struct Process {
    pid_t id = 0;
    int link = -1;
    int num_given = 0;
    std::optional<std::uint64_t> task;  // at work on
  };
  struct Tries {
    int kills = 0, crashes = 0;
  };

  int NumAtWork() const {
    return static_cast<int>(std::count_if(processes_.begin(), processes_.end(),
                                          [](const Process& one) { return one.task.has_value(); }));
  }

  std::optional<std::uint64_t> NextTask(const std::function<std::optional<std::uint64_t>()>& next) {
    if (again_.empty()) return next();
    const std::uint64_t task = again_.front();
    again_.pop_front();
    return task;
  }

  void Give(std::uint64_t task) {
    for (;;) {
      auto free = std::find_if(processes_.begin(), processes_.end(),
                               [](const Process& one) { return !one.task; });
      if (free == processes_.end()) {
        std::optional<Process> more = Fork();
        if (!more) {  // those that there are have to do
          again_.push_front(task);
          num_jobs_ = NumAtWork();
          return;
        }
        processes_.push_back(*more);
        free = std::prev(processes_.end());
      }
      free->task = task;
      ++free->num_given;
      if (WriteWhole(free->link, reinterpret_cast<const char*>(&task), sizeof task)) return;
      Bury(*free);  // it ended while it had nothing to do
      processes_.erase(free);
    }
  }

  // None where the system has no more to give and there are others.
  std::optional<Process> Fork() const {
    int link[2];
    std::fflush(nullptr);  // or what is held back would be written twice
    const pid_t parent = getpid();
    pid_t id = -1;
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, link) == 0) {
      id = fork();
      if (id < 0) {
        close(link[0]);
        close(link[1]);
      }
    }
    if (id < 0) {
      if (NumAtWork() > 0) return {};
      Fail();
    }
    if (id == 0) {
      // Who asks to stop asks this process's parent; it is let finish its task. With its parent it
      // ends at once.
      for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_IGN);
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (getppid() != parent) _exit(0);
      for (const Process& other : processes_) close(other.link);
      close(link[0]);
      if (begin_process_) begin_process_();
      Serve(link[1], work_);
    }
    close(link[1]);
    return Process{id, link[0], 0, {}};
  }

  // Waits for answers, or for `kTick_ms`.
  void Listen(const std::function<void(std::uint64_t, const ProcessAnswer&)>& done) {
    std::vector<pollfd> files;
    for (const Process& process : processes_) {
      files.push_back({process.link, static_cast<short>(process.task ? POLLIN : 0), 0});
    }
    if (poll(files.data(), files.size(), kTick_ms) < 0 && errno != EINTR) Fail();
    for (std::size_t i = files.size(); i-- > 0;) {
      if (!processes_[i].task || (files[i].revents & (POLLIN | POLLHUP | POLLERR)) == 0) continue;
      const std::uint64_t task = *processes_[i].task;
      std::uint64_t size = 0;
      std::string text;
      const int link = processes_[i].link;
      bool is_whole = ReadWhole(link, reinterpret_cast<char*>(&size), sizeof size);
      if (is_whole) {
        text.resize(size);
        is_whole = ReadWhole(link, text.data(), size);
      }
      processes_[i].task.reset();
      const bool retires = processes_[i].num_given >= options_.tasks_per_process;
      if (!is_whole || retires) {
        const int status = Bury(processes_[i]);
        processes_.erase(processes_.begin() + static_cast<std::ptrdiff_t>(i));
        if (!is_whole) {
          TryAgain(task, status, done);
          continue;
        }
      }
      tries_.erase(task);
      done(task, {text, "", false});
    }
  }

  void TryAgain(std::uint64_t task, int status,
                const std::function<void(std::uint64_t, const ProcessAnswer&)>& done) {
    Tries& tries = tries_[task];
    ++(WasKilled(status) ? tries.kills : tries.crashes);
    if (tries.kills <= options_.most_kills && tries.crashes <= 1) {
      again_.push_back(task);
      return;
    }
    const int count = tries.kills + tries.crashes;
    tries_.erase(task);
    done(task, {"", EndOf(status) + ", " + std::to_string(count) + " times", WasKilled(status)});
  }

  // Waits for its end. @return its status.
  static int Bury(Process& process) {
    close(std::exchange(process.link, -1));
    int status = 0;
    while (waitpid(process.id, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
  }

  [[noreturn]] static void Fail() {
    throw std::runtime_error(std::string("no further process can be started: ") +
                             std::strerror(errno));
  }

  const ProcessPoolOptions& options_;
  int num_jobs_;
  const std::function<std::string(std::uint64_t)>& work_;
  const std::function<void()>& begin_process_;
  std::vector<Process> processes_;
  std::deque<std::uint64_t> again_;
  std::map<std::uint64_t, Tries> tries_;
};

}  // namespace

void RunInProcesses(const ProcessPoolOptions& options,
                    const std::function<std::optional<std::uint64_t>()>& next,
                    const std::function<std::string(std::uint64_t)>& work,
                    const std::function<void(std::uint64_t, const ProcessAnswer&)>& done,
                    const std::function<void()>& begin_process) {
  Pool(options, work, begin_process).Run(next, done);
}

}  // namespace sidestep::bench
