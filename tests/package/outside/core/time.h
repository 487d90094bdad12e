#pragma once

// A header of the outside project whose name Sidestep has as well.
inline constexpr double kOutsideSeconds = 60;
