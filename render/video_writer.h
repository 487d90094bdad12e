#pragma once

#include <memory>
#include <string>

#include "sidestep/render/image.h"

namespace sidestep::render {

/// Writes an MP4 file: H.264, yuv420p (BT.709), the index in front so that it plays while it loads.
/// Equal frames give equal bytes. The file appears under its name when Finish() succeeds.
class VideoWriter {
 public:
  /// @throws InputError for an odd or non-positive size, a rate that is not 1 to 240 frames a
  ///   second, a name that CheckVideoName refuses or cannot be written, or a libavcodec without
  ///   libx264. The name is that of a file, whatever it looks like: no URL, no protocol.
  VideoWriter(const std::string& path, int width, int height, int frames_per_second);
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// Appends one frame. @throws InputError if the file cannot take it; std::invalid_argument for
  /// another size.
  void Add(const Image& image);

  /// @throws InputError if the file cannot be completed.
  void Finish();

 private:
  struct Encoder;
  std::unique_ptr<Encoder> encoder_;
};

/// The H.264 encoder and its library, e.g. "libx264, libavcodec 59.37.100"; empty if there is none.
std::string VideoEncoder();

/// Whether a file's name promises what it will hold: it must end in .mp4, or .png.
/// @throws InputError if it does not.
void CheckVideoName(const std::string& path);
void CheckPngName(const std::string& path);

/// Writes one image as PNG. @throws InputError if its name is not a PNG's or it cannot be written.
void WritePng(const Image& image, const std::string& path);

}  // namespace sidestep::render
