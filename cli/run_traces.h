#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sidestep/bench/database/run_database.h"

namespace sidestep::cli {

/// Where the traces of a database's runs are.
class RunTraces {
 public:
  /// @param file of the database, in whose folder the names of traces begin. `database` must
  /// outlive it.
  RunTraces(const bench::RunDatabase& database, const std::string& file);

  /// Of the run of that id; nothing if it was not kept, or has gone since.
  std::optional<std::string> Find(std::int64_t id) const;

 private:
  const bench::RunDatabase& database_;
  std::string folder_;
};

}  // namespace sidestep::cli
