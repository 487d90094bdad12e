#include "sidestep/record/sealed_file.h"

#include <fmt/core.h>

#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "sidestep/core/atomic_file.h"
#include "sidestep/core/fnv1a.h"
#include "sidestep/core/input_error.h"

namespace sidestep::record {
namespace {

constexpr std::size_t kHeadBytes = 512;  // the smallest user block of HDF5
constexpr std::string_view kLengthKey = "payload_bytes ";
constexpr std::string_view kChecksumKey = "payload_fnv1a64 ";

std::uint64_t Checksum(std::span<const unsigned char> bytes) {
  std::uint64_t hash = kFnv1aBasis;
  for (const unsigned char byte : bytes) hash = Fnv1a(hash, byte);
  return hash;
}

std::string MakeHead(const SealedFormat& format, std::span<const unsigned char> payload) {
  std::string head = format.name + " " + std::to_string(format.version) + "\n";
  head += std::string(kLengthKey) + std::to_string(payload.size()) + "\n";
  head += std::string(kChecksumKey) + fmt::format("{:016x}\n", Checksum(payload));
  head.resize(kHeadBytes, '\n');
  return head;
}

// The whole number that follows `key` in `head`, or -1.
long long NumberAfter(std::string_view head, std::string_view key) {
  const std::size_t at = head.find(key);
  if (at == std::string_view::npos) return -1;
  long long number = -1;
  std::from_chars(head.data() + at + key.size(), head.data() + head.size(), number);
  return number;
}

}  // namespace

std::string SealedBytes(const SealedFormat& format, std::span<const unsigned char> payload) {
  std::string bytes = MakeHead(format, payload);
  bytes.append(payload.begin(), payload.end());
  return bytes;
}

void WriteSealedFile(const std::string& path, const SealedFormat& format,
                     std::span<const unsigned char> payload) {
  AtomicFile file(path);
  file.Append(MakeHead(format, payload));
  file.Append({reinterpret_cast<const char*>(payload.data()), payload.size()});
  file.Commit();
}

std::vector<unsigned char> ReadSealedFile(const std::string& path, const SealedFormat& format) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(path, "no such file");
  if (std::filesystem::is_directory(status)) throw InputError(path, "is a directory, not a file");
  if (!std::filesystem::is_regular_file(status)) throw InputError(path, "is not a regular file");

  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(path, std::string("cannot be read: ") + std::strerror(errno));
  std::string head(kHeadBytes, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(kHeadBytes));
  const auto head_bytes = static_cast<std::size_t>(stream.gcount());

  const std::string name = format.name + " ";
  if (head_bytes == 0) throw InputError(path, "is empty");
  if (std::string_view(head).substr(0, name.size()) != name) {
    throw InputError(path, "is not a " + format.name + " file");
  }
  if (head_bytes < kHeadBytes) throw InputError(path, "is cut off within its first 512 bytes");
  const long long version = NumberAfter(head, name);
  if (version != format.version) {
    throw InputError(path, "is of version " + std::to_string(version) + " of the " + format.name +
                               " format; this program reads version " +
                               std::to_string(format.version));
  }
  const std::uintmax_t file_bytes = std::filesystem::file_size(path, error);
  const std::uintmax_t payload_bytes = error ? 0 : file_bytes - kHeadBytes;
  const long long expected_bytes = NumberAfter(head, kLengthKey);
  if (expected_bytes >= 0 && payload_bytes < static_cast<std::uintmax_t>(expected_bytes)) {
    throw InputError(path, "is cut off: it holds " + std::to_string(payload_bytes) + " of " +
                               std::to_string(expected_bytes) + " bytes");
  }
  std::vector<unsigned char> payload(payload_bytes);
  stream.read(reinterpret_cast<char*>(payload.data()),
              static_cast<std::streamsize>(payload.size()));
  if (stream.gcount() != static_cast<std::streamsize>(payload.size()) ||
      head != MakeHead(format, payload)) {
    throw InputError(path, "is damaged: its contents do not match its checksum");
  }
  return payload;
}

}  // namespace sidestep::record
