#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "sidestep/sim/mujoco_model.h"

namespace sidestep::sim {

/// Compiled models by their texts, for who makes one world after the other: those whose text is the
/// same, as are the runs of a sweep that differ in their seeds alone, are compiled once. Safe from
/// many threads.
class ModelStore {
 public:
  static constexpr std::size_t kMostKept = 4;

  /// What LoadMujocoModel makes of the text, one's own: to the bit the same, be it compiled or
  /// copied. @throws InputError likewise.
  MujocoModelPtr Load(const std::string& xml, const std::string& name);

  int num_compiled() const { return num_compiled_; }

 private:
  struct Kept {
    std::string xml;
    MujocoModelPtr model;
  };
  std::mutex mutex_;
  std::list<Kept> kept_;  // the one that was asked for last comes first
  int num_compiled_ = 0;
};

}  // namespace sidestep::sim
