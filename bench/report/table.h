#pragma once

#include <string>
#include <vector>

namespace sidestep::bench {

/// A table as people read it, on a page (report/html_page.h) as on a terminal: the header, then
/// rows of as many cells. The first column holds words, the others numbers.
using TextTable = std::vector<std::vector<std::string>>;

/// Columns as wide as they must be, the first aligned left, the others right; a line a row.
std::string ToText(const TextTable& table);

/// A cell `3 / 7`.
std::string Of(int part, int all);

}  // namespace sidestep::bench
