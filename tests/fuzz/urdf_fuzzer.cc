// Any file is refused with an InputError, or is an arm whose links can be placed.
#include <cstdlib>

#include "sidestep/core/input_error.h"
#include "sidestep/import/arm_of_tree.h"
#include "sidestep/import/arm_pose.h"
#include "sidestep/import/urdf_tree.h"
#include "tests/fuzz/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const sidestep::MemoryFile file(bytes, size);
  try {
    const sidestep::imports::ArmChoices choices;
    const auto imported = sidestep::imports::ArmOfTree(
        sidestep::imports::ReadUrdfTree(file.path(), choices), choices);
    const auto n = static_cast<Eigen::Index>(imported.arm.limits.size());
    const auto links = sidestep::imports::LinkPosesAt(imported.arm, Eigen::VectorXd::Zero(n));
    if (links.size() + 1 != imported.arm.links.size()) std::abort();
  } catch (const sidestep::InputError&) {
  }
  return 0;
}
