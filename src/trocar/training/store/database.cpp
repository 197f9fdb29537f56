#include <sqlite3.h>

#include <trocar/training/store/database.hpp>

namespace trocar::training {
namespace {

constexpr int kLargestValue = 128 * 1000000;  // [B] of a text or blob, from any writer

/// A path as SQLite's URI wants it: with what has a meaning there written as %XX.
std::string uri_of(const std::filesystem::path& path, const char* query) {
  static constexpr char kHex[] = "0123456789ABCDEF";
  std::string out = "file:";
  for (const char c : path.string()) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '%' || c == '?' || c == '#' || byte < 0x20)
      (out += '%') += {kHex[byte >> 4], kHex[byte & 15]};
    else
      out += c;
  }
  return out + query;
}

/// Opening a FIFO waits for somebody at its other end. SQLite opens what it finds under these names.
void refuse_what_is_no_file(const std::filesystem::path& path) {
  for (const char* end : {"", "-wal", "-journal", "-shm"}) {
    const std::filesystem::path at = path.string() + end;
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(at, error);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
      throw DatabaseFault(at.string() + ": expected a file, this is a folder, FIFO or device", SQLITE_CANTOPEN);
  }
}

}  // namespace

DatabaseFault::DatabaseFault(const std::string& what, int code) : std::runtime_error(what), m_code(code & 0xff) {}
const int DatabaseFault::kDamaged = SQLITE_CORRUPT;
bool DatabaseFault::is_schema() const { return m_code == SQLITE_ERROR; }
bool DatabaseFault::damaged() const { return m_code == SQLITE_CORRUPT || m_code == SQLITE_NOTADB; }

Database::Database(const std::filesystem::path& path, Access access, int patience)
    : m_path(path.string()), m_patience(patience) {
  const std::filesystem::path absolute = std::filesystem::absolute(path);
  refuse_what_is_no_file(absolute);
  const bool writes = access == Access::write;
  bool good = writes ? open(uri_of(absolute, ""), SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE)
                     : open(uri_of(absolute, ""), SQLITE_OPEN_READONLY);
  // Without write access beside it the file is readable only to one who promises that nobody changes it meanwhile.
  if (!writes && good) {
    const int code = sqlite3_exec(m_handle, "SELECT 1 FROM sqlite_master", nullptr, nullptr, nullptr) & 0xff;
    good = code != SQLITE_CANTOPEN && code != SQLITE_READONLY;
  }
  if (!writes && !good) {
    sqlite3_close(m_handle);
    m_handle = nullptr;
    good = open(uri_of(absolute, "?immutable=1"), SQLITE_OPEN_READONLY);
  }
  if (good && access == Access::salvage) {  // read only: what these keep from being damaged is damaged
    sqlite3_db_config(m_handle, SQLITE_DBCONFIG_DEFENSIVE, 0, nullptr);
    good = sqlite3_exec(m_handle, "PRAGMA writable_schema = ON", nullptr, nullptr, nullptr) == SQLITE_OK;
  }
  if (good) return;
  const DatabaseFault fault(m_path + ": " + (m_handle ? sqlite3_errmsg(m_handle) : "not enough memory"),
                            m_handle ? sqlite3_errcode(m_handle) : SQLITE_NOMEM);
  sqlite3_close(m_handle);
  throw fault;
}

bool Database::open(const std::string& uri, int flags) {
  if (sqlite3_open_v2(uri.c_str(), &m_handle, flags | SQLITE_OPEN_URI, nullptr) != SQLITE_OK) return false;
  sqlite3_extended_result_codes(m_handle, 1);
  sqlite3_busy_timeout(m_handle, m_patience);
  sqlite3_limit(m_handle, SQLITE_LIMIT_LENGTH, kLargestValue);
  sqlite3_db_config(m_handle, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(m_handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  return true;
}

Database::~Database() { sqlite3_close(m_handle); }

void Database::fail(int code) const { throw DatabaseFault(m_path + ": " + sqlite3_errmsg(m_handle), code); }

void Database::run(const std::string& sql) {
  if (const int code = sqlite3_exec(m_handle, sql.c_str(), nullptr, nullptr, nullptr); code != SQLITE_OK) fail(code);
}

std::int64_t Database::number_of(const std::string& sql) {
  Query query(*this, sql);
  return query.next() ? query.integer(0) : 0;
}

Query::Query(Database& db, const std::string& sql) : m_db(db) {
  check(sqlite3_prepare_v2(db.handle(), sql.c_str(), -1, &m_statement, nullptr));
}

Query::~Query() { sqlite3_finalize(m_statement); }

void Query::check(int code) const {
  if (code != SQLITE_OK) m_db.fail(code);
}

Query& Query::bind(std::int64_t value) {
  check(sqlite3_bind_int64(m_statement, ++m_bound, value));
  return *this;
}
Query& Query::bind(double value) {
  check(sqlite3_bind_double(m_statement, ++m_bound, value));
  return *this;
}
Query& Query::bind(const std::string& value) {
  check(sqlite3_bind_text64(m_statement, ++m_bound, value.data(), value.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
  return *this;
}
Query& Query::bind(std::span<const std::uint8_t> bytes) {
  check(sqlite3_bind_blob64(m_statement, ++m_bound, bytes.data(), bytes.size(), SQLITE_TRANSIENT));
  return *this;
}
Query& Query::bind_nothing() {
  check(sqlite3_bind_null(m_statement, ++m_bound));
  return *this;
}

bool Query::next() {
  const int code = sqlite3_step(m_statement);
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) m_db.fail(code);
  return false;
}

void Query::done() {
  while (next()) {
  }
}

bool Query::has(int column) const { return sqlite3_column_type(m_statement, column) != SQLITE_NULL; }
std::int64_t Query::integer(int column) const { return sqlite3_column_int64(m_statement, column); }
double Query::real(int column) const { return sqlite3_column_double(m_statement, column); }

std::string Query::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(m_statement, column));
  return text ? std::string(text, size_t(sqlite3_column_bytes(m_statement, column))) : std::string();
}

std::vector<std::uint8_t> Query::bytes(int column) const {
  const auto* bytes = static_cast<const std::uint8_t*>(sqlite3_column_blob(m_statement, column));
  return bytes ? std::vector<std::uint8_t>(bytes, bytes + sqlite3_column_bytes(m_statement, column))
               : std::vector<std::uint8_t>();
}

Transaction::Transaction(Database& db) : m_db(db) { m_db.run("BEGIN IMMEDIATE"); }

Transaction::~Transaction() {
  if (m_open) sqlite3_exec(m_db.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void Transaction::commit() {
  m_db.run("COMMIT");
  m_open = false;
}

}  // namespace trocar::training
