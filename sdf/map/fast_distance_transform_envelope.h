#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace sidestep::sdf::fast_transform {

/// A source and the stretch of the line where it is the lowest: from `begin` to the next piece.
struct EnvelopePiece {
  std::uint32_t source = 0;
  std::uint32_t value = 0;
  std::uint32_t begin = 0;
};

/// Replaces values[t] by the lower of `far` and  min over s of values[s] + cost(|t - s|).
///
/// Takes n log n steps for a line of n, whatever the values. Of two sources, the one further along
/// the line is the lower from some place on, as `cost` is convex; bisection finds that place. So
/// the minimum has one piece for each source that is the lowest anywhere (after P. Felzenszwalb, D.
/// Huttenlocher, "Distance Transforms of Sampled Functions", Theory of Computing 8:415-428, 2012).
///
/// @param cost   convex, cost(0) = 0.
/// @param far    values from here on are no sources; far + cost(n) must fit 32 bits.
/// @param pieces scratch for n pieces.
template <class Cost>
void TransformLineByEnvelope(std::uint32_t* values, std::size_t n, std::uint32_t far,
                             const Cost& cost, EnvelopePiece* pieces) {
  const std::uint32_t size = static_cast<std::uint32_t>(n);
  const auto value_at = [&](const EnvelopePiece& piece, std::uint32_t t) {
    return piece.value + cost(std::max(t, piece.source) - std::min(t, piece.source));
  };
  std::size_t num_pieces = 0;
  for (std::uint32_t s = 0; s < size; ++s) {
    if (values[s] >= far) continue;
    EnvelopePiece added{s, values[s], 0};
    const auto wins_at = [&](std::uint32_t t) {
      return value_at(added, t) <= value_at(pieces[num_pieces - 1], t);
    };
    while (num_pieces > 0 && wins_at(pieces[num_pieces - 1].begin)) --num_pieces;
    if (num_pieces > 0) {
      std::uint32_t loses = pieces[num_pieces - 1].begin;
      added.begin = size;
      while (added.begin - loses > 1) {
        const std::uint32_t middle = loses + (added.begin - loses) / 2;
        (wins_at(middle) ? added.begin : loses) = middle;
      }
    }
    if (added.begin < size) pieces[num_pieces++] = added;
  }
  for (std::size_t p = 0; p < num_pieces; ++p) {
    const std::uint32_t end = p + 1 < num_pieces ? pieces[p + 1].begin : size;
    for (std::uint32_t t = pieces[p].begin; t < end; ++t) {
      values[t] = std::min(far, value_at(pieces[p], t));
    }
  }
}

/// TransformLineByEnvelope for many lines at once, the lanes of an array [row][lane].
/// @param line scratch for one line.
template <class Lane, class Cost>
void TransformColumnByEnvelopes(Lane* column, std::size_t rows, std::size_t lanes, Lane far,
                                const Cost& cost, std::uint32_t* line, EnvelopePiece* pieces) {
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    for (std::size_t r = 0; r < rows; ++r) line[r] = column[r * lanes + lane];
    TransformLineByEnvelope(line, rows, far, cost, pieces);
    for (std::size_t r = 0; r < rows; ++r) column[r * lanes + lane] = static_cast<Lane>(line[r]);
  }
}

}  // namespace sidestep::sdf::fast_transform
