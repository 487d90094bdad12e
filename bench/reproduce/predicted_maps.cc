#include "sidestep/bench/reproduce/predicted_maps.h"

#include <utility>

#include "sidestep/bench/task_pool.h"
#include "sidestep/core/observations.h"
#include "sidestep/sdf/world_model.h"

namespace sidestep::bench {
namespace {

// A field as it is at one moment.
class FrozenField final : public sdf::DistanceField {
 public:
  FrozenField(std::shared_ptr<const sdf::DistanceField> field, EpisodeTime t)
      : field_(std::move(field)), t_(t) {}

  sdf::DistanceSample Sample(const Eigen::Vector3d& p_WQ, EpisodeTime) const override {
    return field_->Sample(p_WQ, t_);
  }
  void SampleMany(const Eigen::Matrix3Xd& p_WQ, EpisodeTime,
                  sdf::DistanceSamples& samples) const override {
    field_->SampleMany(p_WQ, t_, samples);
  }
  std::unique_ptr<const sdf::FieldSlice> At(EpisodeTime) const override { return field_->At(t_); }
  double max_distance_m() const override { return field_->max_distance_m(); }

 private:
  std::shared_ptr<const sdf::DistanceField> field_;
  EpisodeTime t_;
};

Scan ToScan(const OccupancyGrid& occupancy, EpisodeTime t) {
  Scan scan;
  scan.t = t;
  scan.p_CP.resize(3, static_cast<Eigen::Index>(occupancy.CountFilled()));
  Eigen::Index filled = 0;
  const auto [nx, ny, nz] = occupancy.spec.size;
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        if (occupancy.At(i, j, k)) scan.p_CP.col(filled++) = occupancy.spec.Center(i, j, k);
      }
    }
  }
  return scan;
}

}  // namespace

PredictedMaps::PredictedMaps(const OpenLoopExperiment& experiment, const PublishedMaps& maps,
                             sdf::DistanceConvention convention, const std::string& predictor,
                             double max_distance_m, int num_jobs)
    : num_states_(experiment.num_states()) {
  sdf::WorldModelOptions options;
  options.knowledge = sdf::Knowledge::kPrediction;
  options.predictor = predictor;
  options.grid = experiment.scene.grid;
  options.max_distance_m = max_distance_m;
  options.convention = convention;
  sdf::MakeWorldModel(options);  // complains here and not in a thread

  for (const double speed_m_s : experiment.speeds_m_s) fields_.try_emplace(speed_m_s);
  std::vector<decltype(fields_)::iterator> entries;
  for (auto entry = fields_.begin(); entry != fields_.end(); ++entry) entries.push_back(entry);
  RunTasks(static_cast<int>(entries.size()), num_jobs, [&](int i) {
    auto& [speed_m_s, fields] = *entries[static_cast<std::size_t>(i)];
    const std::unique_ptr<sdf::WorldModel> world = sdf::MakeWorldModel(options);
    for (int now = 0; now < num_states_; ++now) {
      world->Observe(
          ToScan(maps.OccupancyAt(speed_m_s, now), EpisodeTime(now * experiment.scene.step_s)));
      const std::shared_ptr<const sdf::DistanceField> belief = world->MakeField();
      for (int k = 0; k < num_states_; ++k) {
        fields.push_back(
            std::make_unique<FrozenField>(belief, EpisodeTime(k * experiment.scene.step_s)));
      }
    }
  });
}

const sdf::DistanceField& PredictedMaps::At(double speed_m_s, int now, int k) const {
  return *fields_.at(speed_m_s).at(static_cast<std::size_t>(now) *
                                       static_cast<std::size_t>(num_states_) +
                                   static_cast<std::size_t>(k));
}

}  // namespace sidestep::bench
