#include "sidestep/import/cover_front.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sidestep/import/greedy_cover.h"
#include "sidestep/import/shrink_cover.h"
#include "sidestep/import/solid_cells.h"
#include "sidestep/import/sphere_union.h"
#include "sidestep/import/surface_points.h"
#include "sidestep/import/uncovered.h"
#include "sidestep/sdf/map/distance_transform.h"

namespace sidestep::imports {
namespace {

constexpr double kSurfacePoints = 3000;  // about
constexpr double kCoarser = 1.6;         // are those for the first choice
constexpr int kCellsAlong = 48;
constexpr int kCandidates = 4000;  // about, inside
constexpr int kSteps = 200;        // of a descent
constexpr int kRemovals = 2;       // tried for each number of spheres
constexpr int kFew = 8;            // spheres, of which each is tried
constexpr int kRounds = 3;         // of looking for what sticks out, and pulling it in
// In them: of the tolerance, what is aimed at, and what counts as sticking out; and how far spheres
// move at first, of their radii.
constexpr double kAimed = 0.98, kSeen = 0.99, kNudge = 0.01;
constexpr double kWorthwhile = 0.985;  // of the volume with fewer spheres: more are of no use
constexpr int kRoughSlices = 60, kFineSlices = 150;

class Search {
 public:
  explicit Search(const CoverTask& task)
      : task_(task),
        apart_m_(std::sqrt(Area_m2(task.meshes) / kSurfacePoints)),
        points_(SurfacePoints(task.meshes, apart_m_)),
        best_(static_cast<std::size_t>(task.most_spheres) + 1,
              {{}, std::numeric_limits<double>::infinity()}) {}

  CoverFront Run() {
    Begin();
    for (int count = task_.most_spheres; count > 1; --count) TakeOneAway(Best(count).spheres);
    // Few spheres are tried more thoroughly: they are quick, and what most links end with.
    const int few = std::min(kFew, task_.most_spheres);
    for (int count = 1; count < few; ++count) SplitOne(Best(count).spheres);
    for (int count = few; count > 1; --count) TakeOneAway(Best(count).spheres);
    CoverFront front;
    double least = std::numeric_limits<double>::infinity();  // before it is finished
    for (int count = 1; count <= task_.most_spheres; ++count) {
      if (!(Best(count).volume_m3 < kWorthwhile * least)) continue;
      least = Best(count).volume_m3;
      SphereCover cover = Finish(Best(count).spheres);
      if (front.empty() || cover.volume_m3 < front.back().volume_m3) {
        front.push_back(std::move(cover));
      }
    }
    return front;
  }

 private:
  SphereCover& Best(int count) { return best_[static_cast<std::size_t>(count)]; }

  void Keep(std::vector<CoverSphere> spheres) {
    const double volume = UnionVolume_m3(spheres, kFineSlices);
    SphereCover& best = Best(static_cast<int>(spheres.size()));
    if (volume < best.volume_m3) best = {std::move(spheres), volume};
  }

  // Covers by balls that stand out more and more, until one ball is enough.
  void Begin() {
    const CoverCandidates candidates = Candidates();
    const Eigen::Matrix3Xd few_points = SurfacePoints(task_.meshes, kCoarser * apart_m_);
    for (double out_m = task_.cover_m / 4;; out_m *= 1.5) {
      const std::vector<CoverSphere> balls =
          GreedyCover(candidates, few_points, task_.cover_m, out_m, task_.most_spheres);
      if (balls.empty()) continue;
      Keep(ShrinkCover(points_, task_.cover_m, balls, kSteps));
      if (balls.size() <= 2) break;
    }
  }

