#include "sidestep/sdf/world_model.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <utility>

#include "sidestep/sdf/composite_field.h"
#include "sidestep/sdf/map/cells_near.h"
#include "sidestep/sdf/map/grid_changes.h"
#include "sidestep/sdf/map/object_field.h"
#include "sidestep/sdf/map/static_map.h"
#include "sidestep/sdf/once_per_time.h"
#include "sidestep/sdf/prediction/registry.h"
#include "sidestep/sdf/stopwatch.h"
#include "sidestep/sdf/tracking/named_objects.h"
#include "sidestep/sdf/tracking/object_tracker.h"

namespace sidestep::sdf {
namespace {

// Frees the cells that a solid fills in scans, a quarter of a cell beyond its surface, too, where
// centres decide: a rasteriser's rounding must not leave a skin behind.
void Erase(const Shape& shape, const Pose& X_WO, CellRule rule, OccupancyGrid* grid) {
  VisitFilledCells(grid->spec, shape, X_WO, rule, grid->spec.cell_m / 4,
                   [&](std::size_t cell) { grid->cells[cell] = 0; });
}

// How far a thing can be from where it would be by itself.
double StrayAfter(double s, double a_m_s2) { return a_m_s2 * s * s / 2; }

constexpr HorizonOffset kShort(0.01);  // in which a velocity does not change

// How far off the speed of a motion may be at time t. The variance of a position that goes on with
// an uncertain velocity is a parabola in time, whose curvature is twice that of the velocity.
double SpeedSigma(const PredictedMotion& motion, EpisodeTime t, const Eigen::Vector3d& v_W) {
  if (v_W.isZero(0)) return 0;
  const Eigen::Matrix3d bend_m2 = motion.covariance_m2(t + kShort) +
                                  motion.covariance_m2(t - kShort) - 2 * motion.covariance_m2(t);
  const Eigen::Vector3d along = v_W.normalized();
  return std::sqrt(std::max(0.0, along.dot(bend_m2 * along) / 2)) / kShort.seconds();
}

// What all kinds of knowledge share: the order of scans, the grid, the static map, the clock.
class MappedWorld : public WorldModel {
 public:
  explicit MappedWorld(const WorldModelOptions& options)
      : options_(options),
        scan_map_(options.grid, options.evidence, options.views),
        static_map_(options.convention) {}

  void Observe(std::span<const Scan> scans) final {
    const auto is_late = [&](const Scan& scan) { return t_scan_ && scan.t <= *t_scan_; };
    const auto is_other = [&](const Scan& scan) { return scan.t != scans.front().t; };
    if (scans.empty() || std::any_of(scans.begin(), scans.end(), is_late) ||
        std::any_of(scans.begin(), scans.end(), is_other)) {
      throw std::invalid_argument("WorldModel: scans must come in the order of capture");
    }
    const EpisodeTime t = scans.front().t;
    Stopwatch stopwatch;
    std::vector<ObjectObservation> objects;
    rule_ = CellRule::kTouched;
    for (const Scan& scan : scans) {
      occupancy_ = &scan_map_.Update(scan);
      objects.insert(objects.end(), scan.objects.begin(), scan.objects.end());
      if (scan.kind == ScanKind::kSolid) rule_ = options_.cells;
    }
    LearnObjects(objects, t);
    // The map knows what one scan has changed of what it fills itself.
    const bool is_of_map = occupancy_ != &with_objects_;
    const bool was_of_map = std::exchange(was_of_map_, is_of_map);
    const bool is_one_scan = scans.size() == 1 && is_of_map && was_of_map;
    changed_ = changes_.Update(*occupancy_, is_one_scan ? scan_map_.may_differ() : std::nullopt);
    const OccupancyGrid& unexplained = Unexplained();
    may_differ_.reset();
    if (&unexplained == occupancy_) may_differ_ = changed_;
    times_.map_s += stopwatch.Lap();
    Learn(unexplained, t);
    t_scan_ = t;
  }

  const OccupancyGrid& Occupancy() const final { return *occupancy_; }
  std::span<const std::size_t> ChangedCells() const final { return changed_; }

  std::shared_ptr<const DistanceField> MakeField() final {
    if (!t_scan_) throw std::invalid_argument("WorldModel: no scan yet");
    Stopwatch stopwatch;
    std::shared_ptr<const SdfGrid> static_W = static_map_.Field();
    times_.map_s += stopwatch.Lap();
    auto field = Compose(std::move(static_W));
    times_.predict_s += stopwatch.Lap();
    return field;
  }

  std::vector<PredictedObject> DescribeObjects(const std::vector<EpisodeTime>&) const override {
    return {};
  }

