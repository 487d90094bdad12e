#pragma once

#include <string>

#include "sidestep/bench/run_row.h"

namespace sidestep::bench {

/// What an episode of a validation is for, which decides the items that look at it.
namespace validation_group {
inline constexpr const char* kEnvelope = "envelope";      ///< as declared, nothing wrong
inline constexpr const char* kPerception = "perception";  ///< as declared, seen badly
inline constexpr const char* kTiming = "timing";          ///< as declared, late or losing packets
inline constexpr const char* kSudden = "sudden";          ///< accelerates more than declared
inline constexpr const char* kFast = "fast";              ///< is faster than declared
inline constexpr const char* kPrediction = "prediction";  ///< the planner alone, unsupervised
inline constexpr const char* kFault = "fault";            ///< something fails
inline constexpr const char* kRepeat = "repeat";          ///< what was run before, again
inline constexpr const char* kSoak = "soak";              ///< as declared, at random
}  // namespace validation_group

/// One episode of a validation: what is varied, each by a word of its table.
struct ValidationCase {
  std::string group;
  std::string behaviour;               ///< of the first moving obstacle: behaviours.h
  double speed_m_s = 0;                ///< its greatest
  std::string perception = "nominal";  ///< perception.h
  std::string timing = "nominal";      ///< timing.h
  std::string fault = "none";          ///< faults.h
  std::string knowledge;
  bool on_the_wire = false;  ///< the arm is at the end of one, not simulated in line
  bool is_supervised = true;
  int draw = 1;  ///< decides where the obstacle comes from; odd: from start to goal, even: back
};

/// What tells it apart, in the columns of a table.
Factors FactorsOf(const ValidationCase& one);

/// One word for it, the same on every machine: "envelope:cross:0.25:...:1".
std::string NameOf(const ValidationCase& one);

}  // namespace sidestep::bench
