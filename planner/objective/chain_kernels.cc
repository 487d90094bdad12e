#include "sidestep/planner/objective/chain_kernels.h"

#include "sidestep/robot/robot_model.h"

// Highway compiles what follows once for each instruction set, each time in a namespace of its own;
// the end of the file picks one of them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sidestep/planner/objective/chain_kernels.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sidestep::planner::chain_kernels {
namespace HWY_NAMESPACE {
namespace {  // position-independent code inlines nothing that others could replace
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));
constexpr int kVector = 8;  // strides are multiples of it

int FirstRowOfVector(int row) { return row / kLanes * kLanes; }

// to -= from * factor
void Subtract(const double* from, double factor, int begin, int end, double* to) {
  const D d;
  const V f = hn::Set(d, factor);
  for (int row = begin; row < end; row += kLanes) {
    hn::Store(hn::Sub(hn::Load(d, to + row), hn::Mul(hn::Load(d, from + row), f)), d, to + row);
  }
}

// In the order in which 8 lanes would add up.
double DotProduct(const double* a, const double* b, int size) {
  const D d;
  V sums[kVector / kLanes];
  for (V& sum : sums) sum = hn::Zero(d);
  for (int row = 0; row < size; row += kVector) {
    for (int part = 0; part < kVector / kLanes; ++part) {
      const int at = row + part * kLanes;
      sums[part] = hn::Add(sums[part], hn::Mul(hn::Load(d, a + at), hn::Load(d, b + at)));
    }
  }
  HWY_ALIGN double lanes[kVector];
  for (int part = 0; part < kVector / kLanes; ++part)
    hn::Store(sums[part], d, lanes + part * kLanes);
  return ((lanes[0] + lanes[4]) + (lanes[2] + lanes[6])) +
         ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7]));
}

constexpr int kMaxBlockSize = 2 * robot::RobotModel::kMaxJoints;

// The sizes of most arms, known to the compiler.
struct SevenJoints {
  static constexpr int block_size = 14, stride = 16;
};

// The matrix is C diag(inverse) C^T with a lower triangular C that has the pivots on its diagonal:
// no roots, and one division a column in the chain of what waits for what.

// One block column, from `panel` into `C`, less what the column before takes off it.
template <class Sizes>
void CopyPanel(const Sizes& chain, const double* panel, const double* C_before,
               const double* inverse_before, double* C) {
  const D d;
  const int height = 2 * chain.stride;
  for (int j = 0; j < chain.block_size; ++j) {
    double factors[kMaxBlockSize];
    for (int i = 0; C_before != nullptr && i < chain.block_size; ++i) {
      factors[i] = C_before[i * height + chain.stride + j] * inverse_before[i];
    }
    for (int row = FirstRowOfVector(j); row < chain.stride; row += kLanes) {
      V value = hn::Load(d, panel + j * height + row);
      if (C_before != nullptr) {
        const double* X = C_before + chain.stride + row;
        for (int i = 0; i < chain.block_size; ++i, X += height) {
          value = hn::Sub(value, hn::Mul(hn::Load(d, X), hn::Set(d, factors[i])));
        }
      }
      hn::Store(value, d, C + j * height + row);
    }
    for (int row = chain.stride; row < height; row += kLanes) {
      hn::Store(hn::Load(d, panel + j * height + row), d, C + j * height + row);
    }
  }
}

// Factors one block column in place, and solves the rows of the right-hand side that are its own;
// the next block's are rid of what it takes off them.
template <class Sizes>
bool FactorPanel(const Sizes& chain, const double* damping, double* C, double* inverse,
                 double* rhs) {
  const D d;
  const int height = 2 * chain.stride;
  for (int j = 0; j < chain.block_size; ++j) {
    double* const column = C + j * height;
    const double pivot = column[j] + damping[j];
    if (!(pivot > 0)) return false;
    inverse[j] = 1 / pivot;
    for (int k = j + 1; k < chain.block_size; ++k) {
      Subtract(column, column[k] * inverse[j], FirstRowOfVector(k), height, C + k * height);
    }
    // Of the vector that row j lies in, what is solved stays as it is.
    const double factor = rhs[j] * inverse[j];
    const int first = FirstRowOfVector(j);
    const auto below_j =
        hn::Not(hn::FirstN(d, static_cast<std::size_t>(j) - static_cast<std::size_t>(first) + 1));
    const V taken = hn::Mul(hn::Load(d, column + first), hn::Set(d, factor));
    hn::Store(hn::Sub(hn::Load(d, rhs + first), hn::IfThenElseZero(below_j, taken)), d,
              rhs + first);
    Subtract(column, factor, first + kLanes, height, rhs);
  }
  return true;
}

template <class Sizes>
bool FactorOfSizes(const Sizes& chain, int num_blocks, const double* panels, const double* damping,
                   double* factor, double* inverse, double* rhs) {
  const int panel_size = chain.block_size * 2 * chain.stride;
  for (int k = 0; k < num_blocks; ++k) {
    double* const C = factor + k * panel_size;
    const int at = k * chain.stride;
    CopyPanel(chain, panels + k * panel_size, k > 0 ? C - panel_size : nullptr,
              k > 0 ? inverse + at - chain.stride : nullptr, C);
    if (!FactorPanel(chain, damping + at, C, inverse + at, rhs + at)) return false;
  }
  return true;
}

