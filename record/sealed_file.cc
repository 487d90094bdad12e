#include "sidestep/record/sealed_file.h"

#include <fmt/core.h>

#include <algorithm>
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

constexpr const char* kDamaged = "is damaged: its contents do not match its checksum";

std::vector<unsigned char> ReadBytes(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(path, "no such file");
  if (std::filesystem::is_directory(status)) throw InputError(path, "is a directory, not a file");
  if (!std::filesystem::is_regular_file(status)) throw InputError(path, "is not a regular file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(path, std::string("cannot be read: ") + std::strerror(errno));
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  std::vector<unsigned char> bytes(error ? 0 : size);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

struct Sealed {
  std::span<const unsigned char> payload;
  std::string fault;  // why there is none
};

// What stands at the beginning of `bytes`.
Sealed TakeSealed(std::span<const unsigned char> bytes, const SealedFormat& format) {
  const auto fault = [](const std::string& why) { return Sealed{{}, why}; };
  if (bytes.empty()) return fault("is empty");
  const std::string_view head(reinterpret_cast<const char*>(bytes.data()),
                              std::min(bytes.size(), kHeadBytes));
  const std::string name = format.name + " ";
  if (head.substr(0, name.size()) != name) return fault("is not a " + format.name + " file");
  if (head.size() < kHeadBytes) return fault("is cut off within its first 512 bytes");
  const long long version = NumberAfter(head, name);
  if (version != format.version) {
    return fault("is of version " + std::to_string(version) + " of the " + format.name +
                 " format; this program reads version " + std::to_string(format.version));
  }
  const std::size_t there = bytes.size() - kHeadBytes;
  const long long expected = NumberAfter(head, kLengthKey);
  if (expected < 0) return fault(kDamaged);
  if (there < static_cast<unsigned long long>(expected)) {
    return fault("is cut off: it holds " + std::to_string(there) + " of " +
                 std::to_string(expected) + " bytes");
  }
  const auto payload = bytes.subspan(kHeadBytes, static_cast<std::size_t>(expected));
  if (head != MakeHead(format, payload)) return fault(kDamaged);
  return {payload, ""};
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
  const std::vector<unsigned char> bytes = ReadBytes(path);
  const Sealed sealed = TakeSealed(bytes, format);
  if (!sealed.fault.empty()) throw InputError(path, sealed.fault);
  if (kHeadBytes + sealed.payload.size() < bytes.size()) throw InputError(path, kDamaged);
  return {sealed.payload.begin(), sealed.payload.end()};
}

SealedRow ReadSealedRow(const std::string& path, const SealedFormat& format) {
  const std::vector<unsigned char> bytes = ReadBytes(path);
  SealedRow row;
  for (std::size_t at = 0; at < bytes.size() || at == 0;) {
    const Sealed sealed = TakeSealed(std::span(bytes).subspan(at), format);
    if (!sealed.fault.empty()) {
      if (at == 0) throw InputError(path, sealed.fault);
      row.damage = fmt::format("from byte {} of {} on it {}", at, bytes.size(), sealed.fault);
      break;
    }
    row.payloads.emplace_back(sealed.payload.begin(), sealed.payload.end());
    at += kHeadBytes + sealed.payload.size();
  }
  return row;
}

}  // namespace sidestep::record
