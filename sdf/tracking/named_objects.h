#pragma once

#include <Eigen/Geometry>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/core/grid.h"
#include "sidestep/core/observations.h"
#include "sidestep/sdf/tracking/tracked_object.h"

namespace sidestep::sdf {

/// An object with a name, and how it is turned: TrackedObject keeps the axes of W.
struct NamedObject {
  std::shared_ptr<const TrackedObject> object;
  Eigen::Quaterniond R_WO = Eigen::Quaterniond::Identity();  ///< as last seen
};

/// Follows objects that a sensor names, such as those with tags: no segmentation and no
/// association, because each observation says which object it is of and what shape that has.
class NamedObjects {
 public:
  /// @param cell_m of the objects' fields, clamped at max_distance_m.
  /// @param keep_within what was seen last in these cells is not forgotten.
  NamedObjects(double cell_m, double max_distance_m,
               const std::optional<GridSpec>& keep_within = std::nullopt)
      : cell_m_(cell_m), max_distance_m_(max_distance_m), keep_within_(keep_within) {}

  /// Takes in what was seen at time t. An object that has not been seen for a second is forgotten,
  /// but for those that are kept.
  void Update(const std::vector<ObjectObservation>& objects, EpisodeTime t);

  /// Everything that is followed, in the order of first sight. The shape's own frame is O. Ids are
  /// -1, -2, ..., apart from those of things that are tracked from occupancy.
  std::vector<NamedObject> Objects() const;

 private:
  static constexpr HorizonOffset kPatience{1};  ///< for something that is not seen any more
  static constexpr HorizonOffset kMemory{2};    ///< how far back a history reaches

  struct Track {
    TrackedObject object;
    Eigen::Quaterniond R_WO;
  };

  bool IsForgotten(const TrackedObject& object, EpisodeTime t) const;

  double cell_m_, max_distance_m_;
  std::optional<GridSpec> keep_within_;
  std::map<std::string, int> ids_;  ///< of every name ever seen
  std::map<int, Track> tracks_;
};

}  // namespace sidestep::sdf
