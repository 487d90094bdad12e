#pragma once

#include "sidestep/core/yaml_reader.h"
#include "sidestep/scenarios/yaml_text.h"

namespace sidestep::scenarios {

// Numbers of a file that have a bound against slips of the pen. Both @throw InputError.

/// >= 0 and at most `most`; `otherwise` where the key is not there.
inline double AtMost(const YamlReader& map, const char* key, double otherwise, double most) {
  if (!map.Has(key)) return otherwise;
  const double value = map.GetNonNegative(key);
  if (value > most) map.Fail(key, "must be at most " + Number(most) + ", is " + Number(value));
  return value;
}

/// The same, and > 0.
inline double PositiveAtMost(const YamlReader& map, const char* key, double otherwise,
                             double most) {
  if (!map.Has(key)) return otherwise;
  map.GetPositive(key);
  return AtMost(map, key, otherwise, most);
}

}  // namespace sidestep::scenarios
