#include "sidestep/import/greedy_cover.h"

#include <bit>
#include <cstdint>

namespace sidestep::imports {

std::vector<CoverSphere> GreedyCover(const CoverCandidates& candidates,
                                     const Eigen::Matrix3Xd& points_m, double cover_m, double out_m,
                                     int most) {
  const auto num_points = static_cast<std::size_t>(points_m.cols());
  const std::size_t num_words = (num_points + 63) / 64;
  const auto num_candidates = static_cast<std::size_t>(candidates.centers_m.cols());
  // Of each candidate, a bit a point: whether it is covered.
  std::vector<std::uint64_t> covers(num_candidates * num_words);
  for (std::size_t c = 0; c < num_candidates; ++c) {
    const auto column = static_cast<Eigen::Index>(c);
    const Eigen::Vector3d center = candidates.centers_m.col(column);
    const double reach = candidates.depth_m[column] + out_m + cover_m;
    for (std::size_t p = 0; p < num_points; ++p) {
      const bool is_covered =
          (points_m.col(static_cast<Eigen::Index>(p)) - center).squaredNorm() <= reach * reach;
      covers[c * num_words + p / 64] |= std::uint64_t{is_covered} << (p % 64);
    }
  }
  std::vector<std::uint64_t> left(num_words, ~std::uint64_t{0});
  if (num_points % 64 != 0) left.back() >>= 64 - num_points % 64;
  std::size_t num_left = num_points;
  std::vector<CoverSphere> chosen;
  while (num_left > 0) {
    std::size_t best = 0;
    int most_covered = 0;
    for (std::size_t c = 0; c < num_candidates; ++c) {
      int covered = 0;
      for (std::size_t w = 0; w < num_words; ++w) {
        covered += std::popcount(covers[c * num_words + w] & left[w]);
      }
      if (covered <= most_covered) continue;
      best = c;
      most_covered = covered;
    }
    if (most_covered == 0 || static_cast<int>(chosen.size()) == most) return {};
    for (std::size_t w = 0; w < num_words; ++w) left[w] &= ~covers[best * num_words + w];
    num_left -= static_cast<std::size_t>(most_covered);
    const auto column = static_cast<Eigen::Index>(best);
    chosen.push_back({candidates.centers_m.col(column), candidates.depth_m[column] + out_m});
  }
  return chosen;
}

}  // namespace sidestep::imports
