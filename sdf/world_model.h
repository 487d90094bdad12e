#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sidestep/core/cell_touch.h"
#include "sidestep/core/grid.h"
#include "sidestep/core/observations.h"
#include "sidestep/core/obstacle_state.h"
#include "sidestep/core/samples.h"
#include "sidestep/core/solid.h"
#include "sidestep/core/time.h"
#include "sidestep/sdf/distance_field.h"
#include "sidestep/sdf/map/distance_transform.h"
#include "sidestep/sdf/map/scan_map.h"
#include "sidestep/sdf/shape_field.h"

namespace sidestep::sdf {

/// What the planner is told about the moving world.
enum class Knowledge {
  kStatic,            ///< the world as first seen, never updated
  kExecuteAndUpdate,  ///< the world as it is at each re-plan, frozen
  kPrediction,        ///< tracked from occupancy and extrapolated
  kFullKnowledge,     ///< the true future: the upper bound
};
/// "static", "execute_and_update", "prediction", "full_knowledge".
std::string ToString(Knowledge knowledge);
/// @throws std::invalid_argument for another word.
Knowledge KnowledgeFromString(const std::string& word);
inline constexpr Knowledge kAllKnowledge[] = {Knowledge::kStatic, Knowledge::kExecuteAndUpdate,
                                              Knowledge::kPrediction, Knowledge::kFullKnowledge};

struct WorldModelOptions {
  Knowledge knowledge = Knowledge::kPrediction;
  std::string predictor = "kalman_cv";      ///< a name of sdf/prediction/registry.h
  std::map<std::string, CameraView> views;  ///< of sensors that see surfaces, by name
  EvidenceOptions evidence;                 ///< of their scans
  /// Under prediction, moving things are taken to be thicker by so many standard deviations of
  /// where they are predicted to be, in the worst direction, but by no more than the limit [m].
  double growth_sigmas = 0, growth_limit_m = 0.1;
  /// And by as far as they can stray from there if their velocity changes by no more than this
  /// [m/s^2], reckoned for at most so long [s]: by then one has looked again, or has stopped. What
  /// is near already is not thought to be touched, but to be left.
  double stray_m_s2 = 0, stray_s = 0;
  /// How long what is not seen goes on as predicted, and what is faster from one scan to the next
  /// than anything that is followed (sdf/tracking/).
  HorizonOffset coast{1};
  double max_speed_m_s = 4;
  /// Named objects may be wrong, and pass gates (sdf/tracking/named_objects.h); else whoever names
  /// them has judged them. Only what predicts follows them.
  bool gates_named_objects = false;
  /// A named object that was seen last inside the grid is not forgotten: it is somewhere near.
  bool remembers_lost = false;
  GridSpec grid;              ///< in W
  double max_distance_m = 0;  ///< fields are clamped here: safety margin + largest sphere
  /// Of fields made from cells; full_knowledge has the true shapes of what moves.
  DistanceConvention convention = DistanceConvention::kSurface;
  /// What is known of the world before anything is seen, and better than by cells: the floor;
  /// static things. It is in every field, whatever the knowledge and also outside the grid, and the
  /// cells that its shapes explain are left out of the map.
  StaticSolids exact;
  /// Which cells solids fill in scans of solids (in those of surfaces, the cells of their surface):
  /// named objects are drawn by it, and what is known otherwise is erased by it.
  CellRule cells = CellRule::kTouched;
  /// Every moving obstacle with its true motion, as values; must be set for full_knowledge.
  std::optional<std::vector<MovingShape>> true_obstacles;
};

/// By how much moving things are taken to be thicker at most [m].
double LargestGrowth(const WorldModelOptions& options);

/// CPU seconds that the stages of one planning cycle took, for the report only.
struct WorldModelTimes {
  double map_s = 0, segment_s = 0, track_s = 0, predict_s = 0;
};

/// Turns scans into one DistanceField for each planning cycle, under one kind of knowledge.
class WorldModel {
 public:
  virtual ~WorldModel() = default;

  /// Takes in the scans, of one sensor or several, that were captured at one moment; moments come
  /// in their order.
  /// @throws std::invalid_argument for none, or of a moment that is not after the last.
  virtual void Observe(std::span<const Scan> scans) = 0;
  void Observe(const Scan& scan) { Observe({&scan, 1}); }

  /// What is filled after the latest scans, in the grid of the options.
  virtual const OccupancyGrid& Occupancy() const = 0;
  /// The cells of it that are not as they were before the latest scans, ascending; before there was
  /// any, all were free.
  virtual std::span<const std::size_t> ChangedCells() const = 0;

  /// The belief after the latest scan, as an immutable snapshot. Needs at least one scan.
  virtual std::shared_ptr<const DistanceField> MakeField() = 0;

  /// The objects in the latest field and where they are believed to be at `times`, for the record.
  virtual std::vector<PredictedObject> DescribeObjects(
      const std::vector<EpisodeTime>& times) const = 0;

  /// What moves, as it was at the latest scan; nothing where nothing is tracked.
  virtual std::vector<ObstacleState> MovingNow() const { return {}; }

  /// What tracking has noticed since the last call, in order; nothing where nothing is tracked.
  virtual std::vector<TrackEvent> TakeEvents() { return {}; }

  /// What the stages have cost since the last call.
  virtual WorldModelTimes TakeTimes() = 0;
};

/// @throws std::invalid_argument for an unknown predictor, a bad grid, a margin <= 0, or
/// full_knowledge without true_obstacles.
std::unique_ptr<WorldModel> MakeWorldModel(const WorldModelOptions& options);

}  // namespace sidestep::sdf
