#include "sidestep/sdf/tracking/segmentation.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace sidestep::sdf {
namespace {

// Neighbouring filled cells of one row of the grid, first <= i <= last.
struct Run {
  int first, last;
  std::size_t row;
  std::size_t parent;  // a run of the same component, never a later one
};

constexpr std::size_t kFew = 16;

bool AllFree(const std::uint8_t* filled, const std::uint8_t* left_out, std::size_t count) {
  std::uint8_t any = 0;
  for (std::size_t n = 0; n < count; ++n) {
    any |= static_cast<std::uint8_t>(filled[n] & ~left_out[n]);
  }
  return any == 0;
}

std::vector<Run> FindRuns(const OccupancyGrid& occupancy, std::span<const std::uint8_t> left_out,
                          SearchBlocks* blocks) {
  const std::span<const std::uint8_t> filled = occupancy.cells;
  const std::size_t nx = static_cast<std::size_t>(occupancy.spec.size[0]);
  std::vector<Run> runs;
  std::size_t next = 0;  // the cell that would continue the last run, 0 if there is none
  const auto add = [&](std::size_t cell) {
    if (cell == next && cell != 0) {
      ++runs.back().last;
    } else {
      const int i = static_cast<int>(cell % nx);
      runs.push_back({i, i, cell / nx, runs.size()});
    }
    const bool ends_row = runs.back().last + 1 == occupancy.spec.size[0];
    next = ends_row ? 0 : cell + 1;
  };
  for (std::size_t block = 0; block < blocks->num_blocks(); ++block) {
    if (!blocks->may_hold(block)) continue;
    const std::size_t begin = block * SearchBlocks::kCells;
    const std::size_t end = std::min(begin + SearchBlocks::kCells, filled.size());
    if (AllFree(&filled[begin], &left_out[begin], end - begin)) {
      blocks->Clear(block);
      continue;
    }
    for (std::size_t few = begin; few < end; few += kFew) {  // most of a block holds nothing
      const std::size_t few_end = std::min(few + kFew, end);
      if (AllFree(&filled[few], &left_out[few], few_end - few)) continue;
      for (std::size_t cell = few; cell < few_end; ++cell) {
        if (filled[cell] != 0 && left_out[cell] == 0) add(cell);
      }
    }
  }
  return runs;
}

// Where the runs of each row begin, and one entry more for where the last ones end.
std::vector<std::size_t> FindRowBegins(const std::vector<Run>& runs, std::size_t num_rows) {
  std::vector<std::size_t> begins(num_rows + 1, runs.size());
  for (std::size_t r = runs.size(); r-- > 0;) begins[runs[r].row] = r;
  for (std::size_t row = num_rows; row-- > 0;) begins[row] = std::min(begins[row], begins[row + 1]);
  return begins;
}

std::size_t FindRoot(std::vector<Run>& runs, std::size_t r) {
  while (runs[r].parent != r) r = runs[r].parent = runs[runs[r].parent].parent;
  return r;
}

void Join(std::vector<Run>& runs, std::size_t a, std::size_t b) {
  a = FindRoot(runs, a);
  b = FindRoot(runs, b);
  runs[std::max(a, b)].parent = std::min(a, b);
}

// Joins the runs of two neighbouring rows that touch, corners included.
void JoinRows(std::vector<Run>& runs, std::size_t a, std::size_t a_end, std::size_t b,
              std::size_t b_end) {
  while (a < a_end && b < b_end) {
    if (runs[a].first <= runs[b].last + 1 && runs[b].first <= runs[a].last + 1) Join(runs, a, b);
    // Runs of a row are at least a cell apart, so the one that ends first touches nothing further.
    runs[a].last < runs[b].last ? ++a : ++b;
  }
}

void JoinNeighbours(const GridSpec& spec, std::vector<Run>& runs) {
  const std::size_t ny = static_cast<std::size_t>(spec.size[1]);
  const std::size_t nz = static_cast<std::size_t>(spec.size[2]);
  const std::vector<std::size_t> begins = FindRowBegins(runs, ny * nz);
  for (std::size_t a = 0; a < runs.size();) {
    const std::size_t row = runs[a].row;
    const std::size_t a_end = begins[row + 1];
    const auto join_with = [&](std::size_t other) {
      JoinRows(runs, a, a_end, begins[other], begins[other + 1]);
    };
    const bool has_left = row % ny > 0;
    const bool has_right = row % ny + 1 < ny;
    if (has_left) join_with(row - 1);
    if (row >= ny) {
      if (has_left) join_with(row - ny - 1);
      join_with(row - ny);
      if (has_right) join_with(row - ny + 1);
    }
    a = a_end;
  }
}

// A component that grows by its runs.
struct Growing {
  Component component;
  std::array<std::int64_t, 3> sum = {0, 0, 0};  // of the cells' indices: exact in any order

