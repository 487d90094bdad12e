#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "sidestep/record/recording.h"

namespace sidestep::record {

/// Version of the HDF5 library, e.g. "1.10.8".
std::string Hdf5Version();

/// Of the format of a trace.
inline constexpr int kTraceVersion = 4;

/// Writes `recording` as HDF5 (layout: docs/trace.md). Equal recordings give equal bytes.
/// @throws InputError if the file cannot be written.
void WriteRecording(const Recording& recording, const std::string& path);

/// Reads it back. @throws InputError, naming the file and what is wrong, if the file is missing,
/// not HDF5, cut off, or not a recording of this version.
Recording ReadRecording(const std::string& path);

/// What WriteRecording puts behind the head of the file.
/// @throws std::invalid_argument for a recording that disagrees with itself.
std::vector<unsigned char> ToHdf5(const Recording& recording);

/// ... and back. @param name of the file, for messages. @param most_bytes that it may take of
/// memory; made less by what it takes. @throws InputError for what is no recording.
Recording FromHdf5(std::span<const unsigned char> payload, const std::string& name,
                   std::size_t* most_bytes);

}  // namespace sidestep::record
