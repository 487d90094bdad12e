#pragma once

#include <string>
#include <vector>

#include "sidestep/hardware/camera_file.h"
#include "sidestep/robot/frame_source.h"

namespace sidestep::hardware {

/// A folder of recorded frames of one camera: camera.yaml with its serial and lens (camera_file.h),
/// frames.csv (number, t_s, file) in the order of capture, and the pictures, grey PGM files (P5)
/// that any viewer shows.
///
/// Plays them back, each so long after its time of capture. A picture is read when it is due.
class RecordedFrames final : public robot::FrameSource {
 public:
  /// @throws InputError `FILE:LINE: ...` for a folder that is not such a one.
  explicit RecordedFrames(const std::string& folder, HorizonOffset latency = HorizonOffset(0));

  const NamedCamera& camera() const { return camera_; }
  std::size_t size() const { return entries_.size(); }
  EpisodeTime end() const { return EpisodeTime(entries_.back().t_s); }  ///< capture of the last one

  /// After the last one: never.
  EpisodeTime NextDue() const override;
  /// @throws InputError for a picture that is missing, no PGM, or of another size.
  std::optional<robot::Frame> Read(EpisodeTime now) override;

  /// One of them, whatever the time.
  robot::Frame At(std::size_t index) const;

 private:
  struct Entry {
    std::int64_t number;
    double t_s;
    std::string file;
  };

  std::string folder_;
  HorizonOffset latency_;
  NamedCamera camera_;
  std::vector<Entry> entries_;
  std::size_t next_ = 0;
};

/// Writes such a folder.
class FrameRecorder {
 public:
  /// @param folder must exist. @throws InputError if it takes no files.
  explicit FrameRecorder(const std::string& folder);

  /// Frames of one camera, in the order of capture. @throws InputError if it cannot be written;
  /// std::invalid_argument for a frame of another camera, or an earlier one.
  void Add(const robot::Frame& frame);

  /// Writes what makes a recording of the pictures. Call once, last.
  void Finish();

 private:
  std::string folder_;
  std::vector<std::pair<std::int64_t, double>> written_;  // number, t_s
  NamedCamera camera_;
};

}  // namespace sidestep::hardware
