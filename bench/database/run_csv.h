#pragma once

#include <string>

#include "sidestep/bench/database/run_database.h"

namespace sidestep::bench {

/// Writes the view `results` as CSV: a line a run, every digit of a number, an empty field where
/// there is none. Memory does not grow with the rows.
/// @throws InputError if it cannot be written.
void WriteRunCsv(const RunDatabase& database, const std::string& path);

}  // namespace sidestep::bench
