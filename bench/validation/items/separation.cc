// The protective separation of ISO/TS 15066, with the speeds that there were.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "sidestep/bench/validation/protective_distance.h"
#include "sidestep/bench/validation/support.h"
#include "sidestep/record/questions.h"

namespace sidestep::bench {
namespace {

constexpr double kMostShare = 0.01, kAnswer_s = 0.05, kClosingStep_s = 1e-3, kMemory_s = 2;

std::vector<Pose> Shifted(const std::vector<Pose>& X_WO, const std::vector<Pose>& before,
                          double share) {
  std::vector<Pose> shifted;
  for (std::size_t i = 0; i < X_WO.size(); ++i) {
    const Eigen::Vector3d step = X_WO[i].translation() - before[i].translation();
    shifted.push_back(Pose(X_WO[i].rotation(), X_WO[i].translation() + share * step));
  }
  return shifted;
}

// Whether the supervisor said anything within the last two seconds before `t`.
bool IsAnswered(const record::Recording& recording, double t_s) {
  return std::any_of(recording.safety.begin(), recording.safety.end(), [&](const auto& event) {
    const double at_s = event.t.seconds();
    return at_s <= t_s && at_s >= t_s - kMemory_s && event.reaction != "none";
  });
}

// Whether the tick's command is that of the quickest stop: the arm reacts already.
bool IsStopping(const control::JerkLimitedTracker& tracker, const record::Recording& recording,
                const ControlSample& tick) {
  constexpr double kSame_rad = 1e-9;
  if (&tick == &recording.control.front()) return false;
  const ControlSample& before = *std::prev(&tick);
  const control::JointPoint stop = tracker.Brake(
      {before.q_command, before.v_command, before.a_command}, (tick.t - before.t).seconds());
  return (stop.q - tick.q_command).cwiseAbs().maxCoeff() <= kSame_rad;
}

Facts MeasureSeparation(const ValidationRun& run) {
  const record::Recording& recording = run.result.recording;
  if (recording.truth.size() < 2 || !run.one.is_supervised) return {};
  const control::JerkLimitedTracker tracker = LabTracker(run.robot);
  double samples = 0, violated = 0, unanswered = 0, deepest_m = -1e9;
  double since_s = -1;
  bool was_counted = false;
  for (std::size_t i = 1; i < recording.truth.size(); ++i) {
    const TruthSample &sample = recording.truth[i], &before = recording.truth[i - 1];
    const ControlSample* const tick = record::TickAt(recording, sample.t);
    const double dt_s = (sample.t - before.t).seconds();
    if (tick == nullptr || !IsToldToMove(*tick) || dt_s <= 0) {
      since_s = -1;
      continue;
    }
    const auto distance_m = [&](const Eigen::VectorXd& q, const std::vector<Pose>& X_WO) {
      return DistanceToObstacles(run.scenario, run.robot, q, X_WO);
    };
    const double d_m = distance_m(tick->q, sample.X_WO);
    const StopFrom stop = StopOf(tracker, *tick);
    Separation separation;
    const auto closing_m_s = [&](double then_m) {
      return std::max(0.0, (d_m - then_m) / kClosingStep_s);
    };
    separation.obstacle_m_s =
        closing_m_s(distance_m(tick->q, Shifted(sample.X_WO, before.X_WO, kClosingStep_s / dt_s)));
    separation.robot_m_s =
        closing_m_s(distance_m(tick->q + kClosingStep_s * tick->v_command, sample.X_WO));
    if (IsStopping(tracker, recording, *tick)) separation.reaction_s = 0;
    separation.stop_s = stop.seconds;
    separation.stop_m = GreatestWay(run.robot, tick->q_command, stop.q_end);
    const double margin_m = d_m - ProtectiveDistance(separation);
    ++samples;
    deepest_m = std::max(deepest_m, -margin_m);
    if (margin_m >= 0) {
      since_s = -1;
      was_counted = false;
      continue;
    }
    ++violated;
    if (since_s < 0) since_s = sample.t.seconds();
    const bool is_due = sample.t.seconds() - since_s > kAnswer_s;
    if (is_due && !was_counted && !IsAnswered(recording, since_s + kAnswer_s)) {
      ++unanswered;
      was_counted = true;
    }
  }
  if (samples == 0) return {};
  return {{"separation_samples", samples},
          {"separation_violated", violated},
          {"separation_unanswered", unanswered},
          {"separation_lack_m", deepest_m}};
}

ItemFinding JudgeSeparation(const Evidence& evidence) {
  const double samples = SumOf(LargestFirst(evidence, "separation_samples", IsEnvelopeOrSoak));
  const std::vector<Told> violated =
      LargestFirst(evidence, "separation_violated", IsEnvelopeOrSoak);
  const std::vector<Told> unanswered =
      LargestFirst(evidence, "separation_unanswered", IsEnvelopeOrSoak);
  const std::vector<Told> lack = LargestFirst(evidence, "separation_lack_m", IsEnvelopeOrSoak);
  if (samples == 0) return NothingRun("the arm never moved where its clearance is known");
  ItemFinding finding;
  const double share = SumOf(violated) / samples;
  const bool passes = share <= kMostShare && SumOf(unanswered) == 0;
  finding.verdict = passes ? ItemVerdict::kPass : ItemVerdict::kFail;
  finding.evidence = fmt::format(
      "as long as the arm moved, kept for {:.2f} % of the time; {:.0f} times it was not for 50 ms, "
      "and the supervisor had not answered; at the worst {:.0f} mm were missing",
      100 * (1 - share), SumOf(unanswered), std::max(0.0, 1e3 * lack.front().value));
  finding.worst = SumOf(unanswered) > 0 ? WorstOf(unanswered, 0, "unanswered {:.0f} times")
                                        : WorstOf(lack, 0, "{:.3f} m missing");
  return finding;
}

}  // namespace

ValidationItem SeparationItem() {
  return {10,
          "protective separation",
          "kept for 99 % of the time in which the arm moves; the supervisor answers within 50 ms "
          "where not",
          "ISO/TS 15066, speed and separation monitoring, with directed speeds; who stops already "
          "has no reaction time before it",
          MeasureSeparation,
          JudgeSeparation};
}

}  // namespace sidestep::bench
