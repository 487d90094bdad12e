#include "sidestep/robot/fci/frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "sidestep/robot/fci/socket.h"

namespace sidestep::robot::fci {
namespace {

constexpr int kMostPixels = 8192;  // along an edge
constexpr std::size_t kSerialSize = 32;

#pragma pack(push, 1)
struct FrameHeader {
  double next_due_s = 0;
  std::uint8_t has_frame = 0;
  // Of the frame; its pixels follow, row by row.
  double t_s = 0;
  std::int64_t number = 0;
  std::array<char, kSerialSize> serial = {};  // zeros behind it
  std::int32_t width = 0, height = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;
  std::array<double, 5> distortion = {};
};
#pragma pack(pop)

std::size_t NumPixels(const FrameHeader& header) {
  return static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.height);
}

// As far as the other end could be another program.
void Check(const FrameHeader& header) {
  const auto is_edge = [](std::int32_t pixels) { return 1 <= pixels && pixels <= kMostPixels; };
  const bool is_ours =
      !std::isnan(header.next_due_s) &&
      (header.has_frame == 0 || (header.has_frame == 1 && std::isfinite(header.t_s) &&
                                 is_edge(header.width) && is_edge(header.height)));
  if (!is_ours) throw LinkError("the peer does not show frames");
}

}  // namespace

Bytes Encode(const FrameReply& reply) {
  FrameHeader header;
  header.next_due_s = reply.next_due.seconds();
  if (!reply.frame) return ToBytes(header);
  const Frame& frame = *reply.frame;
  header.has_frame = 1;
  header.t_s = frame.t.seconds();
  header.number = frame.number;
  std::copy_n(frame.serial.begin(), std::min(frame.serial.size(), kSerialSize),
              header.serial.begin());
  header.width = frame.camera.width;
  header.height = frame.camera.height;
  header.fx = frame.camera.fx;
  header.fy = frame.camera.fy;
  header.cx = frame.camera.cx;
  header.cy = frame.camera.cy;
  header.distortion = frame.camera.distortion;
  Bytes bytes(sizeof(FrameHeader) + frame.image.pixels.size());
  std::memcpy(bytes.data(), &header, sizeof(FrameHeader));
  std::copy(frame.image.pixels.begin(), frame.image.pixels.end(),
            bytes.begin() + static_cast<std::ptrdiff_t>(sizeof(FrameHeader)));
  return bytes;
}

std::optional<FrameReply> TakeFrameReply(Bytes* received) {
  constexpr auto kHeaderSize = static_cast<std::ptrdiff_t>(sizeof(FrameHeader));
  if (received->size() < sizeof(FrameHeader)) return std::nullopt;
  const auto begin = received->begin();
  const auto header = FromBytes<FrameHeader>(Bytes(begin, begin + kHeaderSize));
  Check(header);
  const std::size_t num_pixels = header.has_frame == 1 ? NumPixels(header) : 0;
  if (received->size() < sizeof(FrameHeader) + num_pixels) return std::nullopt;
  FrameReply reply = {EpisodeTime(header.next_due_s), std::nullopt};
  const auto end = begin + kHeaderSize + static_cast<std::ptrdiff_t>(num_pixels);
  if (header.has_frame == 1) {
    Frame& frame = reply.frame.emplace();
    frame.t = EpisodeTime(header.t_s);
    frame.number = header.number;
    frame.serial.assign(header.serial.begin(),
                        std::find(header.serial.begin(), header.serial.end(), '\0'));
    frame.camera = {header.width, header.height, header.fx,        header.fy,
                    header.cx,    header.cy,     header.distortion};
    frame.image = {header.width, header.height, {begin + kHeaderSize, end}};
  }
  received->erase(begin, end);
  return reply;
}

}  // namespace sidestep::robot::fci
