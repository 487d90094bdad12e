#pragma once

#include <cstdint>
#include <string>

#include "sidestep/hardware/exchange_log.h"
#include "sidestep/hardware/fci_client.h"
#include "sidestep/hardware/fci_driver.h"

namespace sidestep::hardware {

/// Drives by the bare protocol, without libfranka: for the simulated robot server, where nothing
/// else is needed. It has no limiter and no filter, so what it is given is what is sent. On a real
/// robot use libfranka.
class RawFciDriver final : public FciDriver {
 public:
  /// Connects. @throws FciError kNetwork or kVersion.
  explicit RawFciDriver(const std::string& address) : client_(address) {}

  int server_version() const override { return client_.server_version(); }
  RobotSnapshot ReadOnce() override;
  void Configure(const FciSettings& settings) override;
  void Control(CommandKind kind, const NextCommand& next) override;
  void Stop() override;
  void Recover() override;

 private:
  std::uint32_t Start(CommandKind kind);
  void StopAnyhow() noexcept;
  void Run(std::uint32_t move_id, CommandKind kind, const NextCommand& next);
  void Answer(const robot::fci::RobotState& state, CommandKind kind, const Command& command);
  [[noreturn]] void ThrowEnd(std::uint8_t status, const robot::fci::ErrorSet& errors) const;

  FciClient client_;
  ExchangeLog log_;
};

}  // namespace sidestep::hardware
