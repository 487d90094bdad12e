#pragma once

#include <string>
#include <vector>

#include "sidestep/bench/database/run_files.h"
#include "sidestep/bench/reproduce/open_loop_experiment.h"
#include "sidestep/bench/reproduce/open_loop_study.h"

namespace sidestep::bench {

/// The study as runs: a pair at a speed under one kind of knowledge each, in the order of the
/// published rows. Factors are the speed and the knowledge. The seed is the number of the pair: it
/// is pairs that were sampled, and the runs of one resemble each other (docs/paper.md).
/// The outcome is that of the verdict `published_states`, goal or collision; of the metrics there
/// are `gp_cost`, the published one, and `min_clearance_m`, the true one of the whole motion.
/// @param predictor under `prediction`.
std::vector<SingleRun> OpenLoopRuns(const OpenLoopExperiment& experiment,
                                    const OpenLoopStudy& study, const std::string& predictor);

}  // namespace sidestep::bench
