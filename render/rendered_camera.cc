#include "sidestep/render/rendered_camera.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sidestep/core/input_error.h"
#include "sidestep/render/gl_context.h"
#include "sidestep/render/lens.h"
#include "sidestep/render/mujoco_drawing.h"
#include "sidestep/sim/mujoco_model.h"

namespace sidestep::render {
namespace {

constexpr int kMaxCameraGeoms = 4000;
constexpr int kExposures = 3;  // pictures to a smeared one: at 0.5 m/s they are half a pixel apart
constexpr float kNearPlane_m = 0.05F, kFarPlane_m = 50;

Lens LensOf(const scenarios::Scenario& scenario) {
  try {
    return Lens(IntrinsicsOf(scenario), scenario.sensor.tag_images->blur_px);
  } catch (const std::invalid_argument&) {
    throw scenarios::WrongValue(scenario, "sensor.tag_images.distortion",
                                "folds the picture: a lens of this angle cannot have it",
                                {"sensor.tag_images.field_of_view_rad"});
  }
}

// The model for drawing alone, its picture as large as the lens wants it.
sim::MujocoModelPtr ModelForLens(const std::string& world_xml, const Lens& lens) {
  sim::MujocoModelPtr model = sim::LoadMujocoModel(world_xml, "a camera's world");
  model->vis.global.offwidth = lens.ideal_width();
  model->vis.global.offheight = lens.ideal_height();
  model->vis.quality.offsamples = 0;  // the lens samples finely itself
  model->vis.quality.numquads = 1;
  return model;
}

void Copy(const Eigen::Vector3d& from, float* to) {
  for (int axis = 0; axis < 3; ++axis) to[axis] = static_cast<float>(from(axis));
}

}  // namespace

robot::CameraIntrinsics IntrinsicsOf(const scenarios::Scenario& scenario) {
  const scenarios::TagImageSettings& settings = scenario.sensor.tag_images.value();
  robot::CameraIntrinsics camera =
      robot::PinholeOf(settings.width, settings.height, settings.field_of_view_rad);
  camera.distortion = settings.distortion;
  return camera;
}

// The world as it is drawn: MuJoCo's model, set to any moment near the present one.
class RenderedCamera::Studio {
 public:
  Studio(const scenarios::Scenario& scenario, const sim::World& world)
      : world_(world),
        X_WC_(scenarios::PoseOfCamera(scenario.sensor.tag_images->position_m,
                                      scenario.sensor.tag_images->look_at_m)),
        exposure_s_(scenario.sensor.tag_images->exposure_s),
        lens_(LensOf(scenario)),
        model_(ModelForLens(world.xml(), lens_)),
        data_(sim::MakeMujocoData(*model_)),
        scene_(*model_, kMaxCameraGeoms),
        drawing_(*model_) {
    scene_.get().flags[mjRND_SHADOW] = 0;
    scene_.get().flags[mjRND_REFLECTION] = 0;
    for (const scenarios::MovingObstacle& obstacle : world.obstacles()) {
      const int body = mj_name2id(model_.get(), mjOBJ_BODY, obstacle.name.c_str());
      mocap_ids_.push_back(model_->body_mocapid[body]);
    }
  }

  ~Studio() { gl_.MakeCurrent(); }  // what is given back belongs to it
  Studio(const Studio&) = delete;
  Studio& operator=(const Studio&) = delete;

  const Pose& X_WC() const { return X_WC_; }
  const robot::CameraIntrinsics& camera() const { return lens_.camera(); }

  // What the sensor collects over the exposure, in grey levels.
  std::vector<float> Expose() {
    gl_.MakeCurrent();
    const int count = exposure_s_ > 0 && Moves() ? kExposures : 1;
    std::vector<float> light(static_cast<std::size_t>(lens_.ideal_width()) *
                             static_cast<std::size_t>(lens_.ideal_height()));
    for (int k = 0; k < count; ++k) {
      MoveTo(exposure_s_ * ((k + 0.5) / count - 0.5));
      AddPicture(1.0F / static_cast<float>(count), &light);
    }
    return lens_.Apply(light);
  }

 private:
  bool Moves() const {
    const mjData& now = world_.data();
    if (std::any_of(now.qvel, now.qvel + model_->nv, [](double v) { return std::abs(v) > 1e-6; })) {
      return true;
    }
    const HorizonOffset half(exposure_s_ / 2);
    for (const scenarios::MovingObstacle& obstacle : world_.obstacles()) {
      const Pose before = PoseAt(obstacle, world_.time() - half);
      const Pose after = PoseAt(obstacle, world_.time() + half);
      if ((after.translation() - before.translation()).norm() > 1e-6 ||
          after.rotation().angularDistance(before.rotation()) > 1e-6) {
        return true;
      }
    }
    return false;
  }

