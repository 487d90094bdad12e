#pragma once

#include <span>
#include <stdexcept>
#include <string>

namespace sidestep::bench {

/// The row of a table that is called so. @param what a row is, for the error.
/// @throws std::invalid_argument for an unknown name.
template <class Row>
const Row& RowNamed(std::span<const Row> rows, const char* what, const std::string& name) {
  for (const Row& row : rows) {
    if (name == row.name) return row;
  }
  throw std::invalid_argument(std::string("no ") + what + " '" + name + "'");
}

}  // namespace sidestep::bench
