#include "sidestep/sim/fci/panda_settings.h"

#include <algorithm>
#include <cmath>

namespace sidestep::sim::fci {
namespace {

namespace status = robot::fci::status;
using robot::fci::FromBytes;
using robot::fci::Request;

// False for NaN too.
template <typename Values>
bool AllWithin(const Values& values, double least, double most) {
  return std::all_of(values.begin(), values.end(),
                     [&](double value) { return value >= least && value <= most; });
}

bool IsValid(const robot::fci::CollisionBehaviorRequest& request) {
  constexpr double kMost = 1e6;
  const auto is_valid = [](const auto& values) { return AllWithin(values, 0, kMost); };
  return is_valid(request.lower_torque_acceleration) &&
         is_valid(request.upper_torque_acceleration) && is_valid(request.lower_torque_nominal) &&
         is_valid(request.upper_torque_nominal) && is_valid(request.lower_force_acceleration) &&
         is_valid(request.upper_force_acceleration) && is_valid(request.lower_force_nominal) &&
         is_valid(request.upper_force_nominal);
}

bool IsValid(const robot::fci::LoadRequest& request) {
  return request.mass_kg >= 0 && std::isfinite(request.mass_kg) && AllFinite(request.F_x_Cload) &&
         AllFinite(request.I_load);
}

}  // namespace

bool AllFinite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(),
                     [](double value) { return std::isfinite(value); });
}

std::uint8_t Apply(const robot::fci::Message& request, PandaSettings& settings) {
  switch (request.request) {
    case Request::kSetCollisionBehavior: {
      const auto wanted = FromBytes<robot::fci::CollisionBehaviorRequest>(request.payload);
      if (!IsValid(wanted)) return status::kInvalidArgument;
      settings.collision = wanted;
      return status::kSuccess;
    }
    case Request::kSetJointImpedance: {
      const auto wanted = FromBytes<robot::fci::JointImpedanceRequest>(request.payload);
      if (!AllWithin(wanted.stiffness, 0, kLargestStiffness)) return status::kInvalidArgument;
      settings.impedance.stiffness = wanted.stiffness;
      return status::kSuccess;
    }
    case Request::kSetEEToK:
    case Request::kSetNEToEE: {
      const auto wanted = FromBytes<robot::fci::FrameRequest>(request.payload);
      if (!IsTransform(wanted.pose)) return status::kInvalidArgument;
      (request.request == Request::kSetEEToK ? settings.EE_T_K : settings.NE_T_EE) = wanted.pose;
      return status::kSuccess;
    }
    case Request::kSetLoad: {
      const auto wanted = FromBytes<robot::fci::LoadRequest>(request.payload);
      if (!IsValid(wanted)) return status::kInvalidArgument;
      settings.load = wanted;
      return status::kSuccess;
    }
    case Request::kSetCartesianImpedance:
    case Request::kSetGuidingMode:
    case Request::kSetFilters:
      return status::kSuccess;  // of what is not simulated
    default:
      return status::kNotPossible;
  }
}

}  // namespace sidestep::sim::fci
