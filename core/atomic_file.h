#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace sidestep {

/// A file that appears under its name whole or not at all; every file of results is written so. It
/// grows under a name of its own in the same folder, `.sidestep-...part`, and takes its name when
/// it is committed and on the disk. Whoever reads the name sees the old file or the new one.
///
/// The name may hold any bytes. A symbolic link stays; what it leads to is replaced. What is not a
/// regular file (/dev/stdout, /dev/null, a pipe) is not replaced: it gets the bytes at the end.
/// Every method throws InputError `PATH: cannot be written: WHY`.
class AtomicFile {
 public:
  /// Finds out at once whether there can be a file of this name: the folder is there and takes
  /// files, the name is not a folder's, and a file that has it may be overwritten.
  explicit AtomicFile(const std::string& path);
  /// Without Commit(), nothing remains and the old file is as it was.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void Append(std::string_view bytes);
  /// Overwrites from `offset` on, and grows as needed.
  void WriteAt(std::uint64_t offset, std::string_view bytes);
  /// What has been written from `offset` on, at most `size` bytes.
  /// @return how many there were.
  std::size_t ReadAt(std::uint64_t offset, char* bytes, std::size_t size) const;
  std::uint64_t size() const { return size_; }

  /// Call once, last.
  void Commit();

 private:
  [[noreturn]] void Fail(int error) const;
  void CommitInPlace();

  std::string path_;       // as it was asked for, for messages
  std::string target_;     // what it leads to
  std::string temporary_;  // empty if there is none to remove
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  bool in_place_ = false;
};

/// The whole of a file at once.
void WriteFile(const std::string& path, std::string_view bytes);

/// Throws as WriteFile would, as far as that can be told beforehand, and leaves nothing: for before
/// the work whose result is to be written.
void CheckCanWrite(const std::string& path);

}  // namespace sidestep
