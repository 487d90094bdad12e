#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "sidestep/robot/robot_model.h"

/// The SIMD half of ObstacleObjective: plain structs and functions, compiled for several
/// instruction sets. A lane is a configuration, so that no sum crosses lanes, and every instruction
/// set gives the same bits, whatever the C library: sines and cosines are computed here.
/// Only ArmGroup and those who work on one include this file.
namespace sidestep::planner::obstacle_kernels {

/// So many configurations are worked on together, on every machine. Arrays named `..._8` below hold
/// one number of each, side by side.
inline constexpr std::size_t kGroup = 8;
inline constexpr int kMaxJoints = robot::RobotModel::kMaxJoints;

/// A serial arm and what is asked of it, ready for the kernels.
struct Arm {
  struct Joint {
    double theta_rad = 0, d_m = 0, a_m = 0, cos_alpha = 1, sin_alpha = 0;
    int end_sphere = 0;  ///< spheres of this link end here; they begin where those before it end
  };
  struct Sphere {
    std::array<double, 3> p_LS{};
  };
  struct Hinge {
    int sphere = 0, link = 0;
    double radius_m = 0;
    double reach_m = 0;  ///< active where the field is nearer than this
  };
  struct SpherePair {
    int first = 0, second = 0;  // spheres
    double first_radius_m = 0, second_radius_m = 0;
  };
  struct LinkHinge {
    int first = 0, second = 0;  // links
    std::vector<SpherePair> pairs;
  };

  int num_joints = 0;
  std::array<double, 9> R_WB{};  ///< row by row
  std::array<double, 3> p_WB{};
  std::array<Joint, kMaxJoints> joints;
  std::vector<Sphere> spheres;  ///< link by link
  std::vector<Hinge> hinges;
  std::vector<LinkHinge> link_hinges;
  double self_epsilon_m = 0;
  double inverse_sigma = 0;

  /// Numbers that are said of one configuration: its cost, its gradient, and its Hessian's lower
  /// triangle row by row.
  int num_terms() const { return 1 + num_joints + num_joints * (num_joints + 1) / 2; }
};

/// Of each joint its axis z (3), and z x o with o a point of the axis (3).
inline constexpr std::size_t kNumbersPerAxis = 6;

/// @param q_8 n; @param axes_8 n x 6 and @param centers_8 S x 3 [m], in W, receive the answer.
void ComputeCenters(const Arm& arm, const double* q_8, double* axes_8, double* centers_8);

/// @param samples_8 of each hinge what the field says of its sphere: distance, gradient.
/// @param terms_8 num_terms() receive the answer.
void ComputeTerms(const Arm& arm, const double* axes_8, const double* centers_8,
                  const double* samples_8, double* terms_8);

/// @param clearance_8 [m] of each configuration the least of all samples less their spheres' radii
/// and of all gaps between the links of link_hinges; infinite without any.
void ComputeClearance(const Arm& arm, const double* centers_8, const double* samples_8,
                      double* clearance_8);

}  // namespace sidestep::planner::obstacle_kernels
