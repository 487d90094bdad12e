#include "sidestep/hardware/body_pose.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "sidestep/core/rotation_vector.h"
#include "sidestep/hardware/planar_pose.h"

namespace sidestep::hardware {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

// A corner of a tag, and where an ideal lens would have seen it.
struct Corner {
  Eigen::Vector3d p_OQ;
  Eigen::Vector2d ideal;
};

// An edge of a tag, what there is to be known: how far its middle and its ends are off across it.
struct Edge {
  std::size_t from = 0, to = 0;  // corners
  // The normal, by twice the deviations of both: (off_from + off_to) and (off_from - off_to) times
  // these are two independent errors of deviation 1.
  Eigen::RowVector2d middle, turn;
};

struct Fit {
  Pose X_CO;
  double cost = std::numeric_limits<double>::infinity();  // squares in units of their deviations
  double squares_px = 0;
  Matrix6 information = Matrix6::Zero();
};

Eigen::Matrix3d Cross(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

const TagDetection* Find(const std::vector<TagDetection>& seen, int id) {
  const auto found =
      std::find_if(seen.begin(), seen.end(), [&](const TagDetection& tag) { return tag.id == id; });
  return found == seen.end() ? nullptr : &*found;
}

// Gauss-Newton on position and rotation, damped where a step would not help.
class Refinement {
 public:
  Refinement(const robot::CameraIntrinsics& camera, const std::vector<Corner>& corners,
             const std::vector<Edge>& edges, const std::optional<RotationPrior>& prior)
      : corners_(corners), edges_(edges), focal_px_(camera.fx, camera.fy), prior_(prior) {}

  Fit Run(const Pose& start) const {
    Vector6 gradient;
    Fit fit = Evaluate(start, &gradient);
    double damping = 1e-6;
    constexpr int kMostSteps = 30;
    for (int step = 0; step < kMostSteps && std::isfinite(fit.cost); ++step) {
      Matrix6 H = fit.information;
      H.diagonal() *= 1 + damping;
      const Vector6 delta = -H.ldlt().solve(gradient);
      if (!delta.allFinite()) break;
      Vector6 next_gradient;
      const Pose moved(RotationBy(delta.tail<3>()) * fit.X_CO.rotation(),
                       fit.X_CO.translation() + delta.head<3>());
      const Fit next = Evaluate(moved, &next_gradient);
      if (!(next.cost < fit.cost)) {
        damping *= 10;
        if (damping > 1e6) break;
        continue;
      }
      const bool is_done = fit.cost - next.cost < 1e-10 * fit.cost;
      fit = next;
      gradient = next_gradient;
      damping = std::max(1e-12, damping / 10);
      if (is_done) break;
    }
    return fit;
  }

 private:
  Fit Evaluate(const Pose& X_CO, Vector6* gradient) const {
    Fit fit;
    fit.X_CO = X_CO;
    *gradient = Vector6::Zero();
    double cost = 0;
    std::vector<Eigen::Vector2d> off_px;
    std::vector<Eigen::Matrix<double, 2, 6>> J;
    for (const Corner& corner : corners_) {
      const Eigen::Vector3d p_OQ_C = X_CO.Rotate(corner.p_OQ);
      const Eigen::Vector3d p = p_OQ_C + X_CO.translation();
      if (!(p.z() > 0)) return fit;  // behind the camera
      off_px.push_back(focal_px_.cwiseProduct(p.head<2>() / p.z() - corner.ideal));
      Eigen::Matrix<double, 2, 3> J_p;
      J_p << 1 / p.z(), 0, -p.x() / (p.z() * p.z()), 0, 1 / p.z(), -p.y() / (p.z() * p.z());
      J_p = focal_px_.asDiagonal() * J_p.eval();
      J.emplace_back() << J_p, -J_p * Cross(p_OQ_C);
      fit.squares_px += off_px.back().squaredNorm();
    }
    for (const Edge& edge : edges_) {
      Eigen::Vector2d off;
      off << edge.middle * (off_px[edge.from] + off_px[edge.to]),
          edge.turn * (off_px[edge.from] - off_px[edge.to]);
      Eigen::Matrix<double, 2, 6> J_edge;
      J_edge << edge.middle * (J[edge.from] + J[edge.to]), edge.turn * (J[edge.from] - J[edge.to]);
      cost += off.squaredNorm();
      fit.information += J_edge.transpose() * J_edge;
      *gradient += J_edge.transpose() * off;
    }
    if (prior_) {
      const double weight = 1 / (prior_->sigma_rad * prior_->sigma_rad);
      const Eigen::Vector3d turn = RotationVector(X_CO.rotation() * prior_->R_CO.conjugate());
      cost += weight * turn.squaredNorm();
      gradient->tail<3>() += weight * turn;
      fit.information.bottomRightCorner<3, 3>().diagonal().array() += weight;
    }
    fit.cost = cost;
    return fit;
  }

  const std::vector<Corner>& corners_;
  const std::vector<Edge>& edges_;
  Eigen::Vector2d focal_px_;
  std::optional<RotationPrior> prior_;
};

// What the sum of so many squares of normal errors exceeds once in a hundred times. Source: the
// approximation of Wilson & Hilferty, PNAS 17(12):684-688, 1931.
double RareSquares(double freedom) {
  constexpr double kRare = 2.326;
  const double spread = 2 / (9 * freedom);
  return freedom * std::pow(1 - spread + kRare * std::sqrt(spread), 3);
}

// What a line that is laid through n even places keeps of a wave of variance 1 and any phase, by
// which they err, so many waves from one to the next: the variances of its middle and of its ends
// beyond that. The ends are one step beyond the last places.
Eigen::Vector2d LeftOfWave(double n, double waves) {
  double middle = 0, turn = 0;
  for (int k = 0; k < static_cast<int>(n); ++k) {
    const double place = k - (n - 1) / 2;
    const double angle = 2 * std::numbers::pi * waves * place;
    middle += std::cos(angle) / n;
    turn += 6 * place / (n * (n - 1)) * std::sin(angle);
  }
  return {middle * middle, turn * turn};
}

// The four of a tag, whose first corner is this one.
void AppendEdges(const Eigen::Matrix<double, 2, 4>& corners_px, std::size_t first_corner,
                 double sigma_px, std::vector<Edge>* edges) {
  for (int k = 0; k < 4; ++k) {
    const int next = (k + 1) % 4;
    const Eigen::Vector2d from = corners_px.col(k), to = corners_px.col(next);
    const EdgeErrors errors = ErrorsOfEdge(from, to, sigma_px);
    const Eigen::Vector2d along = (to - from).normalized();
    const Eigen::RowVector2d normal(along.y(), -along.x());
    edges->push_back({first_corner + static_cast<std::size_t>(k),
                      first_corner + static_cast<std::size_t>(next),
                      normal / (2 * errors.middle_px), normal / (2 * errors.turn_px)});
  }
}

}  // namespace

EdgeErrors ErrorsOfEdge(const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px,
                        double sigma_px) {
  constexpr double kLeastPlaces = 16, kApart_px = 8;
  constexpr double kRows = 2.4, kSlopes = 20, kColumns = 0.4;  // shares of sigma
  const Eigen::Vector2d span = (to_px - from_px).cwiseAbs();
  const double n = std::max(kLeastPlaces, std::floor(span.norm() / kApart_px));
  const double along_px = span.maxCoeff() / (n + 1), across_px = span.minCoeff() / (n + 1);
  const double rows = kRows / (1 + kSlopes * across_px / along_px);
  const Eigen::Vector2d variance = Eigen::Vector2d(1, 3 * (n + 1) / (n - 1)) / n +
                                   rows * rows * LeftOfWave(n, 2 * across_px) +
                                   kColumns * kColumns * LeftOfWave(n, along_px);
  return {sigma_px * std::sqrt(variance(0)), sigma_px * std::sqrt(variance(1))};
}

std::optional<BodyPose> LocateBody(const robot::CameraIntrinsics& camera, const TaggedBody& body,
                                   const std::vector<TagDetection>& seen, double edge_sigma_px,
                                   const std::optional<RotationPrior>& prior) {
  std::vector<Corner> corners;
  std::vector<Edge> edges;
  const BodyTag* largest = nullptr;
  Eigen::Matrix<double, 2, 4> corners_of_largest;
  double largest_px = 0;
  int num_tags = 0;
  for (const BodyTag& tag : body.tags) {
    const TagDetection* const found = Find(seen, tag.id);
    if (found == nullptr) continue;
    Eigen::Matrix<double, 2, 4> ideal;
    for (int k = 0; k < 4; ++k) ideal.col(k) = robot::Unproject(camera, found->corners_px.col(k));
    if (!ideal.allFinite()) return std::nullopt;
    const Eigen::Matrix<double, 3, 4> p_TQ = CornersOfTag(tag.size_m);
    AppendEdges(found->corners_px, corners.size(), edge_sigma_px, &edges);
    for (int k = 0; k < 4; ++k) corners.push_back({tag.X_OT * p_TQ.col(k), ideal.col(k)});
    ++num_tags;
    if (found->shortest_edge_px() > largest_px) {
      largest = &tag;
      largest_px = found->shortest_edge_px();
      corners_of_largest = ideal;
    }
  }
  if (largest == nullptr) return std::nullopt;
  const Refinement refinement(camera, corners, edges, prior);
  const std::array<Pose, 2> starts = PosesOfSquare(corners_of_largest, largest->size_m);
  const Pose X_TO = largest->X_OT.Inverse();
  Fit best = refinement.Run(starts[0] * X_TO), other = refinement.Run(starts[1] * X_TO);
  if (other.cost < best.cost) std::swap(best, other);
  if (!std::isfinite(best.cost)) return std::nullopt;

  BodyPose pose;
  pose.X_CO = best.X_CO;
  pose.num_tags = num_tags;
  pose.reprojection_px = std::sqrt(best.squares_px / (2.0 * static_cast<double>(corners.size())));
  // Now and then an edge is mistaken by many times its error: where the detector's first guess of
  // it was so far off that it did not see both of its sides.
  const double freedom = 8.0 * num_tags - 6 + (prior ? 3 : 0);
  pose.covariance = std::max(1.0, best.cost / RareSquares(freedom)) *
                    best.information.ldlt().solve(Matrix6::Identity());
  constexpr double kSame_rad = 1e-3;
  Vector6 apart;
  apart << other.X_CO.translation() - best.X_CO.translation(),
      RotationVector(other.X_CO.rotation() * best.X_CO.rotation().conjugate());
  if (std::isfinite(other.cost) && apart.tail<3>().norm() > kSame_rad) {
    pose.ambiguity = std::exp((best.cost - other.cost) / 2);
    pose.covariance += pose.ambiguity / (1 + pose.ambiguity) * apart * apart.transpose();
  }
  if (!pose.covariance.allFinite()) return std::nullopt;
  return pose;
}

}  // namespace sidestep::hardware
