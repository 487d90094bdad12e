#include "sidestep/import/sphere_cover.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "sidestep/import/closed_mesh.h"
#include "sidestep/import/cover_front.h"
#include "sidestep/import/outer_mesh.h"
#include "sidestep/import/solid_cells.h"
#include "sidestep/import/sphere_union.h"
#include "sidestep/import/uncovered.h"

namespace sidestep::imports {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kVolumeCells = 200;        // along the longest edge; good for 1e-3 of the volume
constexpr double kMeshShare = 0.01;      // of the tolerance: what meshes around shapes stand out
constexpr double kPromiseShare = 0.997;  // of it: what is left is for who checks with limited means

std::vector<TriangleMesh> MeshesOf(const LinkSolids& solids, double tolerance_m) {
  std::vector<TriangleMesh> meshes;
  for (const PlacedShape& shape : solids.shapes) meshes.push_back(OuterMesh(shape, tolerance_m));
  for (const NamedMesh& solid : solids.meshes) {
    CheckClosed(solid);
    meshes.push_back(solid.mesh);
  }
  return meshes;
}

double Extent(const std::vector<TriangleMesh>& meshes) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(kInfinity), high = -low;
  for (const TriangleMesh& mesh : meshes) {
    low = low.cwiseMin(mesh.vertices.rowwise().minCoeff());
    high = high.cwiseMax(mesh.vertices.rowwise().maxCoeff());
  }
  return (high - low).maxCoeff();
}

// The power of ten that is a hundredth of the tolerance, or up to ten times finer, as how many
// there are to a metre.
double StepsPerMetre(double cover_m) { return std::pow(10, 2 - std::floor(std::log10(cover_m))); }

// The covers of all links within one tolerance, and how to choose one of each.
class CoverChoice {
 public:
  CoverChoice(const std::vector<LinkSolids>& links, double cover_m, int most_spheres)
      : cover_m_(cover_m) {
    for (const LinkSolids& link : links) {
      if (link.shapes.empty() && link.meshes.empty()) {
        fronts_.emplace_back();
        continue;
      }
      fronts_.push_back(
          FindCovers({MeshesOf(link, kMeshShare * cover_m), kPromiseShare * cover_m,
                      std::min(most_spheres, kMostSpheresOfALink), StepsPerMetre(cover_m)}));
    }
    FillTable();
  }

  double cover_m() const { return cover_m_; }
  /// The fewest spheres of all links whose volume is at most that; none: -1.
  int Fewest(double most_m3) const {
    const auto found = std::find_if(least_.begin(), least_.end(),
                                    [most_m3](double volume) { return volume <= most_m3; });
    return found == least_.end() ? -1 : static_cast<int>(found - least_.begin());
  }
  /// Of at most so many spheres, how many have the least volume.
  int LeastVoluminous(int num_spheres) const {
    const auto end = least_.begin() +
                     std::min<std::ptrdiff_t>(num_spheres + std::ptrdiff_t{1}, std::ssize(least_));
    return static_cast<int>(std::min_element(least_.begin(), end) - least_.begin());
  }
  int most() const { return static_cast<int>(least_.size()) - 1; }

  /// The covers that make up the least volume with so many spheres in all.
  std::vector<LinkCover> Take(int num_spheres) const {
    std::vector<LinkCover> links(fronts_.size());
    auto left = static_cast<std::size_t>(num_spheres);
    for (std::size_t link = fronts_.size(); link-- > 0;) {
      if (fronts_[link].empty()) continue;
      const SphereCover& cover = fronts_[link][chosen_[link][left]];
      links[link].spheres = cover.spheres;
      links[link].sphere_m3 = cover.volume_m3;
      left -= cover.spheres.size();
    }
    return links;
  }

 private:
  // By the number of spheres of the links so far, the least volume, and which cover of the last one
  // that takes.
  void FillTable() {
    least_ = {0};
    for (const CoverFront& front : fronts_) {
      chosen_.emplace_back();
      if (front.empty()) continue;
      std::size_t largest = 0;
      for (const SphereCover& cover : front) largest = std::max(largest, cover.spheres.size());
      std::vector<double> next(least_.size() + largest, kInfinity);
      chosen_.back().assign(next.size(), 0);
      for (std::size_t before = 0; before < least_.size(); ++before) {
        for (std::size_t i = 0; i < front.size(); ++i) {
          const std::size_t count = before + front[i].spheres.size();
          const double volume = least_[before] + front[i].volume_m3;
          if (volume >= next[count]) continue;
          next[count] = volume;
          chosen_.back()[count] = i;
        }
      }
      least_ = std::move(next);
    }
  }

  double cover_m_;
  std::vector<CoverFront> fronts_;                // of each link; empty without solids
  std::vector<double> least_;                     // by the number of spheres of all
  std::vector<std::vector<std::size_t>> chosen_;  // of each link, by the number of it and before it
};

