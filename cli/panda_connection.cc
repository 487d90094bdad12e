#include "sidestep/cli/panda_connection.h"

#include "sidestep/cli/operator_log.h"
#include "sidestep/core/input_error.h"
#include "sidestep/hardware/libfranka_driver.h"
#include "sidestep/hardware/raw_fci_driver.h"

namespace sidestep::cli {

bool IsLoopback(const std::string& address) {
  return address == "localhost" || address.starts_with("127.");
}

std::string NumericAddress(const std::string& address) {
  return address == "localhost" ? "127.0.0.1" : address;
}

std::unique_ptr<hardware::FciDriver> ConnectPanda(const std::string& address) {
  if (!IsLoopback(address) && !hardware::HasLibfranka()) {
    throw InputError("--robot", "'" + address +
                                    "' is not on this machine, and a real robot needs libfranka, "
                                    "which this program was built without: docs/hardware.md");
  }
  try {
    if (!IsLoopback(address)) return hardware::MakeLibfrankaDriver(address, {});
    return std::make_unique<hardware::RawFciDriver>(NumericAddress(address));
  } catch (const hardware::FciError& error) {
    if (error.kind() == hardware::FciError::Kind::kVersion) {
      OperatorLog(address).Refused({control::SafetyCheck::kConfiguration, error.what()});
    }
    const std::string hint =
        IsLoopback(address) && error.kind() == hardware::FciError::Kind::kNetwork
            ? " (`sidestep fci-server` starts a simulated one)"
            : "";
    throw InputError("--robot", error.what() + hint);
  }
}

}  // namespace sidestep::cli
