#include "sidestep/cli/build_id.h"

#include <elf.h>
#include <fmt/core.h>
#include <link.h>

#include <cstring>
#include <stdexcept>

namespace sidestep::cli {
namespace {

// The note of GNU build ids in a segment of notes, in hexadecimal digits; empty if it has none.
std::string FindBuildId(const char* notes, std::size_t size) {
  const auto padded = [](std::size_t length) { return (length + 3) / 4 * 4; };
  while (size >= sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) head;
    std::memcpy(&head, notes, sizeof head);
    const char* const name = notes + sizeof head;
    const char* const content = name + padded(head.n_namesz);
    const std::size_t length = sizeof head + padded(head.n_namesz) + padded(head.n_descsz);
    if (length > size) break;
    const bool is_gnu = head.n_namesz == 4 && std::memcmp(name, "GNU", 4) == 0;
    if (is_gnu && head.n_type == NT_GNU_BUILD_ID) {
      std::string text;
      for (std::size_t i = 0; i < head.n_descsz; ++i) {
        text += fmt::format("{:02x}", static_cast<unsigned char>(content[i]));
      }
      return text;
    }
    notes += length;
    size -= length;
  }
  return "";
}

// The first object is the program itself; libraries follow.
int LookAtProgram(dl_phdr_info* info, std::size_t, void* id) {
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = info->dlpi_phdr[i];
    if (segment.p_type != PT_NOTE) continue;
    const auto* const notes = reinterpret_cast<const char*>(info->dlpi_addr + segment.p_vaddr);
    std::string found = FindBuildId(notes, segment.p_memsz);
    if (!found.empty()) *static_cast<std::string*>(id) = found;
  }
  return 1;
}

}  // namespace

std::string BuildId() {
  std::string id;
  dl_iterate_phdr(&LookAtProgram, &id);
  if (id.empty()) throw std::logic_error("this program was linked without --build-id");
  return id;
}

}  // namespace sidestep::cli