void CheckRequest(const std::vector<LinkSolids>& links, const CoverRequest& request) {
  const auto is_good = [](double value) { return std::isfinite(value) && value >= 0; };
  if (!is_good(request.cover_m) || !is_good(request.max_excess) || request.num_spheres < 0) {
    throw std::invalid_argument("CoverLinks: a number that is negative or not finite");
  }
  if (request.cover_m == 0 && request.num_spheres == 0) {
    throw std::invalid_argument("CoverLinks: neither a tolerance nor a number of spheres");
  }
  const auto num_solid = std::count_if(links.begin(), links.end(), [](const LinkSolids& link) {
    return !link.shapes.empty() || !link.meshes.empty();
  });
  if (request.num_spheres > 0 && request.num_spheres < num_solid) {
    throw std::invalid_argument("CoverLinks: " + std::to_string(request.num_spheres) +
                                " spheres for " + std::to_string(num_solid) + " links");
  }
}

// The smallest tolerance, to a few percent, within which so many spheres are enough.
CoverChoice NearestWith(const std::vector<LinkSolids>& links, int num_spheres, double most_m3,
                        double largest_m) {
  constexpr double kFirst = 0.02;  // of the largest link
  constexpr int kHalvings = 4, kMostDoublings = 20;
  const auto is_enough = [&](const CoverChoice& choice) {
    const int fewest = choice.Fewest(most_m3);
    return fewest >= 0 && fewest <= num_spheres;
  };
  double low = kFirst * largest_m, high = low;
  CoverChoice best(links, high, num_spheres);
  if (is_enough(best)) {
    for (int i = 0; i < kMostDoublings; ++i) {
      low = high / 2;
      CoverChoice finer(links, low, num_spheres);
      if (!is_enough(finer)) break;
      best = std::move(finer);
      high = low;
    }
  } else {
    for (int i = 0; i < kMostDoublings && !is_enough(best); ++i) {
      low = high;
      high *= 2;
      best = CoverChoice(links, high, num_spheres);
    }
  }
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = std::sqrt(low * high);
    CoverChoice finer(links, middle, num_spheres);
    (is_enough(finer) ? high : low) = middle;
    if (high == middle) best = std::move(finer);
  }
  return best;
}

}  // namespace

int RobotCover::num_spheres() const {
  int count = 0;
  for (const LinkCover& link : links) count += static_cast<int>(link.spheres.size());
  return count;
}

double RobotCover::excess() const {
  double solid = 0, sphere = 0;
  for (const LinkCover& link : links) {
    solid += link.solid_m3;
    sphere += link.sphere_m3;
  }
  return sphere / solid - 1;
}

RobotCover CoverLinks(const std::vector<LinkSolids>& links, const CoverRequest& request) {
  CheckRequest(links, request);
  std::vector<double> solid_m3;
  double all_m3 = 0, largest_m = 0;
  for (const LinkSolids& link : links) {
    solid_m3.push_back(0);
    if (link.shapes.empty() && link.meshes.empty()) continue;
    const double extent = Extent(MeshesOf(link, kInfinity));
    const std::vector<TriangleMesh> meshes = MeshesOf(link, 1e-4 * extent);
    solid_m3.back() = FillCells(meshes, kVolumeCells).volume_m3;
    all_m3 += solid_m3.back();
    largest_m = std::max(largest_m, extent);
  }
  if (all_m3 == 0) return {request.cover_m, std::vector<LinkCover>(links.size())};
  const double most_m3 = (1 + request.max_excess) * all_m3;
  const int most = request.num_spheres > 0 ? request.num_spheres : kMostSpheresOfALink;
  const CoverChoice choice = request.cover_m > 0
                                 ? CoverChoice(links, request.cover_m, most)
                                 : NearestWith(links, request.num_spheres, most_m3, largest_m);
  int count = choice.Fewest(most_m3);
  if (request.num_spheres > 0) {
    count = choice.LeastVoluminous(request.num_spheres);
  } else if (count < 0) {
    count = choice.LeastVoluminous(choice.most());
  }
  RobotCover cover{choice.cover_m(), choice.Take(count)};
  for (std::size_t i = 0; i < links.size(); ++i) cover.links[i].solid_m3 = solid_m3[i];
  return cover;
}

CoverCheck CheckCover(const LinkSolids& solids, const std::vector<CoverSphere>& spheres,
                      double precision_m) {
  const std::vector<TriangleMesh> meshes = MeshesOf(solids, precision_m / 2);
  if (meshes.empty()) throw std::invalid_argument("CheckCover: a link without solids");
  CoverCheck check;
  check.uncovered_m = kInfinity;
  check.solid_m3 = FillCells(meshes, kVolumeCells).volume_m3;
  if (spheres.empty()) return check;
  check.sphere_m3 = UnionVolume_m3(spheres);
  check.uncovered_m = -kInfinity;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const Uncovered uncovered = FindUncovered({meshes[i]}, spheres, precision_m / 2);
    if (uncovered.at_most_m <= check.uncovered_m) continue;
    check.uncovered_m = uncovered.at_most_m;
    check.p_m = uncovered.p_m;
    check.on_shape = i < solids.shapes.size();
    check.solid = check.on_shape ? i : i - solids.shapes.size();
  }
  return check;
}

}  // namespace sidestep::imports
