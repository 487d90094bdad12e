#include "sidestep/sdf/map/scan_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sidestep/sdf/map/cells_near.h"

namespace sidestep::sdf {
namespace {

struct Word {
  UnseenSpace unseen;
  const char* word;
};
constexpr Word kWords[] = {{UnseenSpace::kFree, "free"},
                           {UnseenSpace::kFilled, "filled"},
                           {UnseenSpace::kRemembered, "remembered"}};

// The part of the line that is in the box of the grid's cells, as two numbers from 0 (start) to 1
// (end); empty if the first is not less than the second.
std::array<double, 2> PartInGrid(const GridSpec& grid, const Eigen::Vector3d& start,
                                 const Eigen::Vector3d& way) {
  double first = 0, last = 1;
  for (int a = 0; a < 3; ++a) {
    const double lower = grid.first_center_m(a) - grid.cell_m / 2;
    const double upper = lower + grid.cell_m * grid.size[static_cast<std::size_t>(a)];
    if (way(a) == 0) {
      if (start(a) < lower || start(a) >= upper) return {1, 0};
      continue;
    }
    const double to_lower = (lower - start(a)) / way(a), to_upper = (upper - start(a)) / way(a);
    first = std::max(first, std::min(to_lower, to_upper));
    last = std::min(last, std::max(to_lower, to_upper));
  }
  return {first, last};
}

}  // namespace

std::string ToString(UnseenSpace unseen) {
  for (const Word& entry : kWords) {
    if (entry.unseen == unseen) return entry.word;
  }
  throw std::invalid_argument("not a kind of unseen space");
}

UnseenSpace UnseenSpaceFromString(const std::string& word) {
  for (const Word& entry : kWords) {
    if (entry.word == word) return entry.unseen;
  }
  throw std::invalid_argument("unknown unseen space '" + word +
                              "'; there are: free, filled, remembered");
}

void VisitCellsOnTheWay(const GridSpec& grid, const Eigen::Vector3d& start,
                        const Eigen::Vector3d& end, std::vector<std::size_t>* cells) {
  const Eigen::Vector3d way = end - start;
  const auto [first, last] = PartInGrid(grid, start, way);
  if (!(first < last)) return;
  const std::array<int, 3> end_cell = grid.CellOf(end);
  std::array<int, 3> cell = grid.CellOf(start + first * way);
  std::array<int, 3> step;
  std::array<double, 3> next,
      length;  // of the line, as parts of it: to the next face, to cross one
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    cell[a] = std::clamp(cell[a], 0, grid.size[a] - 1);  // rounding, where the line enters
    step[a] = way(axis) > 0 ? 1 : -1;
    const double face = grid.first_center_m(axis) + grid.cell_m * (cell[a] + 0.5 * step[a]);
    const bool moves = way(axis) != 0;
    next[a] = moves ? (face - start(axis)) / way(axis) : std::numeric_limits<double>::infinity();
    length[a] = moves ? grid.cell_m / std::abs(way(axis)) : std::numeric_limits<double>::infinity();
  }
  while (grid.Contains(cell[0], cell[1], cell[2]) && cell != end_cell) {
    cells->push_back(grid.Index(cell[0], cell[1], cell[2]));
    const auto a =
        static_cast<std::size_t>(std::min_element(next.begin(), next.end()) - next.begin());
    if (!(next[a] < last)) return;
    cell[a] += step[a];
    next[a] += length[a];
  }
}

ScanMap::ScanMap(const GridSpec& grid_W, UnseenSpace unseen)
    : unseen_(unseen), rasteriser_(grid_W), map_(grid_W) {
  FillUnseen();
}

void ScanMap::FillUnseen() {
  const bool is_filled = unseen_ == UnseenSpace::kFilled;
  std::fill(map_.cells.begin(), map_.cells.end(), std::uint8_t{is_filled});
}

const OccupancyGrid& ScanMap::Update(const Scan& scan) {
  const OccupancyGrid& hits = rasteriser_.Fill(scan);
  seen_.clear();
  if (scan.kind == ScanKind::kSolid) return hits;
  seen_.assign(map_.cells.size(), 0);
  if (unseen_ != UnseenSpace::kRemembered) FillUnseen();
  std::vector<std::size_t> seen_free;
  for (const Eigen::Matrix3Xd* const ends : {&scan.p_CP, &scan.p_CFree}) {
    for (Eigen::Index n = 0; n < ends->cols(); ++n) {
      const Eigen::Vector3d p_WEnd = scan.X_WC * ends->col(n);
      if (!p_WEnd.allFinite()) continue;
      seen_free.clear();
      VisitCellsOnTheWay(map_.spec, scan.X_WC.translation(), p_WEnd, &seen_free);
      for (const std::size_t cell : seen_free) {
        map_.cells[cell] = 0;
        seen_[cell] = 1;
      }
    }
  }
  for (std::size_t cell = 0; cell < hits.cells.size(); ++cell) {
    if (hits.cells[cell] != 0) map_.cells[cell] = seen_[cell] = 1;
  }
  return map_;
}

void FillObjects(const std::vector<ObjectObservation>& objects, CellRule rule,
                 OccupancyGrid* occupancy) {
  for (const ObjectObservation& object : objects) {
    VisitFilledCells(occupancy->spec, object.shape, object.X_WO, rule, /*skin_m=*/0,
                     [&](std::size_t cell) { occupancy->cells[cell] = 1; });
  }
}

}  // namespace sidestep::sdf
