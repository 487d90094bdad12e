#pragma once

#include <string>

#include "sidestep/bench/episode_recorder.h"
#include "sidestep/bench/run_identity.h"
#include "sidestep/core/samples.h"
#include "sidestep/record/journal.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sim/fci/panda_plant.h"
#include "sidestep/sim/fci/simulated_panda.h"

namespace sidestep::cli {

/// A trace of what truly happened in the world of a robot server, whatever its clients were told:
/// the reference that the arm followed, its motion, contacts and clearance. Times are the world's.
class ServerTrace {
 public:
  /// @param number of the client whose world it is, from 1: the file is trace.h5, trace_2.h5, ...
  /// @param robot must outlive this. @throws InputError if `out` cannot take the files.
  ServerTrace(const std::string& out, int number, const scenarios::Scenario& scenario,
              const robot::RobotModel& robot, const std::string& model_xml,
              const bench::RunIdentity& identity);

  /// After each step of the plant.
  void Keep(const sim::fci::PandaPlant& plant, const sim::fci::SimulatedPanda& panda);
  void Keep(const TruthSample& sample) { recorder_.Keep(sample); }

  /// Writes the file. Call once, last. @return its path.
  std::string Write();

 private:
  const std::string name_, out_;
  const bench::RunIdentity identity_;
  bench::EpisodeRecorder recorder_;
  record::Journal journal_;
};

}  // namespace sidestep::cli
