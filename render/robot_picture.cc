#include "sidestep/render/robot_picture.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "sidestep/render/camera.h"
#include "sidestep/render/mujoco_drawing.h"
#include "sidestep/sim/mujoco_model.h"
#include "sidestep/sim/robot_configuration.h"

namespace sidestep::render {
namespace {

constexpr double kPictureFieldOfView_deg = 24;
constexpr double kElevation_rad = -0.2;
constexpr double kPictureMargin = 1.04;  // of the picture that the robot takes
constexpr float kGlass = 0.38F;
constexpr std::array<std::array<float, 3>, 4> kColors = {
    {{0.90F, 0.35F, 0.20F}, {0.15F, 0.45F, 0.90F}, {0.20F, 0.65F, 0.30F}, {0.75F, 0.45F, 0.85F}}};

sim::MujocoModelPtr ModelForPicture(const mjModel& model, int size) {
  sim::MujocoModelPtr copy(mj_copyModel(nullptr, &model));
  copy->vis.global.offwidth = copy->vis.global.offheight = size;
  copy->vis.global.fovy = static_cast<float>(kPictureFieldOfView_deg);
  copy->vis.quality.offsamples = 4;
  copy->vis.headlight.ambient[0] = copy->vis.headlight.ambient[1] = copy->vis.headlight.ambient[2] =
      0.35F;
  return copy;
}

void Add(mjvScene* scene, mjtGeom type, const Eigen::Vector3d& half_m, const Eigen::Vector3d& p_W,
         const Eigen::Matrix3d& R_W, const std::array<float, 4>& color, float emission) {
  if (scene->ngeom >= scene->maxgeom) return;
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rows = R_W;
  mjvGeom& geom = scene->geoms[scene->ngeom++];
  mjv_initGeom(&geom, type, half_m.data(), p_W.data(), rows.data(), color.data());
  geom.emission = emission;
}

// A white wall behind everything that is seen.
void AddWall(mjvScene* scene, const CameraView& view, double behind_m) {
  const Eigen::Vector3d forward = view.forward();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d R;
  R << right, right.cross(forward), -forward;
  const double reach_m = 4 * (view.distance_m + behind_m);
  Add(scene, mjGEOM_BOX, {reach_m, reach_m, 0.001}, view.lookat_m + behind_m * forward, R,
      {1, 1, 1, 1}, 1);
}

}  // namespace

Image DrawRobotAndSpheres(const GlContext&, const robot::RobotModel& robot, const mjModel& model,
                          const Eigen::VectorXd& q, int size) {
  const sim::MujocoModelPtr copy = ModelForPicture(model, size);
  const sim::MujocoDataPtr data = sim::MakeMujocoData(*copy);
  sim::PutAt(robot, *copy, q, data.get());
  mj_camlight(copy.get(), data.get());
  const Eigen::Matrix3Xd centers = robot.ComputeSphereCenters(q, /*with_jacobian=*/false).p_WS;

  // The corners of boxes around all spheres and geoms.
  std::vector<Eigen::Vector3d> corners;
  const auto add_box = [&corners](const Eigen::Vector3d& p, double radius) {
    for (int i = 0; i < 8; ++i) {
      corners.push_back(p + radius * kPictureMargin *
                                Eigen::Vector3d((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1,
                                                (i & 4) != 0 ? 1 : -1));
    }
  };
  for (Eigen::Index s = 0; s < centers.cols(); ++s) {
    add_box(centers.col(s), robot.sphere_radii_m()[s]);
  }
  for (int geom = 0; geom < copy->ngeom; ++geom) {
    add_box(Eigen::Map<const Eigen::Vector3d>(data->geom_xpos + 3 * geom), copy->geom_rbound[geom]);
  }
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(corners.size()));
  for (std::size_t i = 0; i < corners.size(); ++i) {
    points.col(static_cast<Eigen::Index>(i)) = corners[i];
  }
  const double reach_m = (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();

  const double tangent = std::tan(kPictureFieldOfView_deg / 2 * std::numbers::pi / 180);
  const Frustum frustum = {-tangent, tangent, -tangent, tangent};
  constexpr int kRoom = 16;
  Scene scene(*copy, copy->ngeom + robot.num_spheres() + kRoom);
  scene.get().flags[mjRND_SHADOW] = 0;
  scene.get().flags[mjRND_REFLECTION] = 0;
  const DrawingContext drawing(*copy);
  mjvOption option;
  mjv_defaultOption(&option);
  option.geomgroup[2] = 0;  // pictures
  Image four(2 * size, 2 * size);
  for (int side = 0; side < 4; ++side) {
    const double azimuth_rad = std::numbers::pi * (1 + side / 2.0);
    const CameraView view = FitCamera(points, azimuth_rad, kElevation_rad, frustum);
    mjvCamera camera;
    mjv_defaultCamera(&camera);
    camera.type = mjCAMERA_FREE;
    Eigen::Map<Eigen::Vector3d>(camera.lookat) = view.lookat_m;
    camera.distance = view.distance_m;
    camera.azimuth = view.azimuth_rad * 180 / std::numbers::pi;
    camera.elevation = view.elevation_rad * 180 / std::numbers::pi;
    mjv_updateScene(copy.get(), data.get(), &option, nullptr, &camera, mjCAT_ALL, &scene.get());
    AddWall(&scene.get(), view, reach_m);
    for (Eigen::Index s = 0; s < centers.cols(); ++s) {
      const int place = robot.spheres()[static_cast<std::size_t>(s)].link + 1;  // the base's is 0
      const std::array<float, 3>& color = kColors[static_cast<std::size_t>(place) % kColors.size()];
      Add(&scene.get(), mjGEOM_SPHERE, Eigen::Vector3d::Constant(robot.sphere_radii_m()[s]),
          centers.col(s), Eigen::Matrix3d::Identity(), {color[0], color[1], color[2], kGlass}, 0);
    }
    drawing.Render(scene.get());
    four.Paste(drawing.Read(), (side % 2) * size, (side / 2) * size);
  }
  return four;
}

}  // namespace sidestep::render
