#pragma once

#include <cstdint>
#include <string>

namespace sidestep::cli {

/// Tells on standard error, now and then, how far a long work has come: how many are done of how
/// many, at what rate, and how long the others will take.
class SweepProgress {
 public:
  explicit SweepProgress(std::uint64_t count);
  /// @param failed whether it is worth a word.
  void Count(bool failed);
  /// "3 min 20 s".
  static std::string DurationText(double seconds);

 private:
  std::uint64_t count_, done_ = 0, failed_ = 0;
  double begun_s_, told_s_;
};

}  // namespace sidestep::cli
