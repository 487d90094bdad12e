#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace sidestep::sim::fci {

/// Counts, tick by tick while a motion runs, whether a command came in time.
/// Source: frankaemika/docs, libfranka.rst: a late command is dropped and the motion extrapolated,
/// and 20 in a row end it; the success rate is that of the last 100.
class PacketLoss {
 public:
  static constexpr int kMostInARow = 20;
  static constexpr int kWindow = 100;

  /// A command is in time if it answers the latest state: what answers an older one is late.
  static bool IsInTime(std::uint64_t command_id, std::uint64_t latest_state_id) {
    return command_id == latest_state_id;
  }

  void Received() { Note(true); }
  void Lost() { Note(false); }

  int in_a_row() const { return in_a_row_; }
  bool are_too_many() const { return in_a_row_ >= kMostInARow; }
  /// From 0 to 1; of fewer than 100 ticks, their own. Before the first tick, 0.
  double success_rate() const;

 private:
  void Note(bool received);

  std::array<bool, kWindow> window_{};
  std::size_t count_ = 0, next_ = 0;
  int in_a_row_ = 0;
};

}  // namespace sidestep::sim::fci
