#include <stdexcept>

#include "sidestep/hardware/libfranka_driver.h"

namespace sidestep::hardware {

bool HasLibfranka() { return false; }

std::unique_ptr<FciDriver> MakeLibfrankaDriver(const std::string&, const LibfrankaOptions&) {
  throw std::invalid_argument("MakeLibfrankaDriver: this build has no libfranka");
}

}  // namespace sidestep::hardware
