#pragma once

#include <memory>
#include <string>

#include "sidestep/hardware/fci_driver.h"

namespace sidestep::cli {

/// Whether an address is this machine's own loopback, where only a simulated robot can be.
bool IsLoopback(const std::string& address);
/// `localhost` in numbers; any other as it is.
std::string NumericAddress(const std::string& address);

/// Connects to the Panda at `address`. @throws InputError, blaming --robot, if nobody answers
/// there, it speaks another version (which the operator's log keeps), or it is a real robot and
/// this program has no libfranka.
std::unique_ptr<hardware::FciDriver> ConnectPanda(const std::string& address);

}  // namespace sidestep::cli
