#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

namespace sidestep {

/// A stream of random numbers that belongs to one purpose of one episode: the seed and the
/// purpose's name decide it, so that a purpose that draws more or less does not disturb another.
/// The numbers of Bits and Uniform are the same everywhere; Normal takes log and cos from the C
/// library, whose last bit may differ from one to another. Source: SplitMix64, G. L. Steele, D.
/// Lea, C. H. Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014; the purpose is
/// hashed by FNV-1a.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view purpose) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char c : purpose) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
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

  /// Of mean 0 and standard deviation 1, by Box and Muller (of the pair, the first).
  double Normal() {
    const double radius = std::sqrt(-2 * std::log(1 - Uniform()));
    return radius * std::cos(2 * std::numbers::pi * Uniform());
  }

 private:
  std::uint64_t state_ = 0;
};

}  // namespace sidestep
