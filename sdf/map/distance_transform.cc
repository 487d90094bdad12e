#include "sidestep/sdf/map/distance_transform.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace sidestep::sdf {
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

// The lines of one axis are transformed in blocks of neighbours in x: in memory those are adjacent,
// while the cells of one line lie apart, each in a cache line of its own.
constexpr std::ptrdiff_t kBlock = 16;  // int32 values in a cache line

// Transforms the squares of one line of cells: on entry those over the axes done so far, on return
// those over this axis too. Neighbours on the line are `stride` values apart in memory.
//
// Within a run of cells of one kind, the way to the nearest cell of the other kind either starts
// with a step along the line to another cell of the run, or to the first cell beyond the run's
// ends: nothing further away can be nearer, since that cell is itself of the other kind.
class LineTransform {
 public:
  LineTransform(DistanceConvention convention, int max_length)
      : convention_(convention), envelope_(max_length + 2) {}

  template <std::ptrdiff_t stride>
  void Run(const std::uint8_t* filled, std::int32_t* squares, int length) {
    // The distance along one axis from a centre to another cell's cube is that to its nearer face,
    // and zero within the same cell. So in the surface convention the faces between cells are the
    // sites, each as low as the lower of the two cells it parts, and a cell's own square (the final
    // min) stands for the zero. Otherwise the centres are the sites.
    const bool from_faces = convention_ == DistanceConvention::kSurface;
    const int to_site = from_faces ? 1 : 2;  // from an end of a run to the nearest site beyond
    for (int first = 0; first < length;) {
      const bool kind = filled[first * stride] != 0;
      int last = first;
      while (last + 1 < length && (filled[(last + 1) * stride] != 0) == kind) ++last;

      envelope_.Begin(first, last);
      if (first > 0) envelope_.Add(2 * first - to_site, 0);
      if (from_faces) {
        for (int i = first; i < last; ++i) {
          AddIfKnown(2 * i + 1, std::min(squares[i * stride], squares[(i + 1) * stride]));
        }
      } else {
        for (int i = first; i <= last; ++i) AddIfKnown(2 * i, squares[i * stride]);
      }
      if (last + 1 < length) envelope_.Add(2 * last + to_site, 0);
      envelope_.ForEachCell([&](int i, std::int32_t value) {
        squares[i * stride] = std::min(squares[i * stride], value);
      });
      first = last + 1;
    }
  }

 private:
  void AddIfKnown(std::int32_t position, std::int32_t height) {
    if (height != kNoOtherCell) envelope_.Add(position, height);
  }

  DistanceConvention convention_;
  LowerEnvelope envelope_;
};

}  // namespace

void CheckTransformInput(const OccupancyGrid& occupancy) {
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

std::vector<std::int32_t> ComputeSquaredDistance(const OccupancyGrid& occupancy,
                                                 DistanceConvention convention) {
  CheckTransformInput(occupancy);
  const std::ptrdiff_t nx = occupancy.spec.size[0];
  const std::ptrdiff_t ny = occupancy.spec.size[1];
  const std::ptrdiff_t nz = occupancy.spec.size[2];
  const std::uint8_t* const filled = occupancy.cells.data();
  std::vector<std::int32_t> squares(occupancy.cells.size(), kNoOtherCell);
  LineTransform transform(convention, static_cast<int>(std::max({nx, ny, nz})));

  for (std::ptrdiff_t row = 0; row < ny * nz; ++row) {
    transform.Run<1>(filled + row * nx, squares.data() + row * nx, static_cast<int>(nx));
  }

  std::vector<std::uint8_t> block_filled(static_cast<std::size_t>(kBlock * std::max(ny, nz)));
  std::vector<std::int32_t> block_squares(block_filled.size());
  // The lines that start at `begin` and its neighbours in x, `step` apart from cell to cell.
  const auto run_block = [&](std::ptrdiff_t begin, std::ptrdiff_t width, std::ptrdiff_t length,
                             std::ptrdiff_t step) {
    for (std::ptrdiff_t i = 0; i < length; ++i) {
      std::copy_n(filled + begin + i * step, width, block_filled.data() + i * kBlock);
      std::copy_n(squares.data() + begin + i * step, width, block_squares.data() + i * kBlock);
    }
    for (std::ptrdiff_t b = 0; b < width; ++b) {
      transform.Run<kBlock>(block_filled.data() + b, block_squares.data() + b,
                            static_cast<int>(length));
    }
    for (std::ptrdiff_t i = 0; i < length; ++i) {
      std::copy_n(block_squares.data() + i * kBlock, width, squares.data() + begin + i * step);
    }
  };
  for (std::ptrdiff_t x = 0; x < nx; x += kBlock) {
    const std::ptrdiff_t width = std::min(kBlock, nx - x);
    for (std::ptrdiff_t k = 0; k < nz; ++k) run_block(x + k * nx * ny, width, ny, nx);
    for (std::ptrdiff_t j = 0; j < ny; ++j) run_block(x + j * nx, width, nz, nx * ny);
  }
  return squares;
}

SdfGrid ComputeSignedDistance(const OccupancyGrid& occupancy, DistanceConvention convention) {
  const std::vector<std::int32_t> squares = ComputeSquaredDistance(occupancy, convention);
  AlignedVector<float> distance_m(squares.size());
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

}  // namespace sidestep::sdf
