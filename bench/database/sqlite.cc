#include "sidestep/bench/database/sqlite.h"

#include <sqlite3.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <system_error>
#include <utility>

#include "sidestep/core/input_error.h"

namespace sidestep::bench {
namespace {

constexpr int kPiece = 10'000;  // steps between two looks at a budget

}  // namespace

void SqlStatement::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

SqlStatement::SqlStatement(sqlite3* database, std::string name, const std::string& sql)
    : database_(database), name_(std::move(name)) {
  sqlite3_stmt* statement = nullptr;
  const int size = static_cast<int>(sql.size());
  if (sqlite3_prepare_v2(database, sql.data(), size, &statement, nullptr) != SQLITE_OK) Fail();
  statement_.reset(statement);
}

SqlStatement::~SqlStatement() = default;

void SqlStatement::Bind(int parameter, const std::string& text) {
  const int size = static_cast<int>(text.size());
  const int done =
      sqlite3_bind_text(statement_.get(), parameter, text.data(), size, SQLITE_TRANSIENT);
  if (done != SQLITE_OK) Fail();
}
void SqlStatement::Bind(int parameter, std::int64_t number) {
  if (sqlite3_bind_int64(statement_.get(), parameter, number) != SQLITE_OK) Fail();
}
void SqlStatement::Bind(int parameter, double number) {
  if (!std::isfinite(number)) return BindNull(parameter);
  if (sqlite3_bind_double(statement_.get(), parameter, number) != SQLITE_OK) Fail();
}
void SqlStatement::BindNull(int parameter) {
  if (sqlite3_bind_null(statement_.get(), parameter) != SQLITE_OK) Fail();
}

bool SqlStatement::Step() {
  const int done = sqlite3_step(statement_.get());
  if (done != SQLITE_ROW && done != SQLITE_DONE) Fail();
  return done == SQLITE_ROW;
}

void SqlStatement::Reset() {
  sqlite3_reset(statement_.get());
  sqlite3_clear_bindings(statement_.get());
}

int SqlStatement::num_columns() const { return sqlite3_column_count(statement_.get()); }
std::string SqlStatement::ColumnName(int column) const {
  return sqlite3_column_name(statement_.get(), column);
}
bool SqlStatement::IsNull(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}
std::string SqlStatement::Text(int column) const {
  const auto* const text =
      reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  if (text == nullptr) return "";
  return {text, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}
double SqlStatement::Number(int column) const {
  const int type = sqlite3_column_type(statement_.get(), column);
  if (type != SQLITE_INTEGER && type != SQLITE_FLOAT) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return sqlite3_column_double(statement_.get(), column);
}
std::int64_t SqlStatement::Integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}
char SqlStatement::Kind(int column) const {
  switch (sqlite3_column_type(statement_.get(), column)) {
    case SQLITE_INTEGER:
      return 'i';
    case SQLITE_FLOAT:
      return 'r';
    case SQLITE_TEXT:
      return 't';
    case SQLITE_BLOB:
      return 'b';
    default:
      return 'n';
  }
}

void SqlStatement::Fail() const {
  const bool is_budget = sqlite3_errcode(database_) == SQLITE_INTERRUPT;  // nobody else interrupts
  throw InputError(
      name_, is_budget ? "takes too many steps, as if it were endless" : sqlite3_errmsg(database_));
}

void SqlDatabase::Close::operator()(sqlite3* database) const { sqlite3_close(database); }

SqlDatabase::SqlDatabase(const std::string& file, const std::string& name, int flags)
    : name_(name) {
  sqlite3* database = nullptr;
  const int done = sqlite3_open_v2(file.c_str(), &database, flags, nullptr);
  database_.reset(database);  // there is one to be closed even where it could not be opened
  if (done != SQLITE_OK) {
    throw InputError(name, database == nullptr ? "no memory" : sqlite3_errmsg(database));
  }
}

SqlDatabase SqlDatabase::Read(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) throw InputError(file, "no such file");
  if (std::filesystem::is_directory(file, error)) throw InputError(file, "is a directory");
  return {file, file, SQLITE_OPEN_READONLY};
}

SqlDatabase SqlDatabase::Create(const std::string& file, const std::string& name) {
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  return {file, name, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE};
}

SqlStatement SqlDatabase::Prepare(const std::string& sql) const {
  return {database_.get(), name_, sql};
}

void SqlDatabase::Execute(const std::string& sql) const {
  if (sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
    throw InputError(name_, sqlite3_errmsg(database_.get()));
  }
}

SqlBudget::SqlBudget(const SqlDatabase& database, std::int64_t steps)
    : database_(database.database_.get()),
      left_(steps / kPiece),
      most_bytes_before_(sqlite3_limit(database_, SQLITE_LIMIT_LENGTH, kMostBytes)) {
  sqlite3_progress_handler(database_, kPiece, &SqlBudget::Count, this);
}

SqlBudget::~SqlBudget() {
  sqlite3_progress_handler(database_, 0, nullptr, nullptr);
  sqlite3_limit(database_, SQLITE_LIMIT_LENGTH, most_bytes_before_);
}

int SqlBudget::Count(void* budget) { return --static_cast<SqlBudget*>(budget)->left_ < 0 ? 1 : 0; }

std::string SqlName(const std::string& name) {
  std::string quoted = "\"";
  for (const char c : name) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace sidestep::bench
