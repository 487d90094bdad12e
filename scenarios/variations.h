#pragma once

#include <string>
#include <vector>

#include "sidestep/core/yaml_reader.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::scenarios {

/// Reads the map `variations`, if there is one, draws each of its values by the scenario's seed and
/// changes the motions of all moving obstacles accordingly:
///  - `speed_factor: [LEAST, MOST]`: they all go faster or slower by one factor (ScaleSpeeds);
///  - `delay_s: [LEAST, MOST]`: they all begin (and stop) later by one time;
///  - `sideways_m: [LEAST, MOST]`: they all go their way by one distance further to the left of
///    where they go at first.
///  - `objects: [{name: NAME, ...}]`: besides, one of them alone, by speed_factor and delay_s of
///  its
///    own, by `yaw_rad: [LEAST, MOST]`, and from where it is by an offset: even, `within_m: [X, Y,
///    Z]` to either side, or normal, `deviation_m: [X, Y, Z]`. Drawn values are called NAME.KEY, of
///    an offset NAME.x_m and so on.
/// Draws are even but for that, and one does not depend on whether there is another. A scenario
/// without moving obstacles draws nothing. @throws InputError FILE:LINE: KEY: WHY.
void DrawVariations(const YamlReader& top, Scenario& scenario);

/// Puts the speed of every moving obstacle in the place of the file's; what was drawn as
/// speed_factor, of all and of it alone, multiplies it.
/// @throws InputError `--speed: WHY` where there is no moving obstacle, or one must not be so fast.
void SetSpeed(Scenario& scenario, double speed_m_s);

/// What another seed would change of an episode, by its place in the file, e.g. "sensor.dropout";
/// empty: it would be the same to the bit.
std::vector<std::string> WhatTheSeedChanges(const Scenario& scenario);

}  // namespace sidestep::scenarios
