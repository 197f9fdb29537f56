// The store is opened: tables brought up to date, the file checked, what is damaged handed to store_repair.cpp, what
// has waited taken in.
#include <iterator>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/training/store/store_parts.hpp>

namespace trocar::training {

namespace fs = std::filesystem;

namespace {

/// What brings the tables from version i to i + 1. Never changed once published, only added to.
constexpr const char* kMigrations[] = {
    "CREATE TABLE trainee (id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE);"
    "CREATE TABLE attempt ("
    "  number INTEGER PRIMARY KEY AUTOINCREMENT,"  // never used twice, also not after a row is deleted
    "  uuid TEXT NOT NULL UNIQUE,"
    "  trainee INTEGER NOT NULL REFERENCES trainee(id),"
    "  exercise TEXT NOT NULL, title TEXT NOT NULL, mode TEXT NOT NULL, seed INTEGER NOT NULL, input TEXT NOT NULL,"
    "  started TEXT NOT NULL, ended TEXT NOT NULL, state TEXT NOT NULL,"
    "  score REAL, passed INTEGER, seconds REAL NOT NULL, ticks INTEGER NOT NULL,"
    "  recording TEXT NOT NULL, result TEXT NOT NULL, program_version TEXT NOT NULL, model_hash INTEGER NOT NULL);"
    "CREATE TABLE trace (attempt INTEGER PRIMARY KEY REFERENCES attempt(number) ON DELETE CASCADE,"
    "  samples BLOB NOT NULL);"
    "CREATE INDEX attempt_trainee ON attempt(trainee, exercise);",
};
static_assert(std::size(kMigrations) == Store::kVersion);

constexpr std::uintmax_t kLargestChecked = 64 << 20;  ///< [B] a database above this is not checked at every opening

}  // namespace

void Store::open() {
  const OpeningLock lock(m_folder);
  for (int round = 0; round < 2; ++round) {
    try {
      std::error_code error;
      const bool fresh = !fs::exists(database(), error);
      Database db(database(), Database::Access::write, m_patience);
      make_durable(db);
      check(db);
      migrate(db);
      m_writable = true;
      if (fresh) take_in_recordings(db);
      take_in_files(db);
      settle_running(db);
      AttemptLock::sweep(m_folder);
      return;
    } catch (const DatabaseFault& fault) {
      m_writable = false;
      if (!fault.damaged() || round > 0) {
        notice(tr("the session store cannot be written: {}", fault.what()));
        return;
      }
      repair(fault.what());
    }
  }
}

void Store::check(Database& db) {
  std::error_code error;
  if (fs::file_size(database(), error) > kLargestChecked || error) return;
  Query q(db, "PRAGMA quick_check(1)");
  if (q.next() && q.text(0) != "ok")
    throw DatabaseFault(database().string() + ": " + q.text(0), DatabaseFault::kDamaged);
}

bool Store::damaged() {
  try {
    Database db(database(), Database::Access::write, m_patience);
    make_durable(db);
    check(db);
    migrate(db);
    return false;
  } catch (const DatabaseFault& fault) {
    return fault.damaged();
  }
}

void Store::migrate(Database& db) {
  if (db.number_of("PRAGMA user_version") == kVersion) return check_tables(db);
  Transaction all(db);
  const std::int64_t version = db.number_of("PRAGMA user_version");
  if (version < 0 || (version == 0 && db.number_of("SELECT count(*) FROM sqlite_master") > 0))
    throw DatabaseFault(tr("{}: its tables have the version {}", database().string(), version),
                        DatabaseFault::kDamaged);
  if (version > kVersion)
    throw DatabaseFault(tr("{}: made by a newer Trocar (version {} of the tables, this one knows {})",
                           database().string(), version, kVersion),
                        8 /*SQLITE_READONLY*/);
  for (std::int64_t v = version; v < kVersion; ++v) db.run(kMigrations[v]);
  db.run(fmt::format("PRAGMA user_version = {}", kVersion));
  all.commit();
}

}  // namespace trocar::training
