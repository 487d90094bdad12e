#include "sidestep/core/text_file.h"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>

#include "sidestep/core/input_error.h"
#include "sidestep/core/utf8.h"

namespace sidestep {
namespace {

constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF";

// UTF-16 and UTF-32 begin with their mark; without one, a text that begins with a Latin letter has
// a zero among its first two bytes, and no UTF-8 text has.
bool IsWide(std::string_view bytes) {
  const std::string_view begin = bytes.substr(0, 2);
  return begin == "\xFF\xFE" || begin == "\xFE\xFF" ||
         (begin.size() == 2 && (begin[0] == '\0') != (begin[1] == '\0'));
}

}  // namespace

std::string DecodeText(const std::string& bytes, const std::string& name) {
  std::string_view rest = bytes;
  if (IsWide(rest)) throw InputError(name, 1, "", "is UTF-16 or UTF-32, must be UTF-8");
  if (rest.substr(0, kUtf8Mark.size()) == kUtf8Mark) rest.remove_prefix(kUtf8Mark.size());
  const std::size_t valid = FindInvalidUtf8(rest);
  if (valid < rest.size()) {
    const auto line =
        1 + std::count(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(valid), '\n');
    throw InputError(
        name, static_cast<int>(line), "",
        "must be UTF-8, has the byte " + EscapeInvalidUtf8(rest.substr(valid, 1)) + " (Latin-1?)");
  }
  std::string text;
  text.reserve(rest.size());
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const bool ends_line = rest[i] == '\r' && i + 1 < rest.size() && rest[i + 1] == '\n';
    if (!ends_line) text += rest[i];
  }
  return text;
}

std::string ReadTextFile(const std::string& path, std::uintmax_t max_bytes) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw InputError(path, "no such file");
  if (fs::is_directory(status)) throw InputError(path, "is a directory, not a file");
  if (!fs::is_regular_file(status)) throw InputError(path, "is not a regular file");
  const std::uintmax_t size = fs::file_size(path, error);
  if (!error && size > max_bytes) {
    throw InputError(path, "is " + std::to_string(size) + " bytes long, must be at most " +
                               std::to_string(max_bytes));
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(path, std::string("cannot be read: ") + std::strerror(errno));
  return DecodeText({std::istreambuf_iterator<char>(stream), {}}, path);
}

}  // namespace sidestep