  // Centres of cells inside, as deep as the exact distance transform says, and, since what is thin
  // has no cells inside, points of the surface.
  CoverCandidates Candidates() const {
    const SolidCells cells = FillCells(task_.meshes, kCellsAlong);
    const sdf::SdfGrid distance = sdf::ComputeSignedDistance(cells.grid);
    const Eigen::Matrix3Xd thin = SurfacePoints(task_.meshes, 3 * apart_m_);
    const std::size_t stride = cells.grid.CountFilled() / kCandidates + 1;
    std::vector<std::size_t> inside;
    std::size_t number = 0;
    for (std::size_t cell = 0; cell < cells.grid.cells.size(); ++cell) {
      if (cells.grid.cells[cell] != 0 && number++ % stride == 0) inside.push_back(cell);
    }
    CoverCandidates candidates;
    const auto num_inside = static_cast<Eigen::Index>(inside.size());
    candidates.centers_m.resize(3, num_inside + thin.cols());
    candidates.depth_m.setZero(num_inside + thin.cols());
    for (Eigen::Index i = 0; i < num_inside; ++i) {
      const std::size_t cell = inside[static_cast<std::size_t>(i)];
      candidates.centers_m.col(i) = cells.grid.spec.CenterOf(cell);
      candidates.depth_m[i] = -static_cast<double>(distance.distance_m()[cell]);
    }
    candidates.centers_m.rightCols(thin.cols()) = thin;
    return candidates;
  }

  // Tries to do without those spheres whose place the others take with the least volume.
  void TakeOneAway(const std::vector<CoverSphere>& spheres) {
    if (spheres.size() < 2) return;
    std::vector<std::pair<double, std::vector<CoverSphere>>> without;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      std::vector<CoverSphere> rest = spheres;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
      rest = ShrinkCover(points_, task_.cover_m, rest, 0);
      const double volume = UnionVolume_m3(rest, kRoughSlices);
      without.emplace_back(volume, std::move(rest));
    }
    std::stable_sort(without.begin(), without.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    const std::size_t tries = static_cast<int>(spheres.size()) <= kFew ? kFew : kRemovals;
    for (std::size_t i = 0; i < without.size() && i < tries; ++i) {
      Keep(ShrinkCover(points_, task_.cover_m, without[i].second, kSteps));
    }
  }

  // Tries to put two spheres in the place of one, for each, along the longest way through it.
  void SplitOne(const std::vector<CoverSphere>& spheres) {
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      const CoverSphere& sphere = spheres[i];
      const double reach_m = sphere.radius_m + task_.cover_m;
      Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
      for (const auto& p : points_.colwise()) {
        const Eigen::Vector3d off = p - sphere.center_m;
        if (off.squaredNorm() <= reach_m * reach_m) spread += off * off.transpose();
      }
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
      const Eigen::Vector3d aside = sphere.radius_m / 2 * axes.eigenvectors().col(2);
      std::vector<CoverSphere> more = spheres;
      more[i].center_m += aside;
      more.push_back({sphere.center_m - aside, sphere.radius_m});
      Keep(ShrinkCover(points_, task_.cover_m, more, kSteps));
    }
  }

  // Looks where the cover of points leaves out what is between them, and makes sure of all.
  SphereCover Finish(std::vector<CoverSphere> spheres) const {
    const double cover_m = kAimed * task_.cover_m;
    Eigen::Matrix3Xd points = points_;
    for (int round = 0; round < kRounds; ++round) {
      const Eigen::Matrix3Xd outside =
          FindOutside(task_.meshes, spheres, kSeen * task_.cover_m, apart_m_ / 3);
      if (outside.cols() == 0) break;
      points.conservativeResize(3, points.cols() + outside.cols());
      points.rightCols(outside.cols()) = outside;

      spheres = ShrinkCover(points, cover_m, spheres, kSteps, kNudge);
    }
    for (CoverSphere& sphere : spheres) {
      for (double& x : sphere.center_m) x = std::round(x * task_.steps_per_m) / task_.steps_per_m;
      const double steps = std::floor(sphere.radius_m * task_.steps_per_m);
      sphere.radius_m = std::max(1.0, steps) / task_.steps_per_m;
    }
    GrowToCover(task_.meshes, task_.cover_m, task_.steps_per_m, &spheres);

    return {spheres, UnionVolume_m3(spheres)};
  }

  const CoverTask& task_;
  double apart_m_;
  Eigen::Matrix3Xd points_;
  std::vector<SphereCover> best_;  // of each number of spheres
};

}  // namespace

CoverFront FindCovers(const CoverTask& task) { return Search(task).Run(); }

}  // namespace sidestep::imports
