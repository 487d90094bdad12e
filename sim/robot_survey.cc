#include "sidestep/sim/robot_survey.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "sidestep/sim/link_frame.h"
#include "sidestep/sim/mujoco_model.h"
#include "sidestep/sim/robot_configuration.h"

namespace sidestep::sim {
namespace {

std::string BodyName(const mjModel& model, int body) {
  const char* const name = mj_id2name(&model, mjOBJ_BODY, body);
  return name == nullptr ? "" : name;
}

}  // namespace

FrameDifference FindWorstFrame(const robot::RobotModel& robot, const mjModel& model,
                               int num_configurations, std::uint64_t seed) {
  FrameDifference worst;
  const MujocoDataPtr data = MakeMujocoData(model);
  std::vector<LinkFrame> frames;
  for (std::size_t i = 0; i < robot.joints().size(); ++i) {
    frames.push_back(FindLinkFrame(robot, model, i));
  }
  RandomStream random(seed, "frames");
  for (int k = 0; k < num_configurations; ++k) {
    const Eigen::VectorXd q = DrawConfiguration(robot, random);
    PutAt(robot, model, q, data.get());
    const std::vector<Pose> X_WL = robot.ComputeLinkPoses(q);
    for (std::size_t i = 0; i < X_WL.size(); ++i) {
      if (frames[i].id < 0) continue;
      const Pose frame = PoseOf(*data, frames[i]);
      const double apart_m = (X_WL[i].translation() - frame.translation()).norm();
      const double turned_rad = X_WL[i].rotation().angularDistance(frame.rotation());
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
  SelfContactSurvey survey;
  survey.num_configurations = num_configurations;
  for (const int first : solid) {
    for (const int second : solid) {
      if (first < second) survey.pairs.push_back({first, second});
    }
  }
  std::map<int, std::vector<Eigen::Index>> spheres;  // of each link
  for (int s = 0; s < robot.num_spheres(); ++s) {
    spheres[CarrierOf(robot, robot.spheres()[static_cast<std::size_t>(s)].link)].push_back(s);
  }
  const auto overlap = [&](const PairCount& pair, const Eigen::Matrix3Xd& p_WS) {
    for (const Eigen::Index a : spheres[pair.first]) {
      for (const Eigen::Index b : spheres[pair.second]) {
        const double reach_m = robot.sphere_radii_m()[a] + robot.sphere_radii_m()[b];
        if ((p_WS.col(a) - p_WS.col(b)).squaredNorm() < reach_m * reach_m) return true;
      }
    }
    return false;
  };
  const MujocoDataPtr data = MakeMujocoData(model);
  RandomStream random(seed, "self-contacts");
  for (int k = 0; k < num_configurations; ++k) {
    const Eigen::VectorXd q = DrawConfiguration(robot, random);
    PutAt(robot, model, q, data.get());
    mj_collision(&model, data.get());
    survey.num_touching += data->ncon > 0;
    std::set<std::pair<int, int>> touching;
    for (int c = 0; c < data->ncon; ++c) {
      const mjContact& contact = data->contact[c];
      touching.insert(std::minmax({CarrierOfBody(robot, model, model.geom_bodyid[contact.geom1]),
                                   CarrierOfBody(robot, model, model.geom_bodyid[contact.geom2])}));
    }
    const Eigen::Matrix3Xd p_WS = robot.ComputeSphereCenters(q, /*with_jacobian=*/false).p_WS;
    for (PairCount& pair : survey.pairs) {
      if (touching.count({pair.first, pair.second}) > 0) {
        ++pair.touched;
      } else if (overlap(pair, p_WS)) {
        ++pair.false_alarms;
      }
    }
  }
  return survey;
}

}  // namespace sidestep::sim
