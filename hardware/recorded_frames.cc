#include "sidestep/hardware/recorded_frames.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "sidestep/core/atomic_file.h"
#include "sidestep/core/csv.h"
#include "sidestep/core/input_error.h"

namespace sidestep::hardware {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCameraFile = "camera.yaml";
constexpr const char* kListFile = "frames.csv";

std::string PathIn(const std::string& folder, const std::string& file) {
  return (fs::path(folder) / file).string();
}

std::string PictureName(std::int64_t number) {
  const std::string digits = std::to_string(number);
  return std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits + ".pgm";
}

std::string Header(const robot::CameraIntrinsics& camera) {
  return "P5\n" + std::to_string(camera.width) + " " + std::to_string(camera.height) + "\n255\n";
}

// Exactly what FrameRecorder writes; comments and other depths are not for this.
robot::GreyImage ReadPicture(const std::string& path, const robot::CameraIntrinsics& camera) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) throw InputError(path, "there is no such file");
  const std::string header = Header(camera);
  robot::GreyImage image{camera.width, camera.height, {}};
  const std::size_t count =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  std::ifstream stream(path, std::ios::binary);
  std::string begin(header.size(), '\0');
  image.pixels.resize(count);
  stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  stream.read(reinterpret_cast<char*>(image.pixels.data()), static_cast<std::streamsize>(count));
  if (!stream || begin != header || stream.peek() != std::ifstream::traits_type::eof()) {
    throw InputError(path, "must be a PGM file (P5, 255) of " + std::to_string(camera.width) +
                               " x " + std::to_string(camera.height) + " pixels");
  }
  return image;
}

}  // namespace

RecordedFrames::RecordedFrames(const std::string& folder, HorizonOffset latency)
    : folder_(folder), latency_(latency) {
  const YamlReader top = YamlReader::FromFile(PathIn(folder, kCameraFile));
  camera_ = ReadCamera(top.GetMap("camera"));
  top.CheckNoUnknownKeys();
  const std::string list = PathIn(folder, kListFile);
  const CsvFile file = ReadCsv(list);
  if (file.columns != std::vector<std::string>{"number", "t_s", "file"}) {
    throw InputError(list, 1, "header", "must be number,t_s,file");
  }
  for (const CsvRow& row : file.rows) {
    const double number = ParseCsvNumber(row.fields[0], list, row.line, "number");
    const double t_s = ParseCsvNumber(row.fields[1], list, row.line, "t_s");
    if (number != std::floor(number) || number < 0 || number > 1e15) {
      throw InputError(list, row.line, "number", "must be a whole number >= 0");
    }
    if (t_s < 0 || (!entries_.empty() && t_s <= entries_.back().t_s)) {
      throw InputError(list, row.line, "t_s", "must be >= 0 and after the one before");
    }
    if (fs::path(row.fields[2]).filename() != row.fields[2] || row.fields[2].empty()) {
      throw InputError(list, row.line, "file", "must be the name of a file in this folder");
    }
    entries_.push_back({static_cast<std::int64_t>(number), t_s, row.fields[2]});
  }
  if (entries_.empty()) throw InputError(list, "holds no frames");
}

EpisodeTime RecordedFrames::NextDue() const {
  if (next_ == entries_.size()) return EpisodeTime(std::numeric_limits<double>::infinity());
  return EpisodeTime(entries_[next_].t_s) + latency_;
}

std::optional<robot::Frame> RecordedFrames::Read(EpisodeTime now) {
  if (next_ == entries_.size() || now < NextDue()) return std::nullopt;
  return At(next_++);
}

robot::Frame RecordedFrames::At(std::size_t index) const {
  const Entry& entry = entries_.at(index);
  robot::Frame frame;
  frame.t = EpisodeTime(entry.t_s);
  frame.number = entry.number;
  frame.serial = camera_.serial;
  frame.camera = camera_.intrinsics;
  frame.image = ReadPicture(PathIn(folder_, entry.file), camera_.intrinsics);
  return frame;
}

FrameRecorder::FrameRecorder(const std::string& folder) : folder_(folder) {
  CheckCanWrite(PathIn(folder, kListFile));
}

void FrameRecorder::Add(const robot::Frame& frame) {
  if (written_.empty()) camera_ = {frame.serial, frame.camera};
  if (camera_.serial != frame.serial || camera_.intrinsics != frame.camera) {
    throw std::invalid_argument("FrameRecorder: a frame of another camera");
  }
  if (!written_.empty() && frame.t.seconds() <= written_.back().second) {
    throw std::invalid_argument("FrameRecorder: frames must come in the order of capture");
  }
  const auto* const pixels = reinterpret_cast<const char*>(frame.image.pixels.data());
  WriteFile(PathIn(folder_, PictureName(frame.number)),
            Header(frame.camera) + std::string(pixels, frame.image.pixels.size()));
  written_.emplace_back(frame.number, frame.t.seconds());
}

void FrameRecorder::Finish() {
  CsvWriter list({"number", "t_s", "file"});
  for (const auto& [number, t_s] : written_) {
    list.AddRow({std::to_string(number), CsvNumber(t_s), PictureName(number)});
  }
  WriteFile(PathIn(folder_, kCameraFile), "camera: " + ToYaml(camera_) + "\n");
  WriteFile(PathIn(folder_, kListFile), list.text());
}

}  // namespace sidestep::hardware
