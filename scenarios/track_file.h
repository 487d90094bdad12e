#pragma once

#include <string>
#include <vector>

#include "sidestep/scenarios/recorded_track.h"

namespace sidestep::scenarios {

/// Reads a track from a CSV file: the header t,x,y,z or t,x,y,z,qw,qx,qy,qz, then a sample a line,
/// in seconds and metres of W. Text as any editor or spreadsheet writes it: with or without a
/// byte-order mark, lines ended by LF or CRLF, spaces around fields; empty lines are skipped.
/// @throws InputError FILE:LINE: COLUMN: WHY, also for fewer than 2 samples.
std::vector<TrackSample> ReadTrackFile(const std::string& path);

}  // namespace sidestep::scenarios
