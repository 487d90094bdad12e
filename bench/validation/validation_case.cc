#include "sidestep/bench/validation/validation_case.h"

#include "sidestep/core/joined.h"
#include "sidestep/core/number_text.h"

namespace sidestep::bench {

Factors FactorsOf(const ValidationCase& one) {
  return {{"case", NameOf(one)},
          {"group", one.group},
          {"behaviour", one.behaviour},
          {"speed_m_s", ShortestText(one.speed_m_s)},
          {"perception", one.perception},
          {"timing", one.timing},
          {"fault", one.fault},
          {"knowledge", one.knowledge},
          {"world", one.on_the_wire ? "wire" : "simulation"},
          {"draw", std::to_string(one.draw)}};
}

std::string NameOf(const ValidationCase& one) {
  std::vector<std::string> words = {one.group, one.behaviour, ShortestText(one.speed_m_s)};
  if (one.perception != "nominal") words.push_back(one.perception);
  if (one.timing != "nominal") words.push_back(one.timing);
  if (one.fault != "none") words.push_back(one.fault);
  if (one.group == validation_group::kPrediction) words.push_back(one.knowledge);
  if (one.on_the_wire) words.emplace_back("wire");
  words.push_back(std::to_string(one.draw));
  return Joined(words, ":");
}

}  // namespace sidestep::bench