  void Add(const Run& run, const GridSpec& spec) {
    const std::size_t ny = static_cast<std::size_t>(spec.size[1]);
    const int j = static_cast<int>(run.row % ny);
    const int k = static_cast<int>(run.row / ny);
    Component& c = component;
    if (c.cells.empty()) {
      c.first = {run.first, j, k};
      c.last = {run.last, j, k};
    }
    c.first = {std::min(c.first[0], run.first), std::min(c.first[1], j), std::min(c.first[2], k)};
    c.last = {std::max(c.last[0], run.last), std::max(c.last[1], j), std::max(c.last[2], k)};
    const std::size_t first_cell = spec.Index(run.first, j, k);
    const int count = run.last - run.first + 1;
    for (int n = 0; n < count; ++n) c.cells.push_back(first_cell + static_cast<std::size_t>(n));
    sum[0] += std::int64_t{count} * (run.first + run.last) / 2;
    sum[1] += std::int64_t{j} * count;
    sum[2] += std::int64_t{k} * count;
  }

  Component Finish(const GridSpec& spec) && {
    const Eigen::Vector3d mean =
        Eigen::Vector3d(static_cast<double>(sum[0]), static_cast<double>(sum[1]),
                        static_cast<double>(sum[2])) /
        static_cast<double>(component.cells.size());
    component.centroid_m = spec.first_center_m + spec.cell_m * mean;
    return std::move(component);
  }
};

}  // namespace

std::vector<Component> FindComponents(const OccupancyGrid& occupancy,
                                      std::span<const std::uint8_t> left_out) {
  SearchBlocks all(occupancy.cells.size());
  return FindComponents(occupancy, left_out, &all);
}

std::vector<Component> FindComponents(const OccupancyGrid& occupancy,
                                      std::span<const std::uint8_t> left_out,
                                      SearchBlocks* blocks) {
  if (left_out.size() != occupancy.cells.size()) {
    throw std::invalid_argument("FindComponents: left_out needs one byte a cell");
  }
  if (blocks->num_blocks() != SearchBlocks(left_out.size()).num_blocks()) {
    throw std::invalid_argument("FindComponents: blocks of another grid");
  }
  std::vector<Run> runs = FindRuns(occupancy, left_out, blocks);
  JoinNeighbours(occupancy.spec, runs);
  std::vector<std::size_t> number(runs.size());  // of each run's component
  std::vector<std::size_t> num_cells;            // of each component
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const std::size_t root = FindRoot(runs, r);
    if (root == r) {  // The first run of a component is its root.
      number[r] = num_cells.size();
      num_cells.push_back(0);
    }
    number[r] = number[root];
    num_cells[number[r]] += static_cast<std::size_t>(runs[r].last - runs[r].first + 1);
  }
  std::vector<Growing> growing(num_cells.size());
  for (std::size_t n = 0; n < growing.size(); ++n) growing[n].component.cells.reserve(num_cells[n]);
  for (std::size_t r = 0; r < runs.size(); ++r) growing[number[r]].Add(runs[r], occupancy.spec);
  std::vector<Component> components;
  components.reserve(growing.size());
  for (Growing& component : growing) {
    components.push_back(std::move(component).Finish(occupancy.spec));
  }
  return components;
}

std::vector<Component> FindComponents(const OccupancyGrid& occupancy) {
  return FindComponents(occupancy, std::vector<std::uint8_t>(occupancy.cells.size(), 0));
}

Component MakeComponent(std::vector<std::size_t> cells, const GridSpec& grid) {
  Component component;
  component.first = component.last = grid.CellAt(cells.front());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();  // of the cells' indices
  for (const std::size_t index : cells) {
    const std::array<int, 3> cell = grid.CellAt(index);
    for (std::size_t a = 0; a < 3; ++a) {
      component.first[a] = std::min(component.first[a], cell[a]);
      component.last[a] = std::max(component.last[a], cell[a]);
      sum(static_cast<Eigen::Index>(a)) += cell[a];
    }
  }
  component.centroid_m =
      grid.first_center_m + grid.cell_m * (sum / static_cast<double>(cells.size()));
  component.cells = std::move(cells);
  return component;
}

OccupancyGrid CutOut(const Component& component, const GridSpec& grid) {
  GridSpec spec = grid;
  spec.first_center_m = grid.Center(component.first[0], component.first[1], component.first[2]);
  for (std::size_t a = 0; a < 3; ++a) spec.size[a] = component.last[a] - component.first[a] + 1;
  OccupancyGrid shape(spec);
  for (const std::size_t index : component.cells) {
    const auto [i, j, k] = grid.CellAt(index);
    shape
        .cells[spec.Index(i - component.first[0], j - component.first[1], k - component.first[2])] =
        1;
  }
  return shape;
}

}  // namespace sidestep::sdf
