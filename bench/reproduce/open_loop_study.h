#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "sidestep/bench/reproduce/open_loop.h"
#include "sidestep/bench/reproduce/open_loop_experiment.h"
#include "sidestep/bench/reproduce/true_clearance.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/sdf/world_model.h"

namespace sidestep::bench {

/// Which part of an experiment to run, and how. Other speeds, sigmas, margins and numbers of
/// interpolated costs are set in the experiment itself.
struct OpenLoopStudyOptions {
  std::vector<sdf::Knowledge> cases = {sdf::Knowledge::kStatic, sdf::Knowledge::kExecuteAndUpdate,
                                       sdf::Knowledge::kFullKnowledge};
  std::vector<int> pairs = {};          ///< counted from 1, as published; empty: all
  std::string predictor = "two_frame";  ///< under `prediction`; a name of sdf/prediction/registry.h
  bool once = false;  ///< static and full_knowledge are solved once only, as the paper says
  /// Static boxes where the authors meant them (BoxAlignment::kIntended) and the product's own
  /// robot, whose mount spheres are ignored: it stands in its table by the published ones.
  bool intended_geometry = false;
  int num_jobs = 1;  ///< threads; the result does not depend on it
};

/// One row of the published tables: a pair at a speed, under every kind of knowledge that was run.
struct OpenLoopRow {
  struct Case {
    OpenLoopResult result;
    TrueClearance clearance;  ///< by the product's own robot and the boxes as they were meant
  };
  int pair = 0;
  double speed_m_s = 0;
  std::map<sdf::Knowledge, Case> cases;
};

struct OpenLoopStudy {
  std::vector<OpenLoopRow> rows;     ///< by pair, then by speed
  std::vector<int> ignored_spheres;  ///< of the robot, in planning and in the verdict
};

/// @param models_dir the folder of robots.
/// @param on_row called after each row with the numbers of rows done and in all, from any thread,
/// one call at a time.
/// @throws std::invalid_argument for a pair that the experiment does not have.
OpenLoopStudy RunOpenLoopStudy(const OpenLoopExperiment& experiment, const std::string& models_dir,
                               const OpenLoopStudyOptions& options,
                               const std::function<void(int done, int all)>& on_row = {});

}  // namespace sidestep::bench
