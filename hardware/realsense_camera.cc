#include "sidestep/hardware/realsense_camera.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <librealsense2/rs.hpp>

#include "sidestep/core/input_error.h"
#include "sidestep/robot/robot_error.h"

namespace sidestep::hardware {
namespace {

robot::CameraIntrinsics IntrinsicsOf(const rs2_intrinsics& lens) {
  robot::CameraIntrinsics camera{.width = lens.width,
                                 .height = lens.height,
                                 .fx = static_cast<double>(lens.fx),
                                 .fy = static_cast<double>(lens.fy),
                                 .cx = static_cast<double>(lens.ppx),
                                 .cy = static_cast<double>(lens.ppy)};
  const bool is_straight =
      std::all_of(std::begin(lens.coeffs), std::end(lens.coeffs), [](float k) { return k == 0; });
  if (is_straight || lens.model == RS2_DISTORTION_NONE) return camera;
  if (lens.model != RS2_DISTORTION_BROWN_CONRADY) {
    throw InputError("--camera", "its lens is described as '" +
                                     std::string(rs2_distortion_to_string(lens.model)) +
                                     "', which is not supported");
  }
  std::copy(std::begin(lens.coeffs), std::end(lens.coeffs), camera.distortion.begin());
  return camera;
}

// Only what a sensor has is set.
void Set(const rs2::sensor& sensor, rs2_option option, float value) {
  if (sensor.supports(option)) sensor.set_option(option, value);
}

class RealSenseCamera final : public robot::FrameSource {
 public:
  explicit RealSenseCamera(const RealSenseOptions& options)
      : options_(options), pipeline_(context_) {
    rs2::config config;
    config.enable_device(options.serial);
    if (options.infrared) {
      config.enable_stream(RS2_STREAM_INFRARED, 1, options.width, options.height, RS2_FORMAT_Y8,
                           options.rate_hz);
    } else {
      config.enable_stream(RS2_STREAM_COLOR, options.width, options.height, RS2_FORMAT_RGB8,
                           options.rate_hz);
    }
    const rs2::pipeline_profile profile = pipeline_.start(config);
    device_ = profile.get_device();
    context_.set_devices_changed_callback([this](rs2::event_information& event) {
      if (event.was_removed(device_)) is_gone_ = true;
    });
    for (const rs2::sensor& sensor : device_.query_sensors()) {
      Set(sensor, RS2_OPTION_EMITTER_ENABLED, 0);
      Set(sensor, RS2_OPTION_ENABLE_AUTO_EXPOSURE, 0);
      Set(sensor, RS2_OPTION_AUTO_EXPOSURE_PRIORITY, 0);  // else fewer frames in the dark
      // Microseconds, but for colour a tenth of a millisecond.
      const bool is_colour = sensor.is<rs2::color_sensor>();
      Set(sensor, RS2_OPTION_EXPOSURE,
          static_cast<float>(options.exposure_s * (is_colour ? 1e4 : 1e6)));
    }
    const auto stream = options.infrared ? profile.get_stream(RS2_STREAM_INFRARED, 1)
                                         : profile.get_stream(RS2_STREAM_COLOR);
    camera_ = IntrinsicsOf(stream.as<rs2::video_stream_profile>().get_intrinsics());
  }

  ~RealSenseCamera() override {
    try {
      pipeline_.stop();
    } catch (const rs2::error&) {  // it is gone already
    }
  }
  RealSenseCamera(const RealSenseCamera&) = delete;
  RealSenseCamera& operator=(const RealSenseCamera&) = delete;

  const robot::CameraIntrinsics& camera() const { return camera_; }

  EpisodeTime NextDue() const override { return EpisodeTime(0); }  // asked every millisecond

  std::optional<robot::Frame> Read(EpisodeTime now) override {
    if (is_gone_) throw robot::RobotError("the camera " + options_.serial + " was unplugged");
    rs2::frameset frames;
    try {
      if (!pipeline_.poll_for_frames(&frames)) return std::nullopt;
    } catch (const rs2::error& error) {
      throw robot::RobotError("the camera " + options_.serial + ": " + error.what());
    }
    const rs2::video_frame picture =
        options_.infrared ? frames.get_infrared_frame(1) : frames.get_color_frame();
    const EpisodeTime t = now - HorizonOffset(options_.latency_s);
    if (!picture || (last_ && t <= *last_)) return std::nullopt;
    last_ = t;
    robot::Frame frame;
    frame.t = t;
    frame.number = static_cast<std::int64_t>(picture.get_frame_number());
    frame.serial = options_.serial;
    frame.camera = camera_;
    frame.image = GreyOf(picture);
    return frame;
  }

 private:
  robot::GreyImage GreyOf(const rs2::video_frame& picture) const {
    robot::GreyImage image{picture.get_width(), picture.get_height(), {}};
    const auto width = static_cast<std::size_t>(image.width);
    image.pixels.resize(width * static_cast<std::size_t>(image.height));
    for (int y = 0; y < image.height; ++y) {
      const auto* const row = static_cast<const std::uint8_t*>(picture.get_data()) +
                              static_cast<std::ptrdiff_t>(y) * picture.get_stride_in_bytes();
      std::uint8_t* const grey = image.pixels.data() + static_cast<std::size_t>(y) * width;
      if (options_.infrared) {
        std::memcpy(grey, row, width);
        continue;
      }
      for (std::size_t x = 0; x < width; ++x) {  // luma of BT.601
        const int sum = 299 * row[3 * x] + 587 * row[3 * x + 1] + 114 * row[3 * x + 2];
        grey[x] = static_cast<std::uint8_t>(sum / 1000);
      }
    }
    return image;
  }

  RealSenseOptions options_;
  rs2::context context_;
  rs2::pipeline pipeline_;
  rs2::device device_;
  robot::CameraIntrinsics camera_;
  std::atomic<bool> is_gone_ = false;
  std::optional<EpisodeTime> last_;
};

}  // namespace

OpenCamera OpenRealSense(const RealSenseOptions& options) {
  try {
    auto camera = std::make_unique<RealSenseCamera>(options);
    return {{options.serial, camera->camera()}, std::move(camera)};
  } catch (const rs2::error& error) {
    throw InputError("--camera", options.serial + ": " + error.what());
  }
}

}  // namespace sidestep::hardware