  // To the world as it is `later_s` after now: obstacles as prescribed, joints at their speeds.
  void MoveTo(double later_s) {
    const mjData& now = world_.data();
    std::copy(now.qpos, now.qpos + model_->nq, data_->qpos);
    mj_integratePos(model_.get(), data_->qpos, now.qvel, later_s);
    for (std::size_t i = 0; i < mocap_ids_.size(); ++i) {
      const Pose X_WO = PoseAt(world_.obstacles()[i], world_.time() + HorizonOffset(later_s));
      const Eigen::Quaterniond& R = X_WO.rotation();
      Eigen::Map<Eigen::Vector3d>(data_->mocap_pos + 3 * mocap_ids_[i]) = X_WO.translation();
      Eigen::Map<Eigen::Vector4d>(data_->mocap_quat + 4 * mocap_ids_[i]) << R.w(), R.x(), R.y(),
          R.z();
    }
    mj_kinematics(model_.get(), data_.get());
    mj_comPos(model_.get(), data_.get());
    mj_camlight(model_.get(), data_.get());
  }

  void AddPicture(float weight, std::vector<float>* light) {
    mjvOption option;
    mjv_defaultOption(&option);
    mjvCamera camera;
    mjv_defaultCamera(&camera);
    mjv_updateScene(model_.get(), data_.get(), &option, nullptr, &camera, mjCAT_ALL, &scene_.get());
    Aim();
    drawing_.Render(scene_.get());
    const Image image = drawing_.Read();
    for (int y = 0; y < image.height(); ++y) {
      const std::uint8_t* rgb = image.row(y);
      float* const out =
          light->data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width());
      for (int x = 0; x < image.width(); ++x, rgb += 3) {  // luma of BT.601
        out[x] +=
            weight * (0.299F * static_cast<float>(rgb[0]) + 0.587F * static_cast<float>(rgb[1]) +
                      0.114F * static_cast<float>(rgb[2]));
      }
    }
  }

  // Puts MuJoCo's eye, and the light that it carries, where the camera is.
  void Aim() {
    const Eigen::Vector3d forward = X_WC_.Rotate(Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d up = X_WC_.Rotate(-Eigen::Vector3d::UnitY());
    mjvScene& scene = scene_.get();
    for (mjvGLCamera& eye : scene.camera) {
      Copy(X_WC_.translation(), eye.pos);
      Copy(forward, eye.forward);
      Copy(up, eye.up);
      eye.frustum_center = kNearPlane_m * static_cast<float>((lens_.left() + lens_.right()) / 2);
      eye.frustum_top = kNearPlane_m * static_cast<float>(-lens_.top());
      eye.frustum_bottom = kNearPlane_m * static_cast<float>(-lens_.bottom());
      eye.frustum_near = kNearPlane_m;
      eye.frustum_far = kFarPlane_m;
    }
    for (int i = 0; i < scene.nlight; ++i) {
      if (!scene.lights[i].headlight) continue;
      Copy(X_WC_.translation(), scene.lights[i].pos);
      Copy(forward, scene.lights[i].dir);
    }
  }

  const sim::World& world_;
  Pose X_WC_;
  double exposure_s_;
  GlContext gl_;
  Lens lens_;
  sim::MujocoModelPtr model_;
  sim::MujocoDataPtr data_;
  Scene scene_;
  DrawingContext drawing_;
  std::vector<int> mocap_ids_;  // of each obstacle
};

RenderedCamera::RenderedCamera(const scenarios::Scenario& scenario, const sim::World& world)
    : world_(world),
      clock_(scenario.sensor.rate_hz),
      line_(scenario.sensor, scenario.seed),
      grey_noise_(scenario.sensor.tag_images.value().grey_noise),
      noise_(scenario.seed, "grey noise"),
      studio_(std::make_unique<Studio>(scenario, world)) {}

RenderedCamera::~RenderedCamera() = default;

const Pose& RenderedCamera::X_WC() const { return studio_->X_WC(); }

EpisodeTime RenderedCamera::NextDue() const {
  return std::min(clock_.Next(), line_.NextArrival().value_or(clock_.Next()));
}

std::optional<robot::Frame> RenderedCamera::Read(EpisodeTime) {
  if (clock_.Take(world_.ticks())) line_.Send(Capture());
  return line_.Take(world_.ticks());
}

robot::Frame RenderedCamera::Capture() {
  robot::Frame frame;
  frame.t = world_.time();
  frame.number = number_++;
  frame.serial = kRenderedSerial;
  frame.camera = studio_->camera();
  frame.image.width = frame.camera.width;
  frame.image.height = frame.camera.height;
  // The sum of eight even bytes is near enough to a normal number, and cheaper.
  constexpr double kMean = 8 * 127.5, kVariance = 8 * (65536.0 - 1) / 12;
  const auto scale = static_cast<float>(grey_noise_ / std::sqrt(kVariance));
  for (float level : studio_->Expose()) {
    if (grey_noise_ > 0) {
      int sum = 0;
      for (std::uint64_t bits = noise_.Bits(), byte = 0; byte < 8; ++byte, bits >>= 8) {
        sum += static_cast<int>(bits & 0xff);
      }
      level += scale * (static_cast<float>(sum) - static_cast<float>(kMean));
    }
    frame.image.pixels.push_back(
        static_cast<std::uint8_t>(std::clamp(std::floor(level + 0.5F), 0.0F, 255.0F)));
  }
  return frame;
}

}  // namespace sidestep::render
