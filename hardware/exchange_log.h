#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "sidestep/hardware/fci_driver.h"

namespace sidestep::hardware {

/// The last states of a motion and their answers, in a ring: adding allocates nothing.
class ExchangeLog {
 public:
  void Clear() { count_ = 0; }
  void Add(const RobotSnapshot& state, const Command& command);
  /// Oldest first.
  std::vector<ExchangeRecord> InOrder() const;

 private:
  static constexpr std::size_t kSize = 50;
  std::array<ExchangeRecord, kSize> ring_{};
  std::size_t count_ = 0;
};

/// Asks `next` for the answer to a state, and logs both.
/// @throws FciError kBadCommand, with the log, for one that holds what is no number.
Command NextAnswer(const FciDriver::NextCommand& next, const RobotSnapshot& state, int elapsed_ms,
                   ExchangeLog& log);

}  // namespace sidestep::hardware
