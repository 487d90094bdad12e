#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sidestep/core/pose.h"
#include "sidestep/sdf/aligned_vector.h"
#include "sidestep/sdf/distance_field.h"
#include "sidestep/sdf/exact_solids.h"
#include "sidestep/sdf/field_kernels.h"
#include "sidestep/sdf/map/sdf_grid.h"

namespace sidestep::sdf {

/// Where an object's field has something to say: outside the box, the field is nowhere lower than
/// the distance to the box less `slack_m`.
///
/// The box and its slack are found at the grid's cell centres. Between them the statement holds as
/// well: the distance to a box is convex, so it lies below its own trilinear interpolant, and that
/// lies below the field's.
struct FieldBound {
  Eigen::Vector3d low_O, high_O;
  double slack_m = 0;
};
/// The box around the cells that are not free. Costs a look at each cell.
FieldBound TightBound(const SdfGrid& field_O);
/// The domain of the grid: outside, the field is not asked at all. Costs nothing.
FieldBound DomainBound(const SdfGrid& field_O);

/// An object at a pose. The field must outlive it.
struct PlacedObject {
  const SdfGrid* field_O = nullptr;
  FieldBound bound;
  Pose X_WO;
  double growth_m = 0;  ///< by how much it is taken to be thicker all round
};

/// S points, and what a field says of them, as structures of arrays: each coordinate contiguous.
using PointColumns = Eigen::MatrixX3d;  // S x 3
struct SampleColumns {
  Eigen::VectorXd distance_m;   ///< S
  Eigen::MatrixX3d gradient_W;  ///< S x 3
  int num_outside = 0;
};

/// A composite field at one moment (see CompositeField, which makes it): a static grid, solids
/// known exactly, objects at their poses, a clamp.
///
/// A query looks at those objects alone that can lower its answer. For few, that is a test of each
/// box; many are tested 4 to 16 at a time, as the machine has it, against the answer so far, and
/// their boxes are tight. Batches go through SIMD kernels, a vector of points at a time, and answer
/// to the last bit what single queries do, on every machine.
class PlacedComposite final : public FieldSlice {
 public:
  /// From how many objects on tight bounds are worth their cost.
  static constexpr std::size_t kMany = 16;

  /// @param static_W must outlive this, and so must the solids, of which there need be none.
  PlacedComposite(const SdfGrid& static_W, std::span<const PlacedObject> objects,
                  double max_distance_m, const ExactSolids* solids = nullptr);

  /// As DistanceField has it.
  DistanceSample Sample(const Eigen::Vector3d& p_WQ) const;
  /// Equal to S single calls.
  void SampleMany(const Eigen::Matrix3Xd& p_WQ, DistanceSamples& samples) const;
  void SampleMany(const PointColumns& p_WQ, SampleColumns& samples) const;
  int SampleBlock(PointBlock& block) const override;

 private:
  struct Object {
    explicit Object(const PlacedObject& given);

    const SdfGrid* field_O;
    bool readable;  // by the kernels
    field_kernels::Placed placed;
    Eigen::Vector3d low_W, high_W;  // of the box around its bound
    double slack_m;
  };

  // Whether the object can be nearer than `distance_m` to a point this far from its box.
  static bool CanBeNearer(const Object& object, double squared_m2, double distance_m);
  static void Lower(const Object& object, const Eigen::Vector3d& p_WQ, DistanceSample& sample);
  void LowerByMany(const Eigen::Vector3d& p_WQ, DistanceSample& sample) const;
  static void LowerEach(const Object& object, field_kernels::Block& block);

  const SdfGrid& static_W_;
  bool static_readable_;
  field_kernels::Grid static_view_;
  double max_distance_m_;
  const ExactSolids* solids_;  // or null
  std::vector<Object> objects_;
  using BoxLanes = std::array<AlignedVector<float>, 7>;  // as field_kernels::Boxes has them
  std::unique_ptr<BoxLanes> box_lanes_;                  // of many objects
};

}  // namespace sidestep::sdf
