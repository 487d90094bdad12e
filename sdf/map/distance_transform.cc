#include "sdf/map/distance_transform.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sidestep {
namespace {

// All lengths here are in half cells, so that cell centres lie at even numbers and faces at odd
// ones, and all squares are exact integers.

std::int32_t Square(std::int32_t x) { return x * x; }

// The lower envelope of parabolas  height + (x - position)^2  over a run of cell centres.
class LowerEnvelope {
 public:
  explicit LowerEnvelope(int max_sites) : pieces_(static_cast<std::size_t>(max_sites)) {}

  // Begins the envelope over the cells first ... last.
  void Begin(int first, int last) {
    first_ = first;
    last_ = last;
    count_ = 0;
  }

  // Adds a parabola. Positions must increase from call to call. Of two parabolas the one further
  // right wins from some point on, so the new one takes over a tail of the envelope, or nothing.
  void Add(std::int32_t position, std::int32_t height) {
    const Piece added{position, height, first_};
    while (count_ > 0 && Value(added, Top().from) <= Value(Top(), Top().from)) --count_;
    if (count_ == 0) {
      pieces_[count_++] = added;
    } else if (Value(added, last_) < Value(Top(), last_)) {
      // It loses where the top begins and wins at the end; the first cell i >= crossing is where
      // 4 i (position - top) >= the difference of  height + position^2.
      const std::int32_t rise = height - Top().height + Square(position) - Square(Top().position);
      const std::int32_t run = 4 * (position - Top().position);
      pieces_[count_++] = {position, height, (rise + run - 1) / run};
    }
  }

  // Calls visit(cell, value) for the cells of the run; not at all if nothing was added.
  template <class Visitor>
  void ForEachCell(const Visitor& visit) const {
    for (std::size_t p = 0; p < count_; ++p) {
      const int end = p + 1 < count_ ? pieces_[p + 1].from : last_ + 1;
      for (int i = pieces_[p].from; i < end; ++i) visit(i, Value(pieces_[p], i));
    }
  }

 private:
  struct Piece {
    std::int32_t position;
    std::int32_t height;
    int from;  // the first cell where this piece is lowest
  };
  static std::int32_t Value(const Piece& piece, int cell) {
    return piece.height + Square(2 * cell - piece.position);
  }
  const Piece& Top() const { return pieces_[count_ - 1]; }

  std::vector<Piece> pieces_;
  std::size_t count_ = 0;
  int first_ = 0;
  int last_ = 0;
};

// Transforms the squares of one line of cells: on entry those over the axes done so far, on return
// those over this axis too.
//
// Within a run of cells of one kind, the way to the nearest cell of the other kind either starts
// with a step along the line to another cell of the run, or to the first cell beyond the run's
// ends: nothing further away can be nearer, since that cell is itself of the other kind.
class LineTransform {
 public:
  LineTransform(DistanceConvention convention, int max_length)
      : convention_(convention), envelope_(max_length + 2) {}

  void operator()(const std::uint8_t* filled, std::int32_t* squares, int length) {
    for (int first = 0; first < length;) {
      int last = first;
      while (last + 1 < length && (filled[last + 1] != 0) == (filled[first] != 0)) ++last;
      envelope_.Begin(first, last);
      const bool ends_left = first > 0;
      const bool ends_right = last + 1 < length;
      if (convention_ == DistanceConvention::kBwdist) {
        AddCentres(squares, first, last, ends_left, ends_right);
      } else {
        AddFaces(squares, first, last, ends_left, ends_right);
      }
      envelope_.ForEachCell(
          [&](int i, std::int32_t value) { squares[i] = std::min(squares[i], value); });
      first = last + 1;
    }
  }

 private:
  void AddCentres(const std::int32_t* squares, int first, int last, bool ends_left,
                  bool ends_right) {
    if (ends_left) envelope_.Add(2 * first - 2, 0);
    for (int i = first; i <= last; ++i) {
      if (squares[i] != kNoOtherCell) envelope_.Add(2 * i, squares[i]);
    }
    if (ends_right) envelope_.Add(2 * last + 2, 0);
  }

  // The distance along one axis from a centre to another cell's cube is that to its nearer face,
  // and zero within the same cell. So the faces are the sites, each as low as the lower of the two
  // cells it parts, and a cell's own square (the final min) stands for the zero.
  void AddFaces(const std::int32_t* squares, int first, int last, bool ends_left, bool ends_right) {
    if (ends_left) envelope_.Add(2 * first - 1, 0);
    for (int i = first; i < last; ++i) {
      const std::int32_t height = std::min(squares[i], squares[i + 1]);
      if (height != kNoOtherCell) envelope_.Add(2 * i + 1, height);
    }
    if (ends_right) envelope_.Add(2 * last + 1, 0);
  }

