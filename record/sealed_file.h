#pragma once

#include <span>
#include <string>
#include <vector>

namespace sidestep::record {

/// A file that can tell whether it is whole: 512 bytes of text that name the format, its version,
/// and the length and checksum of what follows, then the payload. A cut, a flipped bit or a file of
/// another kind is found before anything interprets the payload. HDF5 skips such a head (it calls
/// it a user block), so a payload in HDF5 opens with the usual tools.
struct SealedFormat {
  std::string name;  ///< e.g. "sidestep trace"
  int version = 1;
};

/// Head and payload as they stand in a file.
std::string SealedBytes(const SealedFormat& format, std::span<const unsigned char> payload);

/// Writes head and payload as an AtomicFile (core/atomic_file.h).
/// @throws InputError if it cannot be written.
void WriteSealedFile(const std::string& path, const SealedFormat& format,
                     std::span<const unsigned char> payload);

/// Reads the payload back. @throws InputError `PATH: WHY` if the file is missing, a directory, of
/// another format or version, cut off or damaged.
std::vector<unsigned char> ReadSealedFile(const std::string& path, const SealedFormat& format);

/// What a file of sealed payloads, one after the other, holds.
struct SealedRow {
  std::vector<std::vector<unsigned char>> payloads;  ///< the whole ones, up to where one is not
  std::string damage;  ///< what is wrong there; empty if the file ends there
};

/// Reads all that is whole. @throws InputError as ReadSealedFile does if not even the first one is.
SealedRow ReadSealedRow(const std::string& path, const SealedFormat& format);

}  // namespace sidestep::record
