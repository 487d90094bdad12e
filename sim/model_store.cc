#include "sidestep/sim/model_store.h"

#include <algorithm>
#include <utility>

namespace sidestep::sim {

MujocoModelPtr ModelStore::Load(const std::string& xml, const std::string& name) {
  const std::lock_guard lock(mutex_);
  const auto known =
      std::find_if(kept_.begin(), kept_.end(), [&](const Kept& kept) { return kept.xml == xml; });
  if (known != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, known);
  } else {
    MujocoModelPtr model = LoadMujocoModel(xml, name);
    ++num_compiled_;
    kept_.push_front({xml, std::move(model)});
    if (kept_.size() > kMostKept) kept_.pop_back();
  }
  return MujocoModelPtr(mj_copyModel(nullptr, kept_.front().model.get()));
}

}  // namespace sidestep::sim
