#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "sidestep/core/fnv1a.h"

namespace sidestep {

/// A short name for a content: 64 bits of FNV-1a over its parts. It tells a changed file from the
/// one that it was; it is no defence against someone who wants two to be taken for one.
class Fingerprint {
 public:
  /// A further part. Where one ends and the next begins makes a difference.
  void Add(std::string_view part);
  /// 16 hexadecimal digits.
  std::string Text() const;

 private:
  void AddByte(unsigned char byte) { hash_ = Fnv1a(hash_, byte); }

  std::uint64_t hash_ = kFnv1aBasis;
};

}  // namespace sidestep
