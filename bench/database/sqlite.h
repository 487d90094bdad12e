#pragma once

#include <cstdint>
#include <memory>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace sidestep::bench {

/// One prepared statement of a database, which must outlive it. Parameters are counted from 1,
/// columns from 0. Everything throws InputError `FILE: WHY`.
class SqlStatement {
 public:
  SqlStatement(sqlite3* database, std::string name, const std::string& sql);
  ~SqlStatement();
  SqlStatement(SqlStatement&&) noexcept = default;
  SqlStatement& operator=(SqlStatement&&) = delete;

  void Bind(int parameter, const std::string& text);
  void Bind(int parameter, std::int64_t number);
  void Bind(int parameter, double number);  ///< NaN and infinities: NULL, which is no number either
  void BindNull(int parameter);

  /// Goes to the next row. @return false if there is none.
  bool Step();
  /// Begins again, with the parameters unbound.
  void Reset();

  int num_columns() const;
  std::string ColumnName(int column) const;
  bool IsNull(int column) const;
  std::string Text(int column) const;  ///< of NULL: empty; of a number: as SQLite writes it
  double Number(int column) const;     ///< of NULL and of text that is no number: NaN
  std::int64_t Integer(int column) const;
  /// 'n' NULL, 'i' a whole number, 'r' a real one, 't' text, 'b' bytes.
  char Kind(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  [[noreturn]] void Fail() const;

  sqlite3* database_;
  std::string name_;  // of the file
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// A file of SQLite.
class SqlDatabase {
 public:
  /// Opens what is there, to be read only. @throws InputError if there is none, or it is another
  /// kind of file.
  static SqlDatabase Read(const std::string& file);
  /// Makes a new one, in the place of what is there. Nothing of it is safe until it is closed.
  /// @param name stands for the file in messages.
  static SqlDatabase Create(const std::string& file, const std::string& name);

  const std::string& name() const { return name_; }
  SqlStatement Prepare(const std::string& sql) const;
  /// One or several statements without parameters.
  void Execute(const std::string& sql) const;

 private:
  friend class SqlBudget;
  struct Close {
    void operator()(sqlite3* database) const;
  };
  SqlDatabase(const std::string& file, const std::string& name, int flags);

  std::string name_;
  std::unique_ptr<sqlite3, Close> database_;
};

/// For SQL of a person's, which may be endless: while it lives, all statements of a database
/// together may take so many steps of SQLite's machine and make no text longer than kMostBytes.
/// What goes beyond throws InputError, as everything that is wrong with SQL does.
class SqlBudget {
 public:
  static constexpr int kMostBytes = 1 << 24;

  /// @param database must outlive it, and have one budget at a time.
  SqlBudget(const SqlDatabase& database, std::int64_t steps);
  ~SqlBudget();
  SqlBudget(const SqlBudget&) = delete;
  SqlBudget& operator=(const SqlBudget&) = delete;

 private:
  static int Count(void* budget);

  sqlite3* database_;
  std::int64_t left_;  // pieces of kPiece steps
  int most_bytes_before_;
};

/// A name as SQL takes it: "as ""it"" is".
std::string SqlName(const std::string& name);

}  // namespace sidestep::bench
