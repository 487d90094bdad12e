#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sidestep/core/field_samples.h"
#include "sidestep/core/samples.h"
#include "sidestep/record/recording.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sdf/distance_field.h"

namespace sidestep::bench {

/// Why the fields that an episode's planner saw cannot be made again from its recording; empty if
/// they can. What scans told is recorded as filled cells, which is all there was to know from
/// sensors of solids. Cameras also told what they could not see, and tags where things are exactly.
std::string WhyNoRecordedFields(const record::Recording& recording,
                                const scenarios::Scenario& scenario);

/// Is shown the field of one planning cycle.
using RecordedFieldObserver =
    std::function<void(const CycleRecord& cycle, const sdf::DistanceField& field)>;

/// Makes those fields again, to the bit, cycle after cycle: nothing is simulated or planned.
/// @param scenario of the recording.
/// @param max_distance_m of the fields: the safety margin and the robot's largest sphere.
void RemakeFields(const record::Recording& recording, const scenarios::Scenario& scenario,
                  double max_distance_m, const RecordedFieldObserver& look);

/// The same on a grid of points, for looking at: throughout the scenario's workspace, at most
/// `most_points` along each side and no denser than its cells; of a long episode, not of every
/// cycle.
/// @param ahead_s how long after each cycle its field is asked about; each >= 0.
FieldSamples SampleRecordedFields(const record::Recording& recording,
                                  const scenarios::Scenario& scenario, double max_distance_m,
                                  const std::vector<double>& ahead_s, int most_points);

}  // namespace sidestep::bench
