#include "sidestep/core/atomic_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <utility>

#include "sidestep/core/input_error.h"

namespace sidestep {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kReadableByAll = 0666;  // less what the umask takes away

// Closes a descriptor at the end of its scope.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  int get() const { return number_; }
  // For the one who wants to know whether closing went well.
  int Release() { return std::exchange(number_, -1); }

 private:
  int number_;
};

// The folder of an open file's name, /proc/PID/fd, if `path` is one: what it leads to is no name.
fs::path FolderOfOpenFile(const fs::path& path) {
  std::error_code error;
  const fs::path folder = fs::canonical(path.parent_path(), error);
  return !error && folder.native().rfind("/proc/", 0) == 0 ? folder : fs::path();
}

// What a chain of symbolic links leads to, whether it exists or not.
fs::path FollowLinks(fs::path path) {
  constexpr int kMaxLinks = 40;  // as Linux
  std::error_code error;
  for (int i = 0; i < kMaxLinks && fs::is_symlink(fs::symlink_status(path, error)); ++i) {
    if (!FolderOfOpenFile(path).empty()) break;
    const fs::path next = fs::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / next;  // an absolute one stands alone
  }
  return path;
}

// A file that is written to as it is. An open file of this process is another handle of the same,
// so that what is printed afterwards follows and does not overwrite.
int OpenInPlace(const fs::path& path) {
  const std::string own = "/proc/" + std::to_string(getpid()) + "/fd";
  const std::string number = path.filename().native();
  int descriptor = -1;
  const auto parsed = std::from_chars(number.data(), number.data() + number.size(), descriptor);
  if (FolderOfOpenFile(path) == own && parsed.ec == std::errc()) return dup(descriptor);
  return open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
}

// Some file systems have nothing to bring to the disk, and say so.
bool Synchronise(int descriptor) {
  return fsync(descriptor) == 0 || errno == EINVAL || errno == ENOSYS || errno == ENOTSUP;
}

// Writes all; false with errno set if that fails.
template <typename WriteSome>
bool WriteAll(std::string_view bytes, const WriteSome& write_some) {
  while (!bytes.empty()) {
    const ssize_t written = write_some(bytes);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

void AtomicFile::Fail(int error) const {
  throw InputError(path_, std::string("cannot be written: ") + std::strerror(error));
}

AtomicFile::AtomicFile(const std::string& path) : path_(path) {
  if (path.empty()) Fail(ENOENT);
  if (path.back() == '/') Fail(EISDIR);
  const fs::path target = FollowLinks(path);
  target_ = target.native();
  struct stat status = {};
  const bool exists = stat(target_.c_str(), &status) == 0;
  if (!exists && errno != ENOENT) Fail(errno);
  if (exists && S_ISDIR(status.st_mode)) Fail(EISDIR);
  if (exists && access(target_.c_str(), W_OK) != 0) Fail(errno);
  in_place_ = exists && (!S_ISREG(status.st_mode) || !FolderOfOpenFile(target).empty());
  if (in_place_) {
    descriptor_ = memfd_create("sidestep", MFD_CLOEXEC);
    if (descriptor_ < 0) Fail(errno);
    return;
  }
  const mode_t mode = exists ? status.st_mode & 07777 : kReadableByAll;
  const std::string stem =
      (target.parent_path() / ".sidestep-").native() + std::to_string(getpid()) + "-";
  for (int n = 0; descriptor_ < 0; ++n) {
    temporary_ = stem + std::to_string(n) + ".part";
    descriptor_ = open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (descriptor_ < 0 && errno != EEXIST) Fail(errno);
  }
  if (exists) fchmod(descriptor_, mode);  // who may read the old one may read the new one
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) close(descriptor_);
  if (!temporary_.empty()) unlink(temporary_.c_str());
}

void AtomicFile::Append(std::string_view bytes) { WriteAt(size_, bytes); }

void AtomicFile::WriteAt(std::uint64_t offset, std::string_view bytes) {
  const std::uint64_t end = offset + bytes.size();
  const bool written = WriteAll(bytes, [&](std::string_view rest) {
    return pwrite(descriptor_, rest.data(), rest.size(), static_cast<off_t>(end - rest.size()));
  });
  if (!written) Fail(errno);
  size_ = std::max(size_, end);
}

std::size_t AtomicFile::ReadAt(std::uint64_t offset, char* bytes, std::size_t size) const {
  ssize_t count = -1;
  do {
    count = pread(descriptor_, bytes, size, static_cast<off_t>(offset));
  } while (count < 0 && errno == EINTR);
  if (count < 0) Fail(errno);
  return static_cast<std::size_t>(count);
}

void AtomicFile::Commit() {
  if (in_place_) return CommitInPlace();
  if (!Synchronise(descriptor_)) Fail(errno);
  if (close(std::exchange(descriptor_, -1)) != 0) Fail(errno);
  if (rename(temporary_.c_str(), target_.c_str()) != 0) Fail(errno);
  temporary_.clear();
  // The name is on the disk when the folder is. One that may not be read cannot be asked to.
  const fs::path folder = fs::path(target_).parent_path();
  const Descriptor opened(
      open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened.get() >= 0 && !Synchronise(opened.get())) Fail(errno);
}

void AtomicFile::CommitInPlace() {
  Descriptor file(OpenInPlace(target_));
  if (file.get() < 0) Fail(errno);
  std::array<char, 1 << 16> buffer;
  for (std::uint64_t at = 0; at < size_;) {
    const std::size_t count = ReadAt(at, buffer.data(), buffer.size());
    const bool written = WriteAll({buffer.data(), count}, [&](std::string_view rest) {
      return write(file.get(), rest.data(), rest.size());
    });
    if (!written) Fail(errno);
    at += count;
  }
  if (close(file.Release()) != 0) Fail(errno);
}

void WriteFile(const std::string& path, std::string_view bytes) {
  AtomicFile file(path);
  file.Append(bytes);
  file.Commit();
}

void CheckCanWrite(const std::string& path) { const AtomicFile file(path); }

}  // namespace sidestep
