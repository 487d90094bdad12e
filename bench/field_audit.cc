#include "sidestep/bench/field_audit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "sidestep/bench/statistics.h"
#include "sidestep/bench/true_world.h"
#include "sidestep/core/random.h"

namespace sidestep::bench {
namespace {

constexpr double kNearCells = 1.75;

// Below every error, so that a place inside solids is the worst only where there is no other.
constexpr double kInsideRank_m = -0.5;

double AngleDeg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI;
}

}  // namespace

std::string ToString(AuditZone zone) {
  switch (zone) {
    case AuditZone::kInside:
      return "inside";
    case AuditZone::kNear:
      return "near";
    case AuditZone::kMargin:
      return "margin";
    case AuditZone::kEdge:
      return "edge";
    case AuditZone::kBeyond:
      return "beyond";
  }
  return "";
}

FieldAudit::FieldAudit(const scenarios::Scenario& scenario, std::vector<double> ahead_s,
                       int num_points)
    : scenario_(scenario), ahead_s_(std::move(ahead_s)), p_WQ_(3, num_points) {
  const GridSpec& grid = scenario_.grid;
  CheckGridSpec(grid);
  const bool in_order = std::all_of(ahead_s_.begin(), ahead_s_.end(),
                                    [](double s) { return std::isfinite(s) && s >= 0; });
  if (ahead_s_.empty() || !in_order || num_points < 1) {
    throw std::invalid_argument("field audit: needs times >= 0 ahead, and points");
  }
  RandomStream random(scenario_.seed, "field audit");
  for (int s = 0; s < num_points; ++s) {
    for (int a = 0; a < 3; ++a) {
      const double last = grid.size[static_cast<std::size_t>(a)] - 1;
      p_WQ_(a, s) = grid.first_center_m(a) + grid.cell_m * last * random.Uniform();
    }
  }
}

AuditZone FieldAudit::ZoneOf(double truth_m, double clamp_m) const {
  const double cell_m = scenario_.grid.cell_m;
  if (truth_m < 0) return AuditZone::kInside;
  if (truth_m < kNearCells * cell_m) return AuditZone::kNear;
  if (truth_m <= clamp_m - cell_m) return AuditZone::kMargin;
  return truth_m <= clamp_m ? AuditZone::kEdge : AuditZone::kBeyond;
}

void FieldAudit::Look(EpisodeTime t, const sdf::DistanceField& field,
                      const robot::WorldTruth& truth) {
  const double clamp_m = field.max_distance_m();
  const double worst_before_m = worst_error_m_;
  sdf::DistanceSamples samples;
  for (std::size_t n = 0; n < ahead_s_.size(); ++n) {
    const EpisodeTime asked = t + HorizonOffset(ahead_s_[n]);
    const sdf::ShapeField world = TrueWorldAt(scenario_, truth.ObstaclesAt(asked));
    field.SampleMany(p_WQ_, asked, samples);
    for (Eigen::Index s = 0; s < p_WQ_.cols(); ++s) {
      const sdf::DistanceSample exact = world.Sample(p_WQ_.col(s), asked);
      const AuditZone zone = ZoneOf(exact.distance_m, clamp_m);
      const double truth_m = std::min(exact.distance_m, clamp_m);
      const double error_m = std::abs(samples.distance_m(s) - truth_m);
      Errors& errors = errors_[{n, zone}];
      errors.distance_m.push_back(error_m);
      errors.too_far_m = std::max(errors.too_far_m, samples.distance_m(s) - truth_m);
      const Eigen::Vector3d gradient_W = samples.gradient_W.col(s);
      if ((zone == AuditZone::kNear || zone == AuditZone::kMargin) && !gradient_W.isZero(0)) {
        errors.gradient_deg.push_back(AngleDeg(gradient_W, exact.gradient_W));
      }
      const double rank_m = zone == AuditZone::kInside ? kInsideRank_m : error_m;
      if (rank_m <= worst_error_m_) continue;
      worst_error_m_ = rank_m;
      worst_ = {t, asked, p_WQ_.col(s), samples.distance_m(s), truth_m};
    }
  }
  if (worst_error_m_ > worst_before_m) worst_grids_ = GridsAt(worst_.t, field, truth);
}

std::vector<AuditRow> FieldAudit::Rows() const {
  std::vector<AuditRow> rows;
  for (const auto& [key, errors] : errors_) {
    AuditRow& row = rows.emplace_back();
    row.ahead_s = ahead_s_[key.first];
    row.zone = key.second;
    row.num_points = errors.distance_m.size();
    row.median_m = Quantile(errors.distance_m, 0.5);
    row.p99_m = Quantile(errors.distance_m, 0.99);
    row.max_m = Quantile(errors.distance_m, 1);
    row.too_far_max_m = errors.too_far_m;
    row.gradient_median_deg = Quantile(errors.gradient_deg, 0.5);
    row.gradient_p99_deg = Quantile(errors.gradient_deg, 0.99);
    row.gradient_max_deg = Quantile(errors.gradient_deg, 1);
  }
  return rows;
}

AuditGrids FieldAudit::GridsAt(EpisodeTime t, const sdf::DistanceField& field,
                               const robot::WorldTruth& truth) const {
  const GridSpec& grid = scenario_.grid;
  const sdf::ShapeField world = TrueWorldAt(scenario_, truth.ObstaclesAt(t));
  const double clamp_m = field.max_distance_m();
  sdf::AlignedVector<float> field_m, truth_m;
  field_m.reserve(grid.num_cells());
  truth_m.reserve(grid.num_cells());
  Eigen::Matrix3Xd p_WQ(3, grid.size[0]);  // a row at a time
  sdf::DistanceSamples samples;
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) p_WQ.col(i) = grid.Center(i, j, k);
      field.SampleMany(p_WQ, t, samples);
      for (int i = 0; i < grid.size[0]; ++i) {
        field_m.push_back(static_cast<float>(samples.distance_m(i)));
        truth_m.push_back(static_cast<float>(std::min(world.Distance(p_WQ.col(i), t), clamp_m)));
      }
    }
  }
  return {sdf::SdfGrid(grid, std::move(field_m)), sdf::SdfGrid(grid, std::move(truth_m))};
}

}  // namespace sidestep::bench
