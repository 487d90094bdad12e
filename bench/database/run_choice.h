#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/bench/database/run_database.h"

namespace sidestep::bench {

/// Which runs of a database are wanted. Texts are a person's, with SQL over the columns of
/// `results`; of the same case under the other value of the sweep's question, each column also
/// stands there as `beside_...`.
struct RunChoice {
  std::string where;  ///< one expression; empty: all
  std::string order;  ///< terms of ORDER BY; empty: by the least clearance
  std::int64_t top = 4;
};

/// A run, and the one that it is to be seen beside.
struct ChosenRun {
  std::int64_t id = 0;
  std::string name;     ///< its value of the question's factor; empty without a question
  std::string what;     ///< its outcome and what else was varied, in words
  std::string command;  ///< runs it again; may be empty
  std::optional<std::int64_t> beside_id;
  std::string beside_name, beside_command;
};

/// @throws InputError `--where: WHY` or `--order: WHY` for what is no SQL, or more than that.
std::vector<ChosenRun> ChooseRuns(const RunDatabase& database, const RunChoice& choice);

/// @throws InputError `FLAG: WHY` for a text that could be more than one expression of SQL: with a
/// semicolon, a comment, quotes that do not end, or brackets that do not match.
void RequireOneExpression(const std::string& flag, const std::string& text);

}  // namespace sidestep::bench
