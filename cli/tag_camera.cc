#include "sidestep/cli/tag_camera.h"

#include <memory>
#include <utility>

#include "sidestep/cli/panda_connection.h"
#include "sidestep/cli/sensors.h"
#include "sidestep/core/input_error.h"
#include "sidestep/hardware/camera_file.h"
#include "sidestep/hardware/realsense_camera.h"
#include "sidestep/hardware/recorded_frames.h"
#include "sidestep/hardware/remote_frames.h"
#include "sidestep/render/rendered_camera.h"

namespace sidestep::cli {
namespace {

// What opens a camera, once for a world.
using OpenFrames = std::function<std::unique_ptr<robot::FrameSource>(const scenarios::Scenario&,
                                                                     const sim::World&)>;

struct Source {
  hardware::NamedCamera camera;
  OpenFrames open;
  std::string description;
  std::optional<EpisodeTime> ends_at;
};

hardware::NamedCamera RenderedCameraOf(const scenarios::Scenario& scenario) {
  return {render::kRenderedSerial, render::IntrinsicsOf(scenario)};
}

// What has been opened already.
OpenFrames Once(std::unique_ptr<robot::FrameSource> frames) {
  const auto held = std::make_shared<std::unique_ptr<robot::FrameSource>>(std::move(frames));
  return [held](const scenarios::Scenario&, const sim::World&) { return std::move(*held); };
}

std::unique_ptr<robot::FrameSource> ConnectToServer(const std::string& robot) {
  try {
    return std::make_unique<hardware::RemoteFrames>(NumericAddress(robot));
  } catch (const robot::fci::LinkError& error) {
    throw InputError("--camera",
                     std::string(error.what()) +
                         ": `sidestep fci-server`, in lock-step, shows what the camera of its "
                         "--scenario sees if that has the sensor tag_images");
  }
}

Source OpenSource(const scenarios::Scenario& scenario, const CameraUse& use) {
  const scenarios::SensorSettings& sensor = scenario.sensor;
  switch (use.choice.kind) {
    case CameraKind::kServer:
      return {RenderedCameraOf(scenario),
              [robot = use.robot](const auto&, const auto&) { return ConnectToServer(robot); },
              "the robot server's", std::nullopt};
    case CameraKind::kRecorded: {
      const HorizonOffset latency(sensor.latency_s);
      auto frames = std::make_unique<hardware::RecordedFrames>(use.choice.of, latency);
      const EpisodeTime ends_at = frames->end() + latency;
      const hardware::NamedCamera camera = frames->camera();
      return {camera, Once(std::move(frames)), "recorded, " + camera.serial, ends_at};
    }
    case CameraKind::kRealSense: {
      hardware::RealSenseOptions options;
      options.serial = use.choice.of;
      options.width = sensor.tag_images->width;
      options.height = sensor.tag_images->height;
      options.rate_hz = static_cast<int>(sensor.rate_hz);
      options.exposure_s = sensor.tag_images->exposure_s;
      options.latency_s = sensor.latency_s;
      hardware::OpenCamera open = hardware::OpenRealSense(options);
      return {open.camera, Once(std::move(open.frames)), "RealSense " + open.camera.serial,
              std::nullopt};
    }
    case CameraKind::kVirtual:
      break;
  }
  return {RenderedCameraOf(scenario),
          [](const scenarios::Scenario& of, const sim::World& world) {
            return std::make_unique<render::RenderedCamera>(of, world);
          },
          "", std::nullopt};
  // The analyzer does not follow what a std::function owns.
}  // NOLINT(clang-analyzer-cplusplus.NewDeleteLeaks)

}  // namespace

CameraChoice ParseCamera(const std::string& text) {
  if (text == "virtual") return {CameraKind::kVirtual, ""};
  if (text == "server") return {CameraKind::kServer, ""};
  for (const auto& [word, kind] : {std::pair("recorded:", CameraKind::kRecorded),
                                   std::pair("realsense:", CameraKind::kRealSense)}) {
    const std::string begin = word;
    if (text.starts_with(begin) && text.size() > begin.size()) {
      return {kind, text.substr(begin.size())};
    }
  }
  throw InputError("--camera",
                   "must be virtual, server, recorded:DIR or realsense:SERIAL, is '" + text + "'");
}

ReadyCamera OpenTagCamera(const scenarios::Scenario& scenario, const CameraUse& use,
                          const std::string& today) {
  if (scenario.sensor.name != kTagImages) {
    throw InputError(
        use.calibration ? "--calibration" : "--camera",
        "is of a camera: the sensor is '" + scenario.sensor.name + "', not tag_images");
  }
  sim::CheckSensorSettings(scenario, kTagImages);
  Source source = OpenSource(scenario, use);
  if (use.calibration) {
    const auto why_not = hardware::WhyNotUsable(*use.calibration, source.camera.serial,
                                                source.camera.intrinsics, today);
    if (why_not) throw InputError("--calibration", *why_not);
  } else if (source.camera.serial != render::kRenderedSerial) {
    throw InputError("--calibration", "is needed: nobody knows where the camera " +
                                          source.camera.serial + " stands");
  }
  hardware::TagSensorOptions options = TagSensorOptionsOf(scenario);
  if (use.calibration) options.X_WC = use.calibration->X_WC;
  options.on_look = use.on_look;
  return {[open = std::move(source.open), options](const scenarios::Scenario& of,
                                                   const sim::World& world) {
            return MakeTagSensor(open(of, world), options, of, world);
          },
          source.description, source.ends_at};
}

}  // namespace sidestep::cli
