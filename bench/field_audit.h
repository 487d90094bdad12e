#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/core/grid.h"
#include "sidestep/core/observations.h"
#include "sidestep/core/time.h"
#include "sidestep/robot/world_truth.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sdf/distance_field.h"
#include "sidestep/sdf/map/sdf_grid.h"

namespace sidestep::bench {

/// Where a point lies, by its true distance d. `cell` is the grid's, `margin` the field's clamp.
enum class AuditZone {
  kInside,  ///< d < 0
  kNear,    ///< 0 <= d < 1.75 cell: interpolation straddles the surface
  kMargin,  ///< 1.75 cell <= d <= margin - cell: what a planner lives on
  kEdge,    ///< margin - cell < d <= margin
  kBeyond,  ///< d > margin: the field should answer its clamp
};
inline constexpr AuditZone kAllAuditZones[] = {
    AuditZone::kInside, AuditZone::kNear, AuditZone::kMargin, AuditZone::kEdge, AuditZone::kBeyond};
/// "inside", "near", "margin", "edge", "beyond".
std::string ToString(AuditZone zone);

/// How far the field is from the truth in one zone.
struct AuditRow {
  double ahead_s = 0;  ///< how far after the cycle the field was asked about
  AuditZone zone = AuditZone::kInside;
  std::size_t num_points = 0;
  /// Of |field - min(truth, clamp)| [m].
  double median_m = 0, p99_m = 0, max_m = 0;
  /// The most that the field believes to be free beyond the truth [m], >= 0: the error that hurts.
  double too_far_max_m = 0;
  /// Of the angle between the gradients [deg], where both are defined: in kNear and kMargin.
  double gradient_median_deg = 0, gradient_p99_deg = 0, gradient_max_deg = 0;
};

/// A place, and what was said and true of it.
struct AuditPlace {
  EpisodeTime t_cycle, t;  ///< when the field was made, and what time it was asked about
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  double field_m = 0, truth_m = 0;  ///< at most the field's clamp
};

/// A field and the truth at the centres of a scenario's cells.
struct AuditGrids {
  sdf::SdfGrid field_W, truth_W;
};

/// Compares fields with the true geometry along an episode, at the same points of the grid each
/// time, drawn anew for each audit from a seed.
class FieldAudit {
 public:
  /// @param ahead_s which times are asked about, after each cycle; each >= 0.
  FieldAudit(const scenarios::Scenario& scenario, std::vector<double> ahead_s, int num_points);

  /// Compares the field of one planning cycle. Neither is asked anything afterwards.
  void Look(EpisodeTime t, const sdf::DistanceField& field, const robot::WorldTruth& truth);

  /// One row a time and a zone that had points.
  std::vector<AuditRow> Rows() const;
  /// The place outside solids and within the margin, by the truth or by the field, that was most
  /// wrong. There must have been a Look.
  const AuditPlace& worst() const { return worst_; }
  /// Everything at the time of the worst place. There must have been a Look.
  const AuditGrids& worst_grids() const { return *worst_grids_; }

 private:
  struct Errors {
    std::vector<double> distance_m, gradient_deg;
    double too_far_m = 0;
  };

  AuditZone ZoneOf(double truth_m, double clamp_m) const;
  AuditGrids GridsAt(EpisodeTime t, const sdf::DistanceField& field,
                     const robot::WorldTruth& truth) const;

  scenarios::Scenario scenario_;
  std::vector<double> ahead_s_;
  Eigen::Matrix3Xd p_WQ_;
  std::map<std::pair<std::size_t, AuditZone>, Errors> errors_;  // by time ahead and zone
  AuditPlace worst_;
  double worst_error_m_ = -1;
  std::optional<AuditGrids> worst_grids_;
};

}  // namespace sidestep::bench
