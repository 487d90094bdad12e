#pragma once

#include <cstdint>

namespace sidestep {

/// FNV-1a, 64 bits: every change of a single byte changes the hash, and almost every other change
/// does. Begin with kFnv1aBasis, then take in each byte in turn. Source: G. Fowler, L. C. Noll,
/// K.-P. Vo, D. Eastlake, "The FNV Non-Cryptographic Hash Algorithm".
inline constexpr std::uint64_t kFnv1aBasis = 0xcbf29ce484222325u;
constexpr std::uint64_t Fnv1a(std::uint64_t hash, unsigned char byte) {
  return (hash ^ byte) * 0x100000001b3u;
}

}  // namespace sidestep