  WorldModelTimes TakeTimes() final { return std::exchange(times_, {}); }

 protected:
  // Takes in the objects that are named at time t. To one who does not look ahead they are solids
  // like others.
  virtual void LearnObjects(const std::vector<ObjectObservation>& objects, EpisodeTime) {
    if (objects.empty()) return;
    with_objects_ = *occupancy_;
    FillObjects(objects, options_.cells, &with_objects_);
    occupancy_ = &with_objects_;
  }
  // Takes in what is filled at time t.
  virtual void Learn(const OccupancyGrid& occupancy, EpisodeTime t) = 0;
  // The field of what is static and of what moves.
  virtual std::shared_ptr<const DistanceField> Compose(std::shared_ptr<const SdfGrid> static_W) {
    return MakeComposite(std::move(static_W), {});
  }
  std::shared_ptr<const DistanceField> MakeComposite(std::shared_ptr<const SdfGrid> static_W,
                                                     std::vector<MovingField> moving) const {
    return std::make_shared<CompositeField>(std::move(static_W), std::move(moving),
                                            options_.max_distance_m, options_.exact);
  }

  // All cells of what is taken in that may not be as they were before; none: any may.
  const MayDiffer& may_differ() const { return may_differ_; }
  // Which cells solids fill in the latest scans.
  CellRule rule() const { return rule_; }

  const WorldModelOptions options_;
  ScanMap scan_map_;
  OccupancyGrid with_objects_;                       // what scans and their named objects fill
  const OccupancyGrid* occupancy_ = &with_objects_;  // by the latest scan
  StaticMap static_map_;
  std::optional<EpisodeTime> t_scan_;  // of the latest scan
  WorldModelTimes times_;

 private:
  // What is filled and not already known exactly.
  const OccupancyGrid& Unexplained() {
    if (options_.exact.shapes.empty()) return *occupancy_;
    unexplained_ = *occupancy_;
    for (const PlacedShape& known : options_.exact.shapes) {
      Erase(known.shape, known.X_WO, rule_, &unexplained_);
    }
    return unexplained_;
  }

  CellRule rule_ = CellRule::kTouched;
  OccupancyGrid unexplained_;
  bool was_of_map_ = false;  // the latest occupancy: without named objects drawn into it
  GridChanges changes_;
  std::span<const std::size_t> changed_;
  MayDiffer may_differ_;
};

// Knowledge::kStatic
class FirstSightWorld final : public MappedWorld {
 public:
  using MappedWorld::MappedWorld;

 private:
  void Learn(const OccupancyGrid& occupancy, EpisodeTime) override {
    if (!t_scan_) static_map_.Set(occupancy);
  }
};

// Knowledge::kExecuteAndUpdate
class FrozenWorld final : public MappedWorld {
 public:
  using MappedWorld::MappedWorld;

 private:
  void Learn(const OccupancyGrid& occupancy, EpisodeTime) override {
    static_map_.Set(occupancy, may_differ());
  }
};

NamedObjectsOptions OptionsOfNamed(const WorldModelOptions& options) {
  NamedObjectsOptions named;
  named.cell_m = options.grid.cell_m;
  named.max_distance_m = options.max_distance_m + LargestGrowth(options);
  named.coast = options.coast;
  if (options.remembers_lost) named.keep_within = options.grid;
  if (options.gates_named_objects) named.gates = GatesOfTags(options.max_speed_m_s, options.coast);
  return named;
}

// Knowledge::kPrediction
class PredictedWorld final : public MappedWorld {
 public:
  explicit PredictedWorld(const WorldModelOptions& options)
      : MappedWorld(options),
        predictor_(MakePredictor(options.predictor)),
        tracker_(options.grid, {.max_distance_m = options.max_distance_m + LargestGrowth(options),
                                .max_speed_m_s = options.max_speed_m_s,
                                .least_cells = options.evidence.least_cells,
                                .convention = options.convention,
                                .coast = options.coast}),
        named_objects_(OptionsOfNamed(options)) {}

  std::vector<PredictedObject> DescribeObjects(
      const std::vector<EpisodeTime>& times) const override {
    std::vector<PredictedObject> described;
    for (const auto& [object, motion] : believed_) {
      PredictedObject& box = described.emplace_back();
      box.id = object->id;
      box.half_extents_m = object->box_half_extents_m;
      box.t = times;
      const Pose X_OBox = Pose::Translation(object->box_center_O);
      for (const EpisodeTime t : times) box.X_WO.push_back(motion.X_WO(t) * X_OBox);
    }
    return described;
  }

