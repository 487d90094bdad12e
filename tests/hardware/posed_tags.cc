#include "tests/hardware/posed_tags.h"

#include <algorithm>

#include "sidestep/core/number_text.h"
#include "sidestep/sim/mujoco_model.h"
#include "sidestep/sim/world_xml.h"

namespace sidestep {

PosedTags::PosedTags(const std::vector<Pose>& X_CO, const Eigen::Vector3d& size_m,
                     const std::string& tags, const std::string& settings) {
  const Pose X_WC = scenarios::PoseOfCamera({1, 0, 1}, {0, 0, 0.5});
  std::string samples;  // a frame a second
  for (std::size_t i = 0; i < std::max<std::size_t>(2, X_CO.size()); ++i) {
    const Pose X_WO = X_WC * X_CO[std::min(i, X_CO.size() - 1)];
    const Eigen::Vector3d& p = X_WO.translation();
    const Eigen::Quaterniond& q = X_WO.rotation();
    samples += (i == 0 ? "[" : ", [") + std::to_string(i);
    for (const double value : {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()}) {
      samples += ", " + ShortestText(value);
    }
    samples += "]";
  }
  const std::string size =
      ShortestText(size_m.x()) + ", " + ShortestText(size_m.y()) + ", " + ShortestText(size_m.z());
  scenario_ = scenarios::ParseScenario(
      "description: A box with tags\n"
      "workspace: {first_center_m: [0, 0, 0], cell_m: 0.1, cells: [2, 2, 2]}\n"
      "floor_m: -1\n"
      "moving_obstacles:\n"
      "  - {name: box, shape: {box: {size_m: [" +
          size + "]}}, tags: " + tags + ", motion: {recorded: {samples: [" + samples +
          "]}}}\n"
          "knowledge: prediction\n"
          "sensor: {name: tag_images, rate_hz: 1, tag_images: {position_m: [1, 0, 1], "
          "look_at_m: [0, 0, 0.5], exposure_s: 0" +
          settings + "}}\nseed: 1\n",
      "posed_tags.yaml");
  body_ = {"box", Box{size_m}, {}};
  for (const scenarios::Tag& tag : scenario_.moving_obstacles[0].tags) {
    body_.tags.push_back({tag.id, tag.size_m, scenarios::TagPose(size_m, tag.face)});
  }
  const std::string xml = sim::BuildWorldXml(scenario_, {}, "");
  world_.emplace(scenario_, xml, sim::LoadMujocoModel(xml, "posed_tags"),
                 std::vector<std::string>(), Eigen::VectorXd());
  camera_.emplace(scenario_, *world_);
}

robot::Frame PosedTags::Take() {
  while (world_->time() < camera_->NextDue()) world_->Step(Eigen::VectorXd());
  return camera_->Read(world_->time()).value();
}

Pose PosedTags::X_CO() const {
  return X_WC().Inverse() * PoseAt(scenario_.moving_obstacles[0], world_->time());
}

}  // namespace sidestep
