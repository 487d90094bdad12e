#pragma once

#include <string>

#include "sidestep/core/csv.h"
#include "sidestep/hardware/recorded_frames.h"
#include "sidestep/hardware/tag_sensor.h"

namespace sidestep::hardware {

/// What was found in each picture, as a table: number (of the frame), what (`tag` or `body`), name,
/// and values: of a tag its hamming distance, margin and corners [px]; of a body X_WO (position,
/// then w, x, y, z) and the upper half of its covariance. A number has the digits that give it
/// back, so equal tables are equal bits.
class LookTable {
 public:
  void Add(const Look& look);
  const std::string& text() const { return table_.text(); }

 private:
  CsvWriter table_{{"number", "what", "name", "values"}};
};

/// Keeps what a camera sees and what is found in it, for hardware/recorded_frames.h and for a look
/// at the same pictures again: a folder of frames, and seen.csv, a LookTable.
class LookLog {
 public:
  static constexpr const char* kTableFile = "seen.csv";

  /// @param folder must exist. @throws InputError if it takes no files.
  explicit LookLog(const std::string& folder);

  /// @throws InputError if it cannot be written.
  void Add(const Look& look);
  /// Call once, last. Of a log without frames nothing is left.
  void Finish();

  int num_frames() const { return num_frames_; }

 private:
  std::string folder_;
  FrameRecorder frames_;
  LookTable table_;
  int num_frames_ = 0;
};

}  // namespace sidestep::hardware
