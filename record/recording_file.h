#pragma once

#include <string>

#include "sidestep/record/recording.h"

namespace sidestep::record {

/// Version of the HDF5 library, e.g. "1.10.8".
std::string Hdf5Version();

/// Writes `recording` as HDF5 (layout: docs/trace.md). Equal recordings give equal bytes.
/// @throws InputError if the file cannot be written.
void WriteRecording(const Recording& recording, const std::string& path);

/// Reads it back. @throws InputError, naming the file and what is wrong, if the file is missing,
/// not HDF5, cut off, or not a recording of this version.
Recording ReadRecording(const std::string& path);

}  // namespace sidestep::record
