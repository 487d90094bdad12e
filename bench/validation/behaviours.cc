#include "sidestep/bench/validation/behaviours.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "sidestep/bench/validation/named_row.h"
#include "sidestep/core/shape.h"

namespace sidestep::bench {
namespace {

using Eigen::Vector3d;
using scenarios::Motion;
using Motions = std::vector<Motion>;

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kShare = 0.95;         // of what is declared: what is measured of it errs
constexpr double kBeginsClear_m = 0.2;  // from the arm at its start
constexpr int kMostTries = 200;

Vector3d StartOf(const Course& course, const Vector3d& direction, double speed_m_s) {
  const double way_m = std::max(course.least_way_m, speed_m_s * course.meets_after_s);
  return course.p_WThrough - way_m * direction;
}

Motion Straight(const Course& course, const Vector3d& direction, double speed_m_s) {
  return scenarios::LinearMotion{StartOf(course, direction, speed_m_s), direction, speed_m_s,
                                 kNever, 0};
}

// Brakes so as to rest a little before the place, or suddenly there.
Motion Stopping(const Course& course, double speed_m_s, double acceleration_m_s2) {
  const Vector3d start_m = StartOf(course, course.across_W, speed_m_s);
  const double way_m = (course.p_WThrough - start_m).norm();
  if (!std::isfinite(acceleration_m_s2)) {
    return scenarios::LinearMotion{start_m, course.across_W, speed_m_s, way_m / speed_m_s, 0};
  }
  const double braking_m = speed_m_s * speed_m_s / (2 * acceleration_m_s2);
  return scenarios::AcceleratedMotion{start_m,
                                      course.across_W,
                                      speed_m_s,
                                      -acceleration_m_s2,
                                      std::max(0.0, way_m - braking_m) / speed_m_s,
                                      speed_m_s,
                                      kNever,
                                      0};
}

// From half its speed to all of it, halfway.
Motion SpeedingUp(const Course& course, double speed_m_s, double acceleration_m_s2) {
  return scenarios::AcceleratedMotion{StartOf(course, course.across_W, speed_m_s / 2),
                                      course.across_W,
                                      speed_m_s / 2,
                                      acceleration_m_s2,
                                      course.meets_after_s / 2,
                                      speed_m_s,
                                      kNever,
                                      0};
}

// Through there first, then wherever.
Motion Way(const Course& course, double speed_m_s, const Vector3d& then_m) {
  scenarios::WaypointMotion motion;
  motion.points_m = {StartOf(course, course.across_W, speed_m_s), course.p_WThrough, then_m};
  motion.speed_m_s = speed_m_s;
  motion.stop_at_s = kNever;
  return motion;
}

Motion Circling(const Course& course, double speed_m_s, double acceleration_m_s2) {
  const double radius_m = std::max(0.35, speed_m_s * speed_m_s / (kShare * acceleration_m_s2));
  const Vector3d from = -course.across_W;  // begins opposite to the place it passes
  return scenarios::CircleMotion{course.p_WThrough + radius_m * from,
                                 radius_m,
                                 std::atan2(from.y(), from.x()),
                                 false,
                                 speed_m_s,
                                 kNever,
                                 0};
}

constexpr Behaviour kBehaviours[] = {
    {"stand", "stands in the way", 0,
     [](const Course& course, double, double) {
       const Vector3d p_W = course.p_WThrough - course.aside_m * course.across_W;
       return Motions{scenarios::LinearMotion{p_W, course.across_W, 0, kNever, 0}};
     }},
    {"cross", "crosses the tool's way", 0,
     [](const Course& course, double v, double) {
       return Motions{Straight(course, course.across_W, v)};
     }},
    {"head_on", "comes the way that the tool goes", 0,
     [](const Course& course, double v, double) {
       return Motions{Straight(course, -course.along_W, v)};
     }},
    {"follow", "comes after the tool", 0,
     [](const Course& course, double v, double) {
       return Motions{Straight(course, course.along_W, v)};
     }},
    {"slow_down", "brakes and stays in the way", kShare,
     [](const Course& course, double v, double a) {
       return Motions{Stopping(course, v, kShare * a)};
     }},
    {"speed_up", "doubles its speed", kShare,
     [](const Course& course, double v, double a) {
       return Motions{SpeedingUp(course, v, kShare * a)};
     }},
    {"circle", "goes round a circle that passes the way", kShare,
     [](const Course& course, double v, double a) { return Motions{Circling(course, v, a)}; }},
    {"two_boxes", "crosses, and another one like it the other way", 0,
     [](const Course& course, double v, double) {
       Course other = course;
       other.p_WThrough += 0.35 * course.along_W;
       other.meets_after_s += 1;
       return Motions{Straight(course, course.across_W, v), Straight(other, -course.across_W, v)};
     }},
    {"slow_down_hard", "brakes twice as hard as declared, and stays", 2,
     [](const Course& course, double v, double a) { return Motions{Stopping(course, v, 2 * a)}; }},
    {"speed_up_hard", "doubles its speed, twice as hard as declared", 2,
     [](const Course& course, double v, double a) {
       return Motions{SpeedingUp(course, v, 2 * a)};
     }},
    {"stop", "stops from one moment to the next, and stays", kNever,
     [](const Course& course, double v, double) { return Motions{Stopping(course, v, kNever)}; }},
    {"reverse", "turns back from one moment to the next", kNever,
     [](const Course& course, double v, double) {
       return Motions{Way(course, v, course.p_WThrough - 3 * course.across_W)};
     }},
    {"turn", "turns by 90 degrees from one moment to the next", kNever,
     [](const Course& course, double v, double) {
       return Motions{Way(course, v, course.p_WThrough + 3 * scenarios::LeftOf(course.across_W))};
     }},
};

// Along the level, or else x.
Vector3d Level(const Vector3d& vector) {
  const Vector3d level(vector.x(), vector.y(), 0);
  return level.norm() > 1e-6 ? level.normalized() : Vector3d::UnitX();
}

Vector3d Turned(const Vector3d& v, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y(), v.z()};
}

double ClearanceAtStart(const scenarios::Scenario& scenario, const robot::RobotModel& robot) {
  const Eigen::Matrix3Xd p_WS = robot.ComputeSphereCenters(scenario.q_start, false).p_WS;
  double least_m = kNever;
  for (const scenarios::MovingObstacle& obstacle : scenario.moving_obstacles) {
    const Pose X_OW = PoseAt(obstacle, EpisodeTime(0)).Inverse();
    for (Eigen::Index s = 0; s < p_WS.cols(); ++s) {
      const double distance_m = SignedDistance(obstacle.shape, X_OW * Vector3d(p_WS.col(s)));
      least_m = std::min(least_m, distance_m - robot.sphere_radii_m()(s));
    }
  }
  return least_m;
}

}  // namespace

