#pragma once

#include <hwy/targets.h>

#include <cstdint>

namespace sidestep::sdf {

/// For as long as it lives, Highway picks none but this instruction set.
class OnlyTarget {
 public:
  explicit OnlyTarget(std::int64_t target) { Use(target); }
  ~OnlyTarget() { Use(0); }
  OnlyTarget(const OnlyTarget&) = delete;
  OnlyTarget& operator=(const OnlyTarget&) = delete;

 private:
  static void Use(std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().DeInit();
  }
};

}  // namespace sidestep::sdf