  std::vector<TrackEvent> TakeEvents() override {
    std::vector<TrackEvent> events = named_objects_.TakeEvents();
    for (TrackEvent& event : tracker_.TakeEvents()) events.push_back(std::move(event));
    return events;
  }

  std::vector<ObstacleState> MovingNow() const override {
    std::vector<ObstacleState> moving;
    const auto add = [&](const TrackedObject& object, const Eigen::Quaterniond& R_WO) {
      const PredictedMotion motion = predictor_->Predict(object);
      const Pose turn(R_WO, Eigen::Vector3d::Zero());
      ObstacleState& state = moving.emplace_back();
      state.id = object.id;
      state.t = object.latest().t;
      const Pose X_WO = motion.X_WO(state.t), X_WO_later = motion.X_WO(state.t + kShort);
      state.X_WO = X_WO * turn * Pose::Translation(object.box_center_O);
      state.half_extents_m = object.box_half_extents_m;
      state.v_W = (X_WO_later.translation() - X_WO.translation()) / kShort.seconds();
      state.speed_sigma_m_s = SpeedSigma(motion, state.t, state.v_W);
    };
    for (const auto& [object, R_WO, has_left] : named_objects_.Objects()) {
      add(*object, R_WO);
      moving.back().has_left = has_left;
    }
    for (const auto& object : tracker_.MovingObjects()) {
      add(*object, Eigen::Quaterniond::Identity());
    }
    return moving;
  }

 private:
  struct Belief {
    std::shared_ptr<const TrackedObject> object;
    PredictedMotion motion;
  };

  // How much thicker a thing is taken to be: for what is not known of it, and for what it may do.
  std::function<double(EpisodeTime)> Growth(const Belief& belief) const {
    const auto doubt_m = [sigmas = options_.growth_sigmas, limit_m = options_.growth_limit_m,
                          covariance_m2 = belief.motion.covariance_m2](EpisodeTime t) {
      if (sigmas == 0) return 0.0;
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance_m2(t),
                                                                Eigen::EigenvaluesOnly);
      return std::min(sigmas * std::sqrt(std::max(0.0, axes.eigenvalues()(2))), limit_m);
    };
    const auto stray_m = [a_m_s2 = options_.stray_m_s2, most_s = options_.stray_s,
                          seen = belief.object->latest().t](EpisodeTime t) {
      return StrayAfter(std::clamp((t - seen).seconds(), 0.0, most_s), a_m_s2);
    };
    return [=](EpisodeTime t) { return doubt_m(t) + stray_m(t); };
  }

  void LearnObjects(const std::vector<ObjectObservation>& objects, EpisodeTime t) override {
    named_objects_.Update(objects, t);
  }

  void Learn(const OccupancyGrid& occupancy, EpisodeTime t) override {
    const TrackerTimes times =
        tracker_.Update(occupancy, t, {scan_map_.seen(), scan_map_.once_free()}, may_differ());
    times_.segment_s += times.segment_s;
    times_.track_s += times.track_s;
    Stopwatch stopwatch;
    static_map_.Set(tracker_.static_occupancy(), tracker_.static_may_differ());
    times_.map_s += stopwatch.Lap();
  }

  std::shared_ptr<const DistanceField> Compose(std::shared_ptr<const SdfGrid> static_W) override {
    believed_.clear();
    for (const auto& [object, R_WO, has_left] : named_objects_.Objects()) {
      PredictedMotion motion = predictor_->Predict(*object);
      const Pose turn(R_WO, Eigen::Vector3d::Zero());
      motion.X_WO = [X_WO = motion.X_WO, turn](EpisodeTime t) { return X_WO(t) * turn; };
      believed_.push_back({object, std::move(motion)});
    }
    for (const auto& object : tracker_.MovingObjects()) {
      believed_.push_back({object, predictor_->Predict(*object)});
    }
    std::vector<MovingField> moving;
    for (const Belief& belief : believed_) {
      MovingField& field =
          moving.emplace_back(MovingField{belief.object->field_O, belief.motion.X_WO});
      if (LargestGrowth(options_) == 0) continue;
      field.max_growth_m = LargestGrowth(options_);
      field.growth_m = OncePerTime<double>(Growth(belief));
    }
    return MakeComposite(std::move(static_W), std::move(moving));
  }

