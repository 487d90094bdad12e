#pragma once

#include <mujoco/mujoco.h>

#include <vector>

namespace sidestep::sim {

/// How far geoms have come since a moment: what bounds by how much the distances between them can
/// have changed, without measuring them again.
class GeomShift {
 public:
  /// @param model must outlive this.
  GeomShift(const mjModel& model, std::vector<int> geoms);

  /// The moment is now.
  void Begin(const mjData& data);
  /// No point of any of the geoms has come further than this [m]; infinite before Begin, and where
  /// an unbounded geom (a plane) has moved.
  double Most_m(const mjData& data) const;

 private:
  const mjModel& model_;
  std::vector<int> geoms_;
  std::vector<mjtNum> frames_;  // position and matrix of each, at that moment
};

}  // namespace sidestep::sim