std::span<const Behaviour> Behaviours() { return kBehaviours; }

const Behaviour& BehaviourOf(const std::string& name) {
  return RowNamed(Behaviours(), "behaviour", name);
}

Course DrawCourse(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                  RandomStream& random) {
  const auto tool = [&](const Eigen::VectorXd& q) {
    return robot.ComputeToolPose(q).translation();
  };
  const Vector3d p_WStart = tool(scenario.q_start), p_WGoal = tool(scenario.q_goal);
  const scenarios::MovingObstacle& obstacle = scenario.moving_obstacles.front();
  Course course;
  course.p_WThrough = p_WStart + random.Uniform(0.3, 0.8) * (p_WGoal - p_WStart);
  course.p_WThrough.z() += random.Uniform(-0.1, 0.1);
  course.along_W = Level(p_WGoal - p_WStart);
  course.across_W =
      Turned(Level(DirectionAt(obstacle.motion, EpisodeTime(0))), random.Uniform(-0.35, 0.35));
  course.meets_after_s = random.Uniform(1, 3.5);
  course.least_way_m = HalfExtents(obstacle.shape).norm() + 0.35;
  return course;
}

void SetBehaviour(const std::string& name, double speed_m_s, std::uint64_t seed,
                  const robot::RobotModel& robot, scenarios::Scenario& scenario) {
  const Behaviour& behaviour = BehaviourOf(name);
  RandomStream random(seed, "validation course " + name);
  const scenarios::Scenario as_it_was = scenario;
  for (int draw = 0; draw < kMostTries; ++draw) {
    scenario.moving_obstacles = as_it_was.moving_obstacles;
    Course course = DrawCourse(as_it_was, robot, random);
    // What is slow may have to come from further off, and what stands may have to stand further.
    course.aside_m = 0.01 * draw;
    course.least_way_m += course.aside_m;
    const Motions motions =
        behaviour.make(course, speed_m_s, scenario.safety.obstacle_acceleration_m_s2);
    scenario.moving_obstacles.front().motion = motions.front();
    if (motions.size() > 1) {
      scenarios::MovingObstacle other = scenario.moving_obstacles.front();
      other.name = "other_" + other.name;
      other.motion = motions.back();
      scenario.moving_obstacles.push_back(std::move(other));
    }
    if (ClearanceAtStart(scenario, robot) > kBeginsClear_m) return;
  }
  throw std::runtime_error("validation: no place was found where '" + name +
                           "' begins clear of the arm");
}

}  // namespace sidestep::bench
