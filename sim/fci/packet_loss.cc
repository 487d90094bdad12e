#include "sidestep/sim/fci/packet_loss.h"

#include <algorithm>

namespace sidestep::sim::fci {

void PacketLoss::Note(bool received) {
  in_a_row_ = received ? 0 : in_a_row_ + 1;
  window_[next_] = received;
  next_ = (next_ + 1) % kWindow;
  count_ = std::min<std::size_t>(count_ + 1, kWindow);
}

double PacketLoss::success_rate() const {
  if (count_ == 0) return 0;
  const auto received =
      std::count(window_.begin(), window_.begin() + static_cast<long>(count_), true);
  return static_cast<double>(received) / static_cast<double>(count_);
}

}  // namespace sidestep::sim::fci
