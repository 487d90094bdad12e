#pragma once

namespace sidestep::scenarios {

/// How long a horizon may be, whether a file asks for it or the limits of a motion do.
inline constexpr double kMostHorizon_s = 60;
inline constexpr int kMostHorizonSteps = 1000;

}  // namespace sidestep::scenarios
