#pragma once

#include <sys/types.h>

#include <array>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "sidestep/record/recording.h"

namespace sidestep::record {

/// Keeps a recording on the disk while it grows, so that whatever becomes of the process (killed,
/// out of memory), what was recorded up to half a second before can be read.
///
/// The file is a row of parts, one a quarter of a second. Each is a recording of what came since
/// the part before, as in a trace, and sealed (sealed_file.h): what was being written at the end
/// is found out and left out. A thread of its own writes; who records waits for no disk.
class Journal {
 public:
  /// Is told once, from another thread, if the file cannot be written a second after that was tried
  /// first. It is tried again and again.
  using Complain = std::function<void(const std::string&)>;

  /// Nothing is touched until there is something to keep; then a file of this name is replaced.
  /// @param facts for the header, beside those that the recording has when it is first kept.
  Journal(std::string path, std::map<std::string, std::string> facts, Complain complain);
  /// Writes the rest, if it was neither closed nor removed.
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// What was added to `recording` since the last call. It must be the same one each time; nothing
  /// but its lists of rows may change.
  void Keep(const Recording& recording);

  /// Writes the rest; nothing is kept after that. @return whether all that was kept is there.
  bool Close();

  /// The recording is safe elsewhere: the file goes, and nothing is kept after that.
  void Remove();

 private:
  static constexpr std::size_t kLists = 7;  // of rows, in a recording

  void Run();
  void Write(Recording part, bool is_last);
  void Append(const std::string& bytes);
  void Open();
  void End();
  [[noreturn]] void Fail() const;  // with the reason that errno tells

  const std::string path_;
  const std::map<std::string, std::string> facts_;
  const Complain complain_;

  std::array<std::size_t, kLists> num_kept_ = {};  // rows
  Recording brief_;                                // what each part but the first begins with

  std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<Recording> waiting_;  // for the thread; none before anything is kept
  bool is_ending_ = false;

  // Of the thread.
  std::optional<Recording> unwritten_;
  bool has_failed_ = false, has_complained_ = false, is_begun_ = false;
  int file_ = -1;
  off_t size_ = 0;  // of the whole parts in it

  std::thread thread_;  // last: it uses all of the above
};

/// What a journal holds.
struct JournalContents {
  Recording recording;  ///< without metrics
  std::string damage;   ///< why the end of the file was left out; empty if nothing was
};

/// @throws InputError, naming the file and what is wrong, if it is missing, no journal of this
/// version, without a whole first part, or being written just now.
JournalContents ReadJournal(const std::string& path);

}  // namespace sidestep::record
