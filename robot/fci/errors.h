#pragma once

#include <bitset>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace sidestep::robot::fci {

/// Errors that the robot's controller tells, in the order of their flags on the wire. Only those
/// that the code speaks of have a word here; ErrorName knows all.
/// Source: libfranka-common e6aa0fc (Apache-2.0), facts only.
enum class Error : std::uint8_t {
  kJointPositionLimitsViolation = 0,
  kJointVelocityViolation = 3,
  kJointReflex = 6,
  kCartesianReflex = 7,
  kStartPoseInvalid = 11,
  kPositionLimitsViolation = 12,  ///< of the motion that is commanded, as the next three
  kVelocityLimitsViolation = 13,
  kVelocityDiscontinuity = 14,
  kAccelerationDiscontinuity = 15,
  kCommunicationConstraintsViolation = 25,
  kTorqueDiscontinuity = 32,
};
inline constexpr int kNumErrors = 41;

using ErrorSet = std::bitset<kNumErrors>;

/// `joint_reflex` and the like, as libfranka prints it. `error` is an index below kNumErrors.
std::string_view ErrorName(int error);
/// The index of a name; none for what is no name of an error.
std::optional<int> FindError(std::string_view name);

inline ErrorSet Only(Error error) { return ErrorSet().set(static_cast<std::size_t>(error)); }
inline bool Holds(const ErrorSet& errors, Error error) {
  return errors[static_cast<std::size_t>(error)];
}

/// The names of all that are set, with commas between; "none" of an empty set.
std::string Text(const ErrorSet& errors);

}  // namespace sidestep::robot::fci
