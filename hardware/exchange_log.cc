#include "sidestep/hardware/exchange_log.h"

#include <algorithm>
#include <cmath>

namespace sidestep::hardware {

void ExchangeLog::Add(const RobotSnapshot& state, const Command& command) {
  ring_[count_++ % kSize] = {state, command};
}

std::vector<ExchangeRecord> ExchangeLog::InOrder() const {
  std::vector<ExchangeRecord> records;
  for (std::size_t i = count_ - std::min(count_, kSize); i < count_; ++i) {
    records.push_back(ring_[i % kSize]);
  }
  return records;
}

Command NextAnswer(const FciDriver::NextCommand& next, const RobotSnapshot& state, int elapsed_ms,
                   ExchangeLog& log) {
  const Command command = next(state, elapsed_ms);
  const bool is_finite = std::all_of(command.values.begin(), command.values.end(),
                                     [](double value) { return std::isfinite(value); });
  if (!is_finite) {
    throw FciError(FciError::Kind::kBadCommand, "the command holds what is no number", {},
                   log.InOrder());
  }
  log.Add(state, command);
  return command;
}

}  // namespace sidestep::hardware
