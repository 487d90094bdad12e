#include "sidestep/bench/database/run_choice.h"

#include <algorithm>

#include "sidestep/core/input_error.h"

namespace sidestep::bench {
namespace {

// A million runs take half of them; an endless expression a few seconds.
constexpr std::int64_t kMostSqlSteps = 300'000'000;

// 'it''s'
std::string SqlText(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "''" : std::string(1, c);
  return quoted + "'";
}

// What the sweep asks, if it is what the database holds.
struct AskedFactor {
  const FactorColumn* factor = nullptr;
  std::string of, with;
};

AskedFactor AskedOf(const RunDatabase& database) {
  AskedFactor asked;
  for (const FactorColumn& factor : database.factors()) {
    if (factor.name == database.Fact("compare.factor")) asked.factor = &factor;
  }
  asked.of = database.Fact("compare.of");
  asked.with = database.Fact("compare.with");
  return asked;
}

// As SQL compares it with the factor's column.
std::string Value(const FactorColumn& factor, const std::string& value) {
  return factor.is_number ? "CAST(" + SqlText(value) + " AS REAL)" : SqlText(value);
}

// Every run with the same case under the other value beside it.
std::string FromSql(const RunDatabase& database, const AskedFactor& asked) {
  std::string beside, match = "0";
  for (const std::string& column : database.columns()) {
    beside += ", o." + SqlName(column) + " AS " + SqlName("beside_" + column);
  }
  if (asked.factor != nullptr) {
    const std::string column = SqlName(asked.factor->column);
    const std::string of = Value(*asked.factor, asked.of), with = Value(*asked.factor, asked.with);
    match = "o." + column + " = CASE WHEN r." + column + " = " + of + " THEN " + with + " ELSE " +
            of + " END AND o.seed = r.seed AND o.scenario = r.scenario AND o.id <> r.id";
    for (const FactorColumn& factor : database.factors()) {
      if (&factor == asked.factor) continue;
      match += " AND o." + SqlName(factor.column) + " IS r." + SqlName(factor.column);
    }
  }
  return "WITH everything AS MATERIALIZED (SELECT * FROM results), chosen AS (SELECT r.*" + beside +
         " FROM everything r LEFT JOIN everything o ON " + match + ")";
}

// The rows of a person's SQL; what is wrong with it is told by its flag.
template <class Use>
void ForEachRow(const RunDatabase& database, const std::string& flag, const std::string& sql,
                const Use& use) {
  try {
    SqlStatement row = database.sql().Prepare(sql);
    while (row.Step()) use(row);
  } catch (const InputError& error) {
    throw InputError(flag, std::string(error.what()).substr(database.sql().name().size() + 2));
  }
}

}  // namespace

void RequireOneExpression(const std::string& flag, const std::string& text) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(flag, why + ": '" + text + "'");
  };
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const char next = i + 1 < text.size() ? text[i + 1] : '\0';
    if (c == '\'' || c == '"' || c == '`' || c == '[') {
      const std::size_t end = text.find(c == '[' ? ']' : c, i + 1);
      if (end == std::string::npos) refuse("quotes do not end");
      i = end;  // doubled ones begin another part at once
    } else if (c == '(') {
      ++depth;
    } else if (c == ')') {
      if (--depth < 0) refuse("brackets do not match");
    } else if (c == ';' || c == '\0') {
      refuse("must be one expression");
    } else if ((c == '-' && next == '-') || (c == '/' && next == '*')) {
      refuse("must hold no comment");
    }
  }
  if (depth != 0) refuse("brackets do not match");
}

std::vector<ChosenRun> ChooseRuns(const RunDatabase& database, const RunChoice& choice) {
  const AskedFactor asked = AskedOf(database);
  const SqlBudget budget(database.sql(), kMostSqlSteps);
  const std::string from = FromSql(database, asked);
  const std::string order = choice.order.empty() ? "min_clearance_m" : choice.order;
  std::string where;
  if (!choice.where.empty()) {
    RequireOneExpression("--where", choice.where);
    where = " WHERE (" + choice.where + ")";
    ForEachRow(database, "--where", from + " SELECT count(*) FROM chosen" + where,
               [](const SqlStatement&) {});
  }
  RequireOneExpression("--order", order);
  std::string columns = "id, outcome, seed, scenario, command, beside_id, beside_command";
  for (const FactorColumn& factor : database.factors()) {
    columns += ", " + SqlName(factor.column) + ", " + SqlName("beside_" + factor.column);
  }
  // Of equal ones the first counts.
  const std::string sql = from + " SELECT " + columns + " FROM chosen" + where + " ORDER BY " +
                          order + ", id LIMIT " + std::to_string(choice.top);
  std::vector<ChosenRun> runs;
  ForEachRow(database, "--order", sql, [&](const SqlStatement& row) {
    ChosenRun& run = runs.emplace_back();
    run.id = row.Integer(0);
    run.what = row.Text(1) + ", " + row.Text(3) + ", seed " + row.Text(2);
    run.command = row.Text(4);
    if (!row.IsNull(5)) run.beside_id = row.Integer(5);
    run.beside_command = row.Text(6);
    int column = 7;
    for (const FactorColumn& factor : database.factors()) {
      if (&factor == asked.factor) {
        run.name = row.Text(column);
        run.beside_name = row.Text(column + 1);
      } else {
        run.what += ", " + factor.name + " " + row.Text(column);
      }
      column += 2;
    }
  });
  return runs;
}

}  // namespace sidestep::bench
