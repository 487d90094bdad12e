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

/// An arm and what is asked of it, ready for the kernels.
struct Arm {
  /// A robot::KinematicRow, and the spheres that stand in its frame: they end at `end_sphere` and
  /// begin where those before end; those of the base are the first.
  struct Row {
    robot::KinematicRow joint;
    int end_sphere = 0;
  };
  struct Sphere {
    std::array<double, 3> p_KS{};
  };
  /// A row that moves a sphere, and which of the coordinates that do so it follows.
  struct Mover {
    int row = 0, index = 0;
  };
  /// What moves the spheres of a row, or those of one row against those of another.
  struct Movers {
    std::vector<Mover> rows;
    std::vector<int> coordinates;  ///< ascending
  };
  struct Hinge {
    int sphere = 0;
    int movers = 0;  ///< in `movers`
    double radius_m = 0;
    double reach_m = 0;  ///< active where the field is nearer than this
  };
  struct SpherePair {
    int first = 0, second = 0;  // spheres
    double first_radius_m = 0, second_radius_m = 0;
  };
  /// What moves both links does not change their gap, and is in neither list; both lists have the
  /// same coordinates.
  struct LinkHinge {
    Movers of_first, of_second;
    std::vector<SpherePair> pairs;
  };

  int num_joints = 0;
  std::array<double, 9> R_WB{};  ///< row by row
  std::array<double, 3> p_WB{};
  int end_base_sphere = 0;
  std::vector<Row> rows;
  std::vector<Movers> movers;   ///< of the base, then of each row
  std::vector<Sphere> spheres;  ///< row by row
  std::vector<Hinge> hinges;
  std::vector<LinkHinge> link_hinges;
  double self_epsilon_m = 0;
  double inverse_sigma = 0;

  /// Numbers that are said of one configuration: its cost, its gradient, and its Hessian's lower
  /// triangle row by row.
  int num_terms() const { return 1 + num_joints + num_joints * (num_joints + 1) / 2; }
};

/// Of each row how fast its frame turns, w (3), and less the velocity of the point of it at W's
/// origin, -v (3), as its coordinate grows: z and z x o of a hinge about z through o, 0 and -z of a
/// slide.
inline constexpr std::size_t kNumbersPerAxis = 6;

/// @param q_8 n; @param axes_8 rows x 6, or null, and @param centers_8 S x 3 [m], in W, receive the
/// answer.
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
