// SQLite with the corners taken off: handles that close themselves, faults that say what happened and what kind they
// are, values that are always bound and never pasted into the text.
//
//   Database db(path, Database::Access::write);
//   Query q(db, "SELECT name FROM trainee WHERE id = ?");
//   q.bind(id);
//   while (q.next()) use(q.text(0));
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

struct sqlite3;
struct sqlite3_stmt;

namespace trocar::training {

/// What SQLite said. `damaged`: the file is no (sound) database; everything else may be better next time.
class DatabaseFault : public std::runtime_error {
 public:
  DatabaseFault(const std::string& what, int code);
  bool damaged() const;
  /// The file is sound, but it has not the tables or columns that were asked for.
  bool is_schema() const;
  static const int kDamaged;

 private:
  int m_code;
};

class Database {
 public:
  enum class Access {
    write,    ///< made if it is not there
    read,     ///< also from a folder that cannot be written
    salvage,  ///< likewise, and whatever of a damaged file can be read: pages that are missing at its end do not matter
  };
  static constexpr int kPatience = 5000;  ///< [ms]
  /// @param patience  [ms] it waits at most so long for others that write  @throws DatabaseFault
  Database(const std::filesystem::path& path, Access access, int patience = kPatience);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  void run(const std::string& sql);                ///< any number of statements without values  @throws DatabaseFault
  std::int64_t number_of(const std::string& sql);  ///< the first column of the first row; 0 if there is none
  sqlite3* handle() const { return m_handle; }
  [[noreturn]] void fail(int code) const;

 private:
  bool open(const std::string& uri, int flags);

  sqlite3* m_handle = nullptr;
  std::string m_path;
  int m_patience;
};

class Query {
 public:
  Query(Database& db, const std::string& sql);
  ~Query();
  Query(const Query&) = delete;
  Query& operator=(const Query&) = delete;

  /// The next question mark's value.
  Query& bind(std::int64_t value);
  Query& bind(double value);
  Query& bind(const std::string& value);
  Query& bind(std::span<const std::uint8_t> bytes);
  Query& bind_nothing();
  template <class T>
  Query& bind(const std::optional<T>& value) {
    return value ? bind(*value) : bind_nothing();
  }

  bool next();  ///< the next row  @throws DatabaseFault
  void done();  ///< runs to the end

  bool has(int column) const;  ///< not NULL
  std::int64_t integer(int column) const;
  double real(int column) const;
  std::string text(int column) const;
  std::vector<std::uint8_t> bytes(int column) const;

 private:
  void check(int code) const;

  Database& m_db;
  sqlite3_stmt* m_statement = nullptr;
  int m_bound = 0;
};

/// Everything since construction is undone unless commit() was reached. Takes the right to write at once, so that two
/// programs never wait for each other.
class Transaction {
 public:
  explicit Transaction(Database& db);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database& m_db;
  bool m_open = true;
};

}  // namespace trocar::training
