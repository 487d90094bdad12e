#include "sidestep/sim/robot_survey.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "sidestep/sim/mujoco_model.h"
#include "sidestep/sim/robot_configuration.h"

namespace sidestep::sim {
namespace {

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

// Where the MJCF has the frame of a link.
std::optional<Pose> FrameOf(const robot::RobotModel& robot, const mjModel& model,
                            const mjData& data, std::size_t joint) {
  const auto& joints = robot.joints();
  std::string name = joints[joint].link;
  if (joints[joint].dh) {
    const auto row =
        std::count_if(joints.begin(), joints.begin() + static_cast<std::ptrdiff_t>(joint) + 1,
                      [](const robot::Joint& one) { return one.dh.has_value(); });
    name = "dh" + std::to_string(row);
  } else if (const int body = mj_name2id(&model, mjOBJ_BODY, name.c_str()); body >= 0) {
    return Pose(Eigen::Quaterniond(Eigen::Map<const RowMajor3>(data.xmat + 9 * body)),
                Eigen::Map<const Eigen::Vector3d>(data.xpos + 3 * body));
  }
  const int site = mj_name2id(&model, mjOBJ_SITE, name.c_str());
  if (site < 0) return std::nullopt;
  return Pose(Eigen::Quaterniond(Eigen::Map<const RowMajor3>(data.site_xmat + 9 * site)),
              Eigen::Map<const Eigen::Vector3d>(data.site_xpos + 3 * site));
}

std::string BodyName(const mjModel& model, int body) {
  const char* const name = mj_id2name(&model, mjOBJ_BODY, body);
  return name == nullptr ? "" : name;
}

}  // namespace

FrameDifference FindWorstFrame(const robot::RobotModel& robot, const mjModel& model,
                               int num_configurations, std::uint64_t seed) {
  FrameDifference worst;
  const MujocoDataPtr data = MakeMujocoData(model);
  RandomStream random(seed, "frames");
  for (int k = 0; k < num_configurations; ++k) {
    const Eigen::VectorXd q = DrawConfiguration(robot, random);
    PutAt(robot, model, q, data.get());
    const std::vector<Pose> X_WL = robot.ComputeLinkPoses(q);
    for (std::size_t i = 0; i < X_WL.size(); ++i) {
      const std::optional<Pose> frame = FrameOf(robot, model, *data, i);
      if (!frame) continue;
      const double apart_m = (X_WL[i].translation() - frame->translation()).norm();
      const double turned_rad = X_WL[i].rotation().angularDistance(frame->rotation());
      if (apart_m > worst.apart_m) worst.link = robot.joints()[i].link;
      worst.apart_m = std::max(worst.apart_m, apart_m);
      worst.turned_rad = std::max(worst.turned_rad, turned_rad);
    }
  }
  return worst;
}

std::vector<SelfContact> FindSelfContacts(const robot::RobotModel& robot, const mjModel& model,
                                          const Eigen::VectorXd& q) {
  const MujocoDataPtr data = MakeMujocoData(model);
  PutAt(robot, model, q, data.get());
  mj_collision(&model, data.get());
  std::map<std::pair<int, int>, SelfContact> by_bodies;
  for (int c = 0; c < data->ncon; ++c) {
    int first = model.geom_bodyid[data->contact[c].geom1];
    int second = model.geom_bodyid[data->contact[c].geom2];
    if (CarrierOfBody(robot, model, first) > CarrierOfBody(robot, model, second)) {
      std::swap(first, second);
    }
    by_bodies[{first, second}] = {CarrierOfBody(robot, model, first),
                                  CarrierOfBody(robot, model, second), BodyName(model, first),
                                  BodyName(model, second)};
  }
  std::vector<SelfContact> contacts;
  for (const auto& [bodies, contact] : by_bodies) contacts.push_back(contact);
  return contacts;
}

SelfContactSurvey SurveySelfContacts(const robot::RobotModel& robot, const mjModel& model,
                                     int num_configurations, std::uint64_t seed) {
  std::set<int> solid;
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (model.geom_contype[geom] == 0 && model.geom_conaffinity[geom] == 0) continue;
    solid.insert(CarrierOfBody(robot, model, model.geom_bodyid[geom]));
  }
  std::map<std::pair<int, int>, int> touched;
  for (const int first : solid) {
    for (const int second : solid) {
      if (first < second) touched[{first, second}] = 0;
    }
  }
  SelfContactSurvey survey;
  survey.num_configurations = num_configurations;
  const MujocoDataPtr data = MakeMujocoData(model);
  RandomStream random(seed, "self-contacts");
  for (int k = 0; k < num_configurations; ++k) {
    PutAt(robot, model, DrawConfiguration(robot, random), data.get());
    mj_collision(&model, data.get());
    survey.num_touching += data->ncon > 0;
    std::set<std::pair<int, int>> pairs;
    for (int c = 0; c < data->ncon; ++c) {
      const mjContact& contact = data->contact[c];
      pairs.insert(std::minmax({CarrierOfBody(robot, model, model.geom_bodyid[contact.geom1]),
                                CarrierOfBody(robot, model, model.geom_bodyid[contact.geom2])}));
    }
    for (const auto& pair : pairs) {
      if (pair.first != pair.second) ++touched[pair];
    }
  }
  for (const auto& [pair, count] : touched) {
    survey.pairs.push_back({pair.first, pair.second, count});
  }
  return survey;
}

}  // namespace sidestep::sim
