#include "sidestep/record/journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <exception>
#include <iterator>
#include <utility>

#include "sidestep/core/input_error.h"
#include "sidestep/record/hdf5_image.h"
#include "sidestep/record/recording_file.h"
#include "sidestep/record/sealed_file.h"

namespace sidestep::record {
namespace {

const SealedFormat kJournalFormat = {"sidestep journal", kTraceVersion};
constexpr std::chrono::milliseconds kPart(250);
constexpr std::chrono::milliseconds kAfterAFailure(1000);

// Every list of rows of a recording, with its number.
template <typename Do>
void ForEachList(const Do& act) {
  act(&Recording::control, 0);
  act(&Recording::truth, 1);
  act(&Recording::observations, 2);
  act(&Recording::cycles, 3);
  act(&Recording::events, 4);
  act(&Recording::safety, 5);
  act(&Recording::p_WTool, 6);
}

// The recording without its rows.
Recording ProblemOf(Recording recording) {
  ForEachList([&](auto list, std::size_t) { (recording.*list).clear(); });
  return recording;
}

// ... and without its texts: what can be read only with it.
Recording BriefOf(Recording problem) {
  problem.header.clear();
  problem.scenario_yaml.clear();
  problem.model_xml.clear();
  return problem;
}

bool HasRows(const Recording& recording) {
  bool has = false;
  ForEachList([&](auto list, std::size_t) { has = has || !(recording.*list).empty(); });
  return has;
}

void AppendRows(Recording part, Recording& to) {
  ForEachList([&](auto list, std::size_t) {
    (to.*list).insert((to.*list).end(), std::make_move_iterator((part.*list).begin()),
                      std::make_move_iterator((part.*list).end()));
  });
}

template <typename Rows>
bool GoesOn(const Rows& rows, const Rows& next) {
  return rows.empty() || next.empty() || rows.back().t < next.front().t;
}

// Whether `part` can come after `whole`: together they are a recording.
bool GoesOn(const Recording& whole, const Recording& part) {
  const std::size_t num_ticks = whole.control.size() + part.control.size();
  const std::size_t num_tools = whole.p_WTool.size() + part.p_WTool.size();
  return part.joints == whole.joints && part.obstacles == whole.obstacles &&
         (num_tools == 0 || num_tools == num_ticks) && GoesOn(whole.control, part.control) &&
         GoesOn(whole.truth, part.truth) && GoesOn(whole.observations, part.observations);
}

// Whoever writes it has it locked.
void CheckIsNotBeingWritten(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return;  // whoever reads it says why
  const bool is_locked = flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(file);
  if (is_locked) throw InputError(path, "is being written just now: its run goes on");
}

}  // namespace

Journal::Journal(std::string path, std::map<std::string, std::string> facts, Complain complain)
    : path_(std::move(path)),
      facts_(std::move(facts)),
      complain_(std::move(complain)),
      thread_([this] { Run(); }) {}

Journal::~Journal() {
  End();
  if (file_ >= 0) close(file_);
}

void Journal::Keep(const Recording& recording) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!waiting_) {
    waiting_ = ProblemOf(recording);
    waiting_->header.insert(facts_.begin(), facts_.end());
    brief_ = BriefOf(*waiting_);
  }
  ForEachList([&](auto list, std::size_t i) {
    const auto& rows = recording.*list;
    auto& to = *waiting_.*list;
    to.insert(to.end(), rows.begin() + static_cast<std::ptrdiff_t>(num_kept_.at(i)), rows.end());
    num_kept_.at(i) = rows.size();
  });
}

bool Journal::Close() {
  End();
  if (file_ >= 0) close(std::exchange(file_, -1));
  return is_begun_ && !unwritten_;
}

void Journal::Remove() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_.reset();
  }
  End();
  struct stat status = {};
  if (file_ >= 0 && fstat(file_, &status) == 0 && S_ISREG(status.st_mode)) unlink(path_.c_str());
}

void Journal::End() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_ending_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Journal::Run() {
  std::unique_lock<std::mutex> lock(mutex_);
  for (bool is_last = false; !is_last;) {
    is_last =
        wake_.wait_for(lock, has_failed_ ? kAfterAFailure : kPart, [this] { return is_ending_; });
    if (!waiting_) continue;
    Recording part = std::exchange(*waiting_, brief_);
    lock.unlock();
    Write(std::move(part), is_last);
    lock.lock();
  }
}

void Journal::Write(Recording part, bool is_last) {
  if (unwritten_) {
    AppendRows(std::move(part), *unwritten_);
  } else {
    unwritten_ = std::move(part);
  }
  if (is_begun_ && !HasRows(*unwritten_)) {
    unwritten_.reset();
    return;
  }
  try {
    if (file_ < 0) Open();
    Append(SealedBytes(kJournalFormat, ToHdf5(*unwritten_)));
    unwritten_.reset();
    is_begun_ = true;
    has_failed_ = false;
  } catch (const std::exception& error) {
    // At the end, whoever goes on says what has become of the recording.
    const bool tells = std::exchange(has_failed_, true) && !is_last;
    if (tells && !std::exchange(has_complained_, true) && complain_) complain_(error.what());
  }
}

void Journal::Append(const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = write(file_, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      const int why = errno;
      // What follows must begin where the last whole part ends.
      if (ftruncate(file_, size_) == 0) lseek(file_, size_, SEEK_SET);
      errno = why;
      Fail();
    }
    done += static_cast<std::size_t>(count);
  }
  size_ += static_cast<off_t>(bytes.size());
}

void Journal::Open() {
  file_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) Fail();
  if (flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(std::exchange(file_, -1));
    throw InputError(path_, "another run is writing here just now");
  }
  struct stat status = {};
  const bool is_file = fstat(file_, &status) == 0 && S_ISREG(status.st_mode);
  if (is_file && ftruncate(file_, 0) != 0) Fail();
}

void Journal::Fail() const {
  throw InputError(path_, std::string("cannot be written: ") + std::strerror(errno));
}

JournalContents ReadJournal(const std::string& path) {
  CheckIsNotBeingWritten(path);
  const SealedRow row = ReadSealedRow(path, kJournalFormat);
  std::size_t most_bytes = Hdf5ImageReader::kMostBytes;
  JournalContents contents;
  contents.damage = row.damage;
  for (std::size_t i = 0; i < row.payloads.size(); ++i) {
    Recording part;
    try {
      part = FromHdf5(row.payloads[i], path, &most_bytes);
      if (i > 0 && !GoesOn(contents.recording, part)) {
        throw InputError(path, "does not go on as it began");
      }
    } catch (const InputError& error) {
      if (i == 0) throw;
      contents.damage = error.what();
      break;
    }
    if (i == 0) {
      contents.recording = std::move(part);
    } else {
      AppendRows(std::move(part), contents.recording);
    }
  }
  return contents;
}

}  // namespace sidestep::record
