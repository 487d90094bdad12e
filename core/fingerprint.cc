#include "sidestep/core/fingerprint.h"

#include <fmt/core.h>

namespace sidestep {

void Fingerprint::Add(std::string_view part) {
  const std::uint64_t length = part.size();
  for (int shift = 0; shift < 64; shift += 8) AddByte(static_cast<unsigned char>(length >> shift));
  for (const char c : part) AddByte(static_cast<unsigned char>(c));
}

std::string Fingerprint::Text() const { return fmt::format("{:016x}", hash_); }

}  // namespace sidestep
