#include <stdexcept>

#include "sidestep/bench/validation/item.h"

namespace sidestep::bench {

#define SIDESTEP_VALIDATION_ITEM(make, file) ValidationItem make();
#include "sidestep/bench/validation/items.def"
#undef SIDESTEP_VALIDATION_ITEM

namespace {

const std::vector<ValidationItem>& Items() {
  static const std::vector<ValidationItem> items = {
#define SIDESTEP_VALIDATION_ITEM(make, file) make(),
#include "sidestep/bench/validation/items.def"
#undef SIDESTEP_VALIDATION_ITEM
  };
  return items;
}

}  // namespace

const char* ToString(ItemVerdict verdict) {
  switch (verdict) {
    case ItemVerdict::kPass:
      return "pass";
    case ItemVerdict::kFail:
      return "fail";
    case ItemVerdict::kNotRun:
      break;
  }
  return "not run";
}

std::span<const ValidationItem> ValidationItems() { return Items(); }

Facts MeasureFacts(const ValidationRun& run) {
  Facts facts;
  for (const ValidationItem& item : ValidationItems()) {
    if (item.measure == nullptr) continue;
    for (const auto& [name, value] : item.measure(run)) {
      if (!facts.emplace(name, value).second) {
        throw std::logic_error("two items of a validation measure '" + name + "'");
      }
    }
  }
  return facts;
}

}  // namespace sidestep::bench