  DistanceConvention convention_;
  LowerEnvelope envelope_;
};

// Transforms all lines along an axis other than x. Lines are gathered by blocks of neighbours in x,
// because one at a time would touch a cache line for each single cell.
class StridedPass {
 public:
  StridedPass(const OccupancyGrid& occupancy, std::vector<std::int32_t>& squares)
      : occupancy_(occupancy), squares_(squares) {}

  void Run(LineTransform& transform, int length, std::size_t stride, int num_planes,
           std::size_t plane_stride) {
    const std::size_t n = static_cast<std::size_t>(length);
    filled_.resize(kBlock * n);
    lines_.resize(kBlock * n);
    const std::size_t width = static_cast<std::size_t>(occupancy_.spec.size[0]);
    for (int plane = 0; plane < num_planes; ++plane) {
      for (std::size_t x = 0; x < width; x += kBlock) {
        const std::size_t block = std::min(kBlock, width - x);
        const std::size_t base = static_cast<std::size_t>(plane) * plane_stride + x;
        for (std::size_t i = 0; i < n; ++i) {
          for (std::size_t b = 0; b < block; ++b) {
            filled_[b * n + i] = occupancy_.cells[base + i * stride + b];
            lines_[b * n + i] = squares_[base + i * stride + b];
          }
        }
        for (std::size_t b = 0; b < block; ++b) transform(&filled_[b * n], &lines_[b * n], length);
        for (std::size_t i = 0; i < n; ++i) {
          for (std::size_t b = 0; b < block; ++b) {
            squares_[base + i * stride + b] = lines_[b * n + i];
          }
        }
      }
    }
  }

 private:
  static constexpr std::size_t kBlock = 16;  // int32 values in a cache line

  const OccupancyGrid& occupancy_;
  std::vector<std::int32_t>& squares_;
  std::vector<std::uint8_t> filled_;
  std::vector<std::int32_t> lines_;
};

void CheckInput(const OccupancyGrid& occupancy) {
  CheckGridSpec(occupancy.spec);
  if (occupancy.cells.size() != occupancy.spec.num_cells()) {
    throw std::invalid_argument("distance transform: needs one value a cell");
  }
  double diagonal_squared = 0;  // [cells^2]; in half cells it is 4 times that, below 2^30
  for (const int size : occupancy.spec.size) diagonal_squared += std::pow(size + 1.0, 2);
  if (diagonal_squared > std::pow(2.0, 28)) {
    throw std::invalid_argument("distance transform: squares of this grid overflow 32 bits");
  }
}

}  // namespace

std::vector<std::int32_t> ComputeSquaredDistance(const OccupancyGrid& occupancy,
                                                 DistanceConvention convention) {
  CheckInput(occupancy);
  const auto [nx, ny, nz] = occupancy.spec.size;
  const std::size_t row = static_cast<std::size_t>(nx);
  const std::size_t slice = row * static_cast<std::size_t>(ny);
  std::vector<std::int32_t> squares(occupancy.cells.size(), kNoOtherCell);
  LineTransform transform(convention, std::max({nx, ny, nz}));
  for (std::size_t begin = 0; begin < squares.size(); begin += row) {
    transform(&occupancy.cells[begin], &squares[begin], nx);
  }
  StridedPass pass(occupancy, squares);
  pass.Run(transform, ny, row, nz, slice);
  pass.Run(transform, nz, slice, ny, row);
  return squares;
}

SdfGrid ComputeSignedDistance(const OccupancyGrid& occupancy, DistanceConvention convention) {
  const std::vector<std::int32_t> squares = ComputeSquaredDistance(occupancy, convention);
  std::vector<float> distance_m(squares.size());
  const double half_cell_m = occupancy.spec.cell_m / 2;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    // The root is rounded to float before it is scaled, as the authors' code does: with kBwdist the
    // result then has the very bits of their fields.
    const float half_cells = std::sqrt(static_cast<float>(squares[i]));
    const float distance = squares[i] == kNoOtherCell
                               ? kNoSurfaceDistance_m
                               : static_cast<float>(half_cell_m * half_cells);
    distance_m[i] = occupancy.cells[i] != 0 ? -distance : distance;
  }
  return SdfGrid(occupancy.spec, std::move(distance_m));
}

}  // namespace sidestep
