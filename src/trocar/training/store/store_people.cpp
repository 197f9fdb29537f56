// Questions to the store, and forgetting somebody.
#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/training/store/forgetting.hpp>
#include <trocar/training/store/store_parts.hpp>

namespace trocar::training {

namespace fs = std::filesystem;

std::vector<Attempt> Store::list(const AttemptFilter& filter) const {
  std::vector<Attempt> out;
  std::error_code error;
  if (!fs::exists(database(), error)) return out;
  try {
    Database db(database(), Database::Access::read, m_patience);
    Query q(db, fmt::format("SELECT {}{}WHERE (?1 = '' OR t.name = ?1) AND (?2 = '' OR a.exercise = ?2) "
                            "AND (?3 IS NULL OR a.seed = ?3) AND (?4 IS NULL OR a.mode = ?4) "
                            "ORDER BY a.number DESC LIMIT ?5",
                            kAttemptColumns, kFrom));
    q.bind(filter.trainee).bind(filter.exercise);
    q.bind(filter.seed ? std::optional<std::int64_t>(std::int64_t(*filter.seed)) : std::nullopt);
    q.bind(filter.mode ? std::optional<std::string>(name_of(*filter.mode)) : std::nullopt);
    q.bind(std::int64_t(filter.limit > 0 ? filter.limit : -1));
    while (q.next()) out.push_back(row_of(q));
  } catch (const DatabaseFault& fault) {
    throw core::EnvironmentLacks(tr("the session store cannot be read: {}", fault.what()));
  }
  std::reverse(out.begin(), out.end());
  return out;
}

namespace {

/// The only attempt that `condition` on ?1 holds for.
template <class Value>
std::optional<Attempt> only_one(Database& db, const char* condition, const Value& value) {
  Query q(db, fmt::format("SELECT {}{}WHERE {} LIMIT 2", kAttemptColumns, kFrom, condition));
  if (!q.bind(value).next()) return std::nullopt;
  Attempt a = row_of(q);
  if (q.next()) return std::nullopt;
  return a;
}

/// Digits name a number. Eight of them may also be the beginning that lists show of a uuid (one in forty has no
/// letter there); fewer are not taken for one, or a number that does not exist would show somebody else's attempt.
std::optional<Attempt> find_row(Database& db, const std::string& name) {
  const bool number = name.size() < 10 && name.find_first_not_of("0123456789") == std::string::npos;
  if (auto whole = only_one(db, "a.uuid = ?1", name)) return whole;
  if (number)
    if (auto numbered = only_one(db, "a.number = ?1", std::int64_t(std::stoll(name))); numbered || name.size() < 8)
      return numbered;
  return only_one(db, "substr(a.uuid, 1, length(?1)) = ?1", name);
}

}  // namespace

std::optional<Attempt> Store::find(const std::string& name) const {
  std::error_code error;
  if (name.empty() || !fs::exists(database(), error)) return std::nullopt;
  try {
    Database db(database(), Database::Access::read, m_patience);
    std::optional<Attempt> a = find_row(db, name);
    if (!a) return std::nullopt;
    Query t(db, "SELECT samples FROM trace WHERE attempt = ?");
    t.bind(a->number);
    if (t.next()) a->trace = t.bytes(0);
    return a;
  } catch (const DatabaseFault& fault) {
    throw core::EnvironmentLacks(tr("the session store cannot be read: {}", fault.what()));
  }
}

std::vector<std::string> Store::trainees() const {
  std::vector<std::string> out;
  std::error_code error;
  if (!fs::exists(database(), error)) return out;
  try {
    Database db(database(), Database::Access::read, m_patience);
    Query q(db,
            "SELECT t.name FROM attempt a JOIN trainee t ON t.id = a.trainee GROUP BY t.id "
            "ORDER BY max(a.number) DESC");
    while (q.next()) out.push_back(q.text(0));
  } catch (const DatabaseFault& fault) {
    throw core::EnvironmentLacks(tr("the session store cannot be read: {}", fault.what()));
  }
  return out;
}

namespace {

/// Overwrites what is deleted in file and log. Empty, or why that is not so.
std::string overwrite_deleted(Database& db) {
  try {
    db.run("VACUUM");
    Query checkpoint(db, "PRAGMA wal_checkpoint(TRUNCATE)");
    return checkpoint.next() && checkpoint.integer(0) == 0 ? "" : "another program is reading the database";
  } catch (const DatabaseFault& fault) {
    return fault.what();
  }
}

}  // namespace

Store::Forgotten to_forget(const Store& store, const std::string& trainee) {
  Store::Forgotten out;
  std::error_code error;
  const fs::path ours = fs::weakly_canonical(store.folder() / "recordings", error);
  const fs::path own = own_temporary_folder(), temporary = own.empty() ? own : fs::weakly_canonical(own, error);
  for (const Attempt& a : store.list({.trainee = trainee})) {
    ++out.attempts;
    if (a.recording.empty() || !fs::exists(a.recording, error)) continue;
    const fs::path folder = fs::weakly_canonical(fs::path(a.recording).parent_path(), error);
    const bool inside = !folder.empty() && (folder == ours || folder == temporary);
    (inside ? out.deleted : out.left).emplace_back(a.recording);
  }
  for (const fs::path& file : files_in(store.folder()))
    if (file.filename().string().rfind("sessions.sqlite.damaged-", 0) == 0) out.left.push_back(file);
  for (const fs::path& file : files_in(store.folder() / "waiting"))
    if (file.extension() == kRefused) out.left.push_back(file);
  return out;
}

Store::Forgotten Store::forget(const std::string& trainee) {
  Forgotten out = to_forget(*this, trainee);
  try {
    Database db(database(), Database::Access::write, m_patience);
    make_durable(db);
    migrate(db);
    {
      Transaction all(db);
      Query(db, "DELETE FROM attempt WHERE trainee IN (SELECT id FROM trainee WHERE name = ?)").bind(trainee).done();
      Query(db, "DELETE FROM trainee WHERE name = ?").bind(trainee).done();
      all.commit();
    }
    out.not_overwritten = overwrite_deleted(db);
  } catch (const DatabaseFault& fault) {
    throw core::EnvironmentLacks(tr("nothing was deleted: {}", fault.what()));
  }
  const auto stays = std::stable_partition(out.deleted.begin(), out.deleted.end(), [](const fs::path& recording) {
    std::error_code error;
    return fs::remove(recording, error);
  });
  out.left.insert(out.left.begin(), stays, out.deleted.end());
  out.deleted.erase(stays, out.deleted.end());
  return out;
}

}  // namespace trocar::training
