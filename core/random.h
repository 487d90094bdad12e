#pragma once

#include <cstdint>
#include <string_view>

#include "sidestep/core/fnv1a.h"

namespace sidestep {

/// A stream of random numbers that belongs to one purpose of one episode: the seed and the
/// purpose's name decide it, so that a purpose that draws more or less does not disturb another.
/// Every number is made by additions, multiplications, divisions and square roots of doubles, which
/// IEEE 754 defines to the last bit, so it is the same with every compiler and library; what the
/// distributions of `std::` give is each library's own. Source: SplitMix64, G. L. Steele, D. Lea,
/// C. H. Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014; the purpose is
/// hashed by FNV-1a.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view purpose) {
    std::uint64_t hash = kFnv1aBasis;
    for (const char c : purpose) hash = Fnv1a(hash, static_cast<unsigned char>(c));
    state_ = seed;
    state_ = Bits() ^ hash;
  }

  /// 64 independent bits.
  std::uint64_t Bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  /// In [0, 1), a multiple of 2^-53.
  double Uniform() { return static_cast<double>(Bits() >> 11) * 0x1p-53; }

  /// In [low, high], for low <= high; `high` itself only by rounding.
  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }

  /// Of mean 0 and standard deviation 1, by Box and Muller (of the pair, the first), with a
  /// logarithm and a cosine of its own, wrong by at most an ulp or two.
  double Normal();

 private:
  std::uint64_t state_ = 0;
};

}  // namespace sidestep
