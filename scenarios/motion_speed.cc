#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "sidestep/core/yaml_reader.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/scenarios/yaml_text.h"

namespace sidestep::scenarios {
namespace {

// What to multiply so that a motion goes the same way, faster or slower.
template <class AnyMotion>
std::vector<double*> RatesOf(AnyMotion& motion) {
  return {&motion.speed_m_s};
}

std::vector<double*> RatesOf(AcceleratedMotion& motion) {
  std::vector<double*> rates = {&motion.speed_m_s, &motion.acceleration_m_s2};
  if (std::isfinite(motion.max_speed_m_s)) rates.push_back(&motion.max_speed_m_s);
  return rates;
}

}  // namespace

void ScaleSpeeds(Scenario& scenario, double factor) {
  if (!(factor >= 0) || !std::isfinite(factor)) {
    throw std::invalid_argument("ScaleSpeeds: the factor must be >= 0 and finite");
  }
  for (std::size_t i = 0; i < scenario.moving_obstacles.size(); ++i) {
    const auto rates = std::visit([](auto& motion) { return RatesOf(motion); },
                                  scenario.moving_obstacles[i].motion);
    for (double* const rate : rates) {
      *rate *= factor;
      if (std::abs(*rate) > YamlReader::kLargestNumber) {
        throw WrongValue(scenario, "moving_obstacles[" + std::to_string(i) + "].motion",
                         "is too fast: " + Number(factor) + " times as fast is beyond 1e12");
      }
    }
  }
}

}  // namespace sidestep::scenarios
