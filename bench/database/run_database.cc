#include "sidestep/bench/database/run_database.h"

#include <cstring>
#include <vector>

#include "sidestep/core/fingerprint.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/number_text.h"

namespace sidestep::bench {
namespace {

bool HasTable(const SqlDatabase& database, const std::string& name) {
  SqlStatement found = database.Prepare("SELECT 1 FROM sqlite_master WHERE name = ?");
  found.Bind(1, name);
  return found.Step();
}

void AddTable(const SqlDatabase& database, const std::string& table, Fingerprint& fingerprint) {
  fingerprint.Add(table);
  // Their primary keys order them all.
  SqlStatement rows = database.Prepare("SELECT * FROM " + SqlName(table));
  for (int c = 0; c < rows.num_columns(); ++c) fingerprint.Add(rows.ColumnName(c));
  while (rows.Step()) {
    for (int c = 0; c < rows.num_columns(); ++c) {
      const char kind = rows.Kind(c);
      fingerprint.Add(std::string(1, kind));
      if (kind == 'r') {  // all its bits, the sign of zero too
        const double number = rows.Number(c);
        char bytes[sizeof number];
        std::memcpy(bytes, &number, sizeof number);
        fingerprint.Add({bytes, sizeof bytes});
      } else if (kind != 'n') {
        fingerprint.Add(rows.Text(c));
      }
    }
  }
}

}  // namespace

RunDatabase::RunDatabase(const std::string& path) : database_(SqlDatabase::Read(path)) {
  const auto refuse = [&] {
    throw InputError(path,
                     std::string("is no database of sidestep's results (") + kDatabaseFormat + ")");
  };
  if (!HasTable(database_, "sidestep")) refuse();
  SqlStatement facts = database_.Prepare("SELECT name, value FROM sidestep");
  while (facts.Step()) facts_[facts.Text(0)] = facts.Text(1);
  if (Fact("format") != kDatabaseFormat) refuse();
  SqlStatement factors =
      database_.Prepare("SELECT name, \"column\", kind, type FROM factors ORDER BY position");
  while (factors.Step()) {
    factors_.push_back({factors.Text(0), factors.Text(1), factors.Text(2) == "planner",
                        factors.Text(3) == "number"});
  }
  SqlStatement values =
      database_.Prepare("SELECT factor, value FROM factor_values ORDER BY factor, position");
  while (values.Step()) {
    const std::int64_t factor = values.Integer(0) - 1;
    if (factor < 0 || factor >= static_cast<std::int64_t>(factors_.size())) refuse();
    factors_[static_cast<std::size_t>(factor)].values.push_back(values.Text(1));
  }
  const SqlStatement all = database_.Prepare("SELECT * FROM results");
  for (int c = 0; c < all.num_columns(); ++c) columns_.push_back(all.ColumnName(c));
}

std::string RunDatabase::Fact(const std::string& name) const {
  const auto found = facts_.find(name);
  return found == facts_.end() ? "" : found->second;
}

std::int64_t RunDatabase::num_runs() const {
  SqlStatement count = database_.Prepare("SELECT count(*) FROM runs");
  return count.Step() ? count.Integer(0) : 0;
}

SqlStatement RunDatabase::Select(const std::string& what, const std::string& where,
                                 const std::string& order, std::int64_t limit) const {
  return database_.Prepare("SELECT " + what + " FROM results" +
                           (where.empty() ? "" : " WHERE (" + where + ")") + " ORDER BY " +
                           (order.empty() ? "id" : order) + " LIMIT " + std::to_string(limit));
}

std::string DigestOf(const RunDatabase& database) {
  Fingerprint fingerprint;
  std::vector<std::string> tables;
  SqlStatement names = database.sql().Prepare(
      "SELECT name, sql FROM sqlite_master WHERE type IN ('table', 'view') ORDER BY name");
  while (names.Step()) {
    const std::string name = names.Text(0);
    if (name.starts_with("wall_clock") || name.starts_with("sqlite_")) continue;
    fingerprint.Add(names.Text(1));
    if (name != "results") tables.push_back(name);
  }
  for (const std::string& table : tables) AddTable(database.sql(), table, fingerprint);
  return fingerprint.Text();
}

}  // namespace sidestep::bench