  std::unique_ptr<const ObstaclePredictor> predictor_;
  ObjectTracker tracker_;
  NamedObjects named_objects_;
  std::vector<Belief> believed_;  // in the latest field
};

// Knowledge::kFullKnowledge
class KnownWorld final : public MappedWorld {
 public:
  explicit KnownWorld(const WorldModelOptions& options) : MappedWorld(options) {
    for (const MovingShape& obstacle : *options_.true_obstacles) {
      fields_.push_back(std::make_shared<const SdfGrid>(
          MakeShapeField(obstacle.shape, options_.grid.cell_m, options_.max_distance_m)));
    }
  }

  std::vector<PredictedObject> DescribeObjects(
      const std::vector<EpisodeTime>& times) const override {
    std::vector<PredictedObject> described;
    for (const MovingShape& obstacle : *options_.true_obstacles) {
      PredictedObject& box = described.emplace_back();
      box.id = static_cast<int>(described.size());
      box.half_extents_m = HalfExtents(obstacle.shape);
      box.t = times;
      for (const EpisodeTime t : times) box.X_WO.push_back(obstacle.X_WO(t));
    }
    return described;
  }

 private:
  void LearnObjects(const std::vector<ObjectObservation>&, EpisodeTime) override {}  // it is known

  void Learn(const OccupancyGrid& occupancy, EpisodeTime t) override {
    Stopwatch stopwatch;
    OccupancyGrid still = occupancy;
    for (const MovingShape& obstacle : *options_.true_obstacles) {
      Erase(obstacle.shape, obstacle.X_WO(t), rule(), &still);
    }
    static_map_.Set(still);
    times_.map_s += stopwatch.Lap();
  }

  std::shared_ptr<const DistanceField> Compose(std::shared_ptr<const SdfGrid> static_W) override {
    std::vector<MovingField> moving;
    for (std::size_t n = 0; n < fields_.size(); ++n) {
      moving.push_back({fields_[n], (*options_.true_obstacles)[n].X_WO});
    }
    return MakeComposite(std::move(static_W), std::move(moving));
  }

  std::vector<std::shared_ptr<const SdfGrid>> fields_;  // one an obstacle
};

struct KnowledgeWord {
  Knowledge knowledge;
  const char* word;
};
constexpr KnowledgeWord kKnowledgeWords[] = {{Knowledge::kStatic, "static"},
                                             {Knowledge::kExecuteAndUpdate, "execute_and_update"},
                                             {Knowledge::kPrediction, "prediction"},
                                             {Knowledge::kFullKnowledge, "full_knowledge"}};

}  // namespace

double LargestGrowth(const WorldModelOptions& options) {
  const double doubt_m = options.growth_sigmas > 0 ? options.growth_limit_m : 0;
  return doubt_m + StrayAfter(options.stray_s, options.stray_m_s2);
}

std::string ToString(Knowledge knowledge) {
  for (const KnowledgeWord& entry : kKnowledgeWords) {
    if (entry.knowledge == knowledge) return entry.word;
  }
  throw std::invalid_argument("not a kind of knowledge");
}

Knowledge KnowledgeFromString(const std::string& word) {
  for (const KnowledgeWord& entry : kKnowledgeWords) {
    if (entry.word == word) return entry.knowledge;
  }
  throw std::invalid_argument("unknown knowledge '" + word +
                              "'; there are: static, execute_and_update, prediction, "
                              "full_knowledge");
}

std::unique_ptr<WorldModel> MakeWorldModel(const WorldModelOptions& options) {
  CheckGridSpec(options.grid);
  if (!(options.max_distance_m > 0)) {
    throw std::invalid_argument("WorldModel: max_distance_m must be > 0");
  }
  if (!(options.coast.seconds() >= 0) || !(options.max_speed_m_s > 0)) {
    throw std::invalid_argument("WorldModel: coast must be >= 0 and max_speed_m_s > 0");
  }
  if (!(options.growth_sigmas >= 0) || !(options.growth_limit_m >= 0) ||
      !(options.stray_m_s2 >= 0) || !(options.stray_s >= 0)) {
    throw std::invalid_argument("WorldModel: growth must be >= 0");
  }
  MakePredictor(options.predictor);  // A wrong name is wrong even where it is not used.
  switch (options.knowledge) {
    case Knowledge::kStatic:
      return std::make_unique<FirstSightWorld>(options);
    case Knowledge::kExecuteAndUpdate:
      return std::make_unique<FrozenWorld>(options);
    case Knowledge::kPrediction:
      return std::make_unique<PredictedWorld>(options);
    case Knowledge::kFullKnowledge:
      if (!options.true_obstacles) {
        throw std::invalid_argument("WorldModel: full_knowledge needs true_obstacles");
      }
      return std::make_unique<KnownWorld>(options);
  }
  throw std::invalid_argument("WorldModel: not a kind of knowledge");
}

}  // namespace sidestep::sdf