template <class Sizes>
void SubstituteBack(const Sizes& chain, int num_blocks, const double* factor, const double* inverse,
                    double* rhs) {
  const int height = 2 * chain.stride, panel_size = chain.block_size * height;
  for (int k = num_blocks - 1; k >= 0; --k) {
    const double* const C = factor + k * panel_size;
    double* const x = rhs + k * chain.stride;
    for (int j = 0; k + 1 < num_blocks && j < chain.block_size; ++j) {
      x[j] -= DotProduct(C + j * height + chain.stride, x + chain.stride, chain.stride);
    }
    for (int j = chain.block_size - 1; j >= 0; --j) {
      x[j] *= inverse[k * chain.stride + j];
      for (int i = 0; i < j; ++i) x[i] -= C[i * height + j] * x[j];
    }
  }
}

template <class Sizes>
bool SolveOfSizes(const Sizes& chain, int num_blocks, const double* panels, const double* damping,
                  double* factor, double* inverse, double* rhs) {
  if (!FactorOfSizes(chain, num_blocks, panels, damping, factor, inverse, rhs)) return false;
  SubstituteBack(chain, num_blocks, factor, inverse, rhs);
  return true;
}

bool FactorChain(const Chain& chain, const double* panels, const double* damping, double* factor,
                 double* inverse, double* rhs) {
  if (chain.block_size == SevenJoints::block_size && chain.stride == SevenJoints::stride) {
    return FactorOfSizes(SevenJoints(), chain.num_blocks, panels, damping, factor, inverse, rhs);
  }
  return FactorOfSizes(chain, chain.num_blocks, panels, damping, factor, inverse, rhs);
}

bool SolveChain(const Chain& chain, const double* panels, const double* damping, double* factor,
                double* inverse, double* rhs) {
  if (chain.block_size == SevenJoints::block_size && chain.stride == SevenJoints::stride) {
    return SolveOfSizes(SevenJoints(), chain.num_blocks, panels, damping, factor, inverse, rhs);
  }
  return SolveOfSizes(chain, chain.num_blocks, panels, damping, factor, inverse, rhs);
}

// Pairs (a, b) of (q, v, q, v) with a >= b, row by row.
constexpr int kPairs = 10;

void AddBetweenStates(int n, int stride, std::span<const BetweenStates> between,
                      const IntervalTarget& target) {
  const D d;
  const int rows = (n + kVector - 1) / kVector * kVector, height = 2 * stride;
  const auto add = [&](V value, double* to) {
    hn::StoreU(hn::Add(hn::LoadU(d, to), value), d, to);
  };
  // Rows of padding add zeros to whatever comes next.
  for (int row = 0; row < rows; row += kLanes) {
    V sums[4] = {hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (const BetweenStates& one : between) {
      const V gradient = hn::Load(d, one.gradient + row);
      if (one.is_end) {
        sums[2] = hn::Add(sums[2], gradient);
        continue;
      }
      for (int a = 0; a < 4; ++a) {
        sums[a] = hn::Add(sums[a],
                          hn::Mul(gradient, hn::Set(d, one.weights[static_cast<std::size_t>(a)])));
      }
    }
    if (target.near_gradient != nullptr) {
      add(sums[0], target.near_gradient + row);
      add(sums[1], target.near_gradient + n + row);
    }
    add(sums[2], target.far_gradient + row);
    add(sums[3], target.far_gradient + n + row);
  }
  for (int column = 0; column < n; ++column) {
    for (int row = 0; row < rows; row += kLanes) {
      V sums[kPairs];
      for (V& sum : sums) sum = hn::Zero(d);
      for (const BetweenStates& one : between) {
        const V hessian = hn::Load(d, one.hessian + column * rows + row);
        const auto& w = one.weights;
        if (one.is_end) {
          sums[5] = hn::Add(sums[5], hessian);
          continue;
        }
        const V scaled[4] = {hn::Mul(hessian, hn::Set(d, w[0])), hn::Mul(hessian, hn::Set(d, w[1])),
                             hn::Mul(hessian, hn::Set(d, w[2])),
                             hn::Mul(hessian, hn::Set(d, w[3]))};
        int pair = 0;
        for (int a = 0; a < 4; ++a) {
          for (int b = 0; b <= a; ++b, ++pair) {
            sums[pair] =
                hn::Add(sums[pair], hn::Mul(scaled[a], hn::Set(d, w[static_cast<std::size_t>(b)])));
          }
        }
      }
      int pair = 0;
      for (int a = 0; a < 4; ++a) {
        for (int b = 0; b <= a; ++b, ++pair) {
          if (b >= 2) {
            add(sums[pair], target.far_panel + ((b - 2) * n + column) * height + (a - 2) * n + row);
          } else if (target.near_panel != nullptr) {
            const int to_row = a < 2 ? a * n : stride + (a - 2) * n;
            add(sums[pair], target.near_panel + (b * n + column) * height + to_row + row);
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace sidestep::planner::chain_kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sidestep::planner::chain_kernels {

HWY_EXPORT(SolveChain);
HWY_EXPORT(FactorChain);
HWY_EXPORT(AddBetweenStates);

bool Solve(const Chain& chain, const double* panels, const double* damping, double* factor,
           double* inverse, double* rhs) {
  return HWY_DYNAMIC_DISPATCH(SolveChain)(chain, panels, damping, factor, inverse, rhs);
}

bool Factor(const Chain& chain, const double* panels, const double* damping, double* factor,
            double* inverse, double* rhs) {
  return HWY_DYNAMIC_DISPATCH(FactorChain)(chain, panels, damping, factor, inverse, rhs);
}

void AddBetween(int num_joints, int stride, std::span<const BetweenStates> between,
                const IntervalTarget& target) {
  HWY_DYNAMIC_DISPATCH(AddBetweenStates)(num_joints, stride, between, target);
}

}  // namespace sidestep::planner::chain_kernels
#endif  // HWY_ONCE
