#pragma once

#include <span>
#include <string>

#include "sidestep/bench/validation/faulty_sensor.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench {

/// How well the world is seen.
struct Perception {
  const char* name;
  double noise = 1;         ///< times that of the sensor
  double latency_s = 0.06;  ///< a camera at 30 Hz: 40 to 70 ms from photon to pose
  double dropout = 0;
  SensorFaults faults = {};
};

/// All there are; the first is the nominal one. To add one: a row of the table in perception.cc.
std::span<const Perception> Perceptions();
/// @throws std::invalid_argument for an unknown name.
const Perception& PerceptionOf(const std::string& name);

/// Whether the scenario's sensor is one whose noise can be scaled.
bool HasNoiseModel(const scenarios::Scenario& scenario);

/// Gives the scenario such a sensor as a robot can have: one that is told the occupancy of the
/// world, which none is, is replaced by a model of a camera that finds tags.
void SetLikelySensor(scenarios::Scenario& scenario);

/// ... and makes it see so. Its faults are left to FaultySensor.
void SetPerception(const Perception& perception, scenarios::Scenario& scenario);

}  // namespace sidestep::bench
