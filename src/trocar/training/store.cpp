#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <tuple>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <trocar/core/error.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/log.hpp>
#include <trocar/sim/model.hpp>
#include <trocar/sim/recording.hpp>
#include <trocar/training/database.hpp>
#include <trocar/training/store.hpp>

namespace trocar::training {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::json;

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

constexpr const char* kColumns =
    "a.number, a.uuid, t.name, a.exercise, a.title, a.mode, a.seed, a.input, a.started, a.ended, a.state, a.score, "
    "a.passed, a.seconds, a.ticks, a.recording, a.result, a.program_version, a.model_hash, "
    "EXISTS (SELECT 1 FROM trace WHERE trace.attempt = a.number)";
/// The same without the trainee's table, for a database in which that may be gone.
constexpr const char* kAlone =
    "a.number, a.uuid, '', a.exercise, a.title, a.mode, a.seed, a.input, a.started, a.ended, a.state, a.score, "
    "a.passed, a.seconds, a.ticks, a.recording, a.result, a.program_version, a.model_hash, 0";
constexpr const char* kFrom = " FROM attempt a JOIN trainee t ON t.id = a.trainee ";

constexpr std::size_t kLargestResult = 16 << 20, kLargestTrace = 64 << 20, kLongestText = 4096;
constexpr std::uintmax_t kLargestChecked = 64 << 20;     ///< [B] a database above this is not checked at every opening
constexpr int kMostLost = 20'000;                        ///< numbers that are tried one by one where pages are gone
constexpr std::uint64_t kLargestNumber = 1'000'000'000;  ///< that a file may claim
constexpr const char* kWaiting = ".attempt.json";        ///< results that the database did not take
constexpr const char* kWaitingTrace = ".attempt.trace";

/// One program at a time opens, repairs and takes in. Without effect where the folder cannot be written.
class OpeningLock {
 public:
  explicit OpeningLock(const fs::path& folder)
      : m_file(::open((folder / "sessions.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)) {
    for (int tries = 0; m_file >= 0 && tries < 500 && flock(m_file, LOCK_EX | LOCK_NB) != 0; ++tries) usleep(20'000);
  }
  ~OpeningLock() {
    if (m_file >= 0) close(m_file);
  }
  OpeningLock(const OpeningLock&) = delete;
  OpeningLock& operator=(const OpeningLock&) = delete;

 private:
  int m_file;
};

std::string bounded(const std::string& text, std::size_t most = kLongestText) { return text.substr(0, most); }

/// What lies in a folder, by name. What cannot be listed is left out: a folder may vanish or fail while it is read.
std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> out;
  std::error_code error;
  fs::directory_iterator at(folder, error);
  for (; !error && at != fs::directory_iterator(); at.increment(error)) out.push_back(at->path());
  std::sort(out.begin(), out.end());
  return out;
}

std::string read_file(const fs::path& path, std::size_t most) {
  std::error_code error;
  if (!fs::is_regular_file(path, error) || fs::file_size(path, error) > most) return {};
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The whole content under its name or nothing, on the disk when this returns. Empty, or what the system said.
std::string write_file(const fs::path& path, const void* bytes, std::size_t size) {
  const std::string part = path.string() + ".part";
  const int file = ::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (file < 0) return std::strerror(errno);
  const char* at = static_cast<const char*>(bytes);
  bool good = true;
  while (good && size > 0) {
    const ssize_t wrote = ::write(file, at, size);
    if (wrote < 0 && errno == EINTR) continue;
    good = wrote > 0;
    if (good) at += wrote, size -= size_t(wrote);
  }
  good = good && fsync(file) == 0;
  std::string said = good ? "" : std::strerror(errno);
  if (close(file) != 0 && said.empty()) said = std::strerror(errno);
  if (said.empty() && rename(part.c_str(), path.c_str()) != 0) said = std::strerror(errno);
  if (!said.empty()) unlink(part.c_str());
  return said;
}

/// A folder that only this user can write, or nothing.
fs::path own_temporary_folder() {
  std::error_code error;
  const fs::path base = fs::temp_directory_path(error);
  if (error) return {};
  const fs::path folder = base / fmt::format("trocar-{}", getuid());
  mkdir(folder.c_str(), 0700);
  struct stat info {};
  const bool ours = lstat(folder.c_str(), &info) == 0 && S_ISDIR(info.st_mode) && info.st_uid == getuid() &&
                    (info.st_mode & 077) == 0;
  return ours ? folder : fs::path();
}

Attempt row_of(const Query& q) {
  Attempt a;
  a.number = q.integer(0);
  a.uuid = q.text(1);
  a.trainee = q.text(2);
  a.exercise = q.text(3);
  a.title = q.text(4);
  a.mode = mode_named(q.text(5)).value_or(AttemptMode::assessed);
  a.seed = std::uint64_t(q.integer(6));
  a.input = q.text(7);
  a.started = q.text(8);
  a.ended = q.text(9);
  a.state = state_named(q.text(10)).value_or(AttemptState::interrupted);
  if (q.has(11)) a.score = q.real(11);
  if (q.has(12)) a.passed = q.integer(12) != 0;
  a.seconds = q.real(13);
  a.ticks = std::uint64_t(q.integer(14));
  a.recording = q.text(15);
  a.result = q.text(16);
  a.program_version = q.text(17);
  a.model_hash = std::uint64_t(q.integer(18));
  a.has_trace = q.integer(19) != 0;
  return a;
}

std::int64_t trainee_id(Database& db, const std::string& name) {
  Query(db, "INSERT INTO trainee (name) VALUES (?) ON CONFLICT (name) DO NOTHING").bind(name).done();
  Query q(db, "SELECT id FROM trainee WHERE name = ?");
  q.bind(name);
  return q.next() ? q.integer(0) : 0;
}

std::optional<AttemptState> state_in(Database& db, const std::string& uuid) {
  Query q(db, "SELECT state FROM attempt WHERE uuid = ?");
  q.bind(uuid);
  return q.next() ? state_named(q.text(0)) : std::nullopt;
}

/// The row of `a.uuid`, new or as it is now; sets a.number.
void write_row(Database& db, Attempt& a) {
  const std::int64_t trainee = trainee_id(db, a.trainee);
  Query taken(db, "SELECT 1 FROM attempt WHERE number = ? AND uuid <> ?");
  const bool number_is_free =
      a.number > 0 && std::uint64_t(a.number) < kLargestNumber && !taken.bind(a.number).bind(a.uuid).next();
  Query q(db,
          "INSERT INTO attempt (number, uuid, trainee, exercise, title, mode, seed, input, started, ended, state, "
          "score, passed, seconds, ticks, recording, result, program_version, model_hash) "
          "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?) "
          "ON CONFLICT (uuid) DO UPDATE SET trainee = excluded.trainee, title = excluded.title, mode = excluded.mode, "
          "ended = excluded.ended, state = excluded.state, score = excluded.score, passed = excluded.passed, "
          "seconds = excluded.seconds, ticks = excluded.ticks, recording = excluded.recording, "
          "result = excluded.result");
  if (number_is_free)
    q.bind(a.number);
  else
    q.bind_nothing();
  q.bind(a.uuid).bind(trainee).bind(bounded(a.exercise)).bind(bounded(a.title)).bind(std::string(name_of(a.mode)));
  q.bind(std::int64_t(a.seed)).bind(bounded(a.input)).bind(bounded(a.started)).bind(bounded(a.ended));
  q.bind(std::string(name_of(a.state))).bind(a.score);
  q.bind(a.passed ? std::optional<std::int64_t>(*a.passed) : std::nullopt);
  q.bind(a.seconds).bind(std::int64_t(a.ticks)).bind(bounded(a.recording));
  q.bind(a.result.size() <= kLargestResult ? a.result : std::string("{\"left_out\":\"the result is too large\"}"));
  q.bind(bounded(a.program_version)).bind(std::int64_t(a.model_hash)).done();
  Query number(db, "SELECT number FROM attempt WHERE uuid = ?");
  number.bind(a.uuid);
  if (number.next()) a.number = number.integer(0);
  if (a.trace.empty() || a.trace.size() > kLargestTrace) return;
  Query(db,
        "INSERT INTO trace (attempt, samples) VALUES (?, ?) ON CONFLICT (attempt) DO UPDATE SET samples = "
        "excluded.samples")
      .bind(a.number)
      .bind(std::span<const std::uint8_t>(a.trace))
      .done();
}

/// Every transaction is on the disk when it returns, also if the power goes the moment after.
void make_durable(Database& db) {
  db.run("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON; PRAGMA secure_delete = ON;");
}

std::string whole_reason(const std::string& what, const fs::path& kept) {
  return fmt::format("{}; the result is kept in {} and taken in when the store is opened next", what, kept.string());
}

std::string text_in(const Json& object, const char* key) {
  const auto at = object.find(key);
  return at != object.end() && at->is_string() ? at->get<std::string>() : std::string();
}

}  // namespace

void fill_from_result(const std::string& result, Attempt& a) {
  const Json in = Json::parse(result, nullptr, false);
  if (!in.is_object()) return;
  a.result = result;
  if (in.contains("passed") && in["passed"].is_boolean()) a.passed = in["passed"].get<bool>();
  if (in.contains("ticks") && in["ticks"].is_number_unsigned()) a.ticks = in["ticks"].get<std::uint64_t>();
  a.seconds = double(a.ticks) * sim::kTick;
  const Json::json_pointer total("/assessment/score/total");
  if (in.contains(total) && in[total].is_number()) a.score = in[total].get<double>();
  if (a.mode == AttemptMode::familiarisation) a.score.reset(), a.passed.reset();
}

bool fill_from_recording(const fs::path& file, Attempt& a) {
  sim::Recording r;
  try {
    r = sim::read_recording(file);
  } catch (const std::exception&) {
    return false;
  }
  const Json note = Json::parse(r.header.metadata_json, nullptr, false);
  a.recording = fs::absolute(file).string();
  a.exercise = bounded(r.header.exercise);
  a.seed = r.header.seed;
  a.program_version = bounded(r.header.program_version);
  a.model_hash = r.header.model_hash;
  a.ticks = r.inputs.size();
  a.seconds = double(a.ticks) * sim::kTick;
  if (note.is_object()) {
    if (a.uuid.empty() && is_uuid(text_in(note, "uuid"))) a.uuid = text_in(note, "uuid");
    const std::uint64_t number =
        note.contains("number") && note["number"].is_number_unsigned() ? note["number"].get<std::uint64_t>() : 0;
    if (a.number == 0 && number < kLargestNumber) a.number = std::int64_t(number);
    if (a.trainee.empty()) a.trainee = clean_name(text_in(note, "trainee"));
    if (a.title.empty()) a.title = bounded(text_in(note, "title"));
    if (a.input.empty()) a.input = bounded(text_in(note, "input"));
    if (a.started.empty()) a.started = bounded(text_in(note, "started"));
    a.mode = mode_named(text_in(note, "mode")).value_or(a.mode);
  }
  if (a.uuid.empty())  // made before attempts had one: the same file is the same attempt
    a.uuid = fmt::format("recording-{:016x}",
                         core::hash_bytes(r.header.metadata_json.data(), r.header.metadata_json.size(), a.model_hash));
  a.state = AttemptState::interrupted;
  if (r.complete) {
    fill_from_result(r.result_json, a);
    const Json result = Json::parse(r.result_json, nullptr, false);
    const bool aborted = result.is_object() && result.contains("interrupted");
    a.state = aborted ? AttemptState::aborted : AttemptState::finished;
    if (result.is_object() && a.ended.empty()) a.ended = bounded(text_in(result, "ended"));
  }
  return true;
}

Store::Store(fs::path folder) : m_folder(std::move(folder)) {
  std::error_code error;
  if (fs::create_directories(m_folder, error))
    fs::permissions(m_folder, fs::perms::owner_all, error);  // names are nobody else's business
  open();
}

Store::~Store() = default;

void Store::notice(const std::string& text) {
  if (std::find(m_notices.begin(), m_notices.end(), text) != m_notices.end()) return;
  core::log::warn("{}", text);
  m_notices.push_back(text);
}

void Store::open() {
  const OpeningLock lock(m_folder);
  for (int round = 0; round < 2; ++round) {
    try {
      std::error_code error;
      const bool fresh = !fs::exists(database(), error);
      Database db(database(), Database::Access::write);
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
        notice(fmt::format("the session store cannot be written: {}", fault.what()));
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
  if (q.next() && q.text(0) != "ok") throw DatabaseFault(database().string() + ": " + q.text(0), 11 /*SQLITE_CORRUPT*/);
}

bool Store::damaged() {
  try {
    Database db(database(), Database::Access::write);
    make_durable(db);
    check(db);
    migrate(db);
    return false;
  } catch (const DatabaseFault& fault) {
    return fault.damaged();
  }
}

void Store::migrate(Database& db) {
  if (db.number_of("PRAGMA user_version") == kVersion) return;
  Transaction all(db);
  const std::int64_t version = db.number_of("PRAGMA user_version");
  if (version > kVersion)
    throw DatabaseFault(fmt::format("{}: made by a newer Trocar (version {} of the tables, this one knows {})",
                                    database().string(), version, kVersion),
                        8 /*SQLITE_READONLY*/);
  for (std::int64_t v = version; v < kVersion; ++v) db.run(kMigrations[v]);
  db.run(fmt::format("PRAGMA user_version = {}", kVersion));
  all.commit();
}

void Store::repair(const std::string& what) {
  fs::path aside;
  std::error_code error;
  for (int n = 1; aside.empty() || fs::exists(aside, error); ++n)
    aside = m_folder / fmt::format("sessions.sqlite.damaged-{}", n);
  fs::rename(database(), aside, error);
  if (error) {
    notice(fmt::format("{} is damaged ({}) and cannot be set aside: {}", database().string(), what, error.message()));
    return;
  }
  for (const char* tail : {"-wal", "-shm"}) fs::rename(database().string() + tail, aside.string() + tail, error);
  notice(fmt::format("the session store was damaged ({}): it is set aside as {} and built anew", what, aside.string()));
  try {
    Database db(database(), Database::Access::write);
    make_durable(db);
    migrate(db);
    salvage(db, aside);
    take_in_recordings(db);
  } catch (const DatabaseFault& fault) {
    notice(fmt::format("the session store could not be built anew: {}", fault.what()));
  }
}

/// Row by row, since a page that is gone takes only its own rows along.
void Store::salvage(Database& db, const fs::path& damaged) {
  const auto readable = [](const auto& read) {
    try {
      read();
      return true;
    } catch (const DatabaseFault&) {
      return false;
    }
  };
  int saved = 0;
  const bool opened = readable([&] {
    Database old(damaged, Database::Access::read);
    int lost = 0;
    for (std::int64_t number = 0; lost < kMostLost;) {
      Attempt a;
      std::int64_t trainee = 0;
      bool more = true;
      const bool sound = readable([&] {
        Query q(old, fmt::format("SELECT {}, a.trainee FROM attempt a NOT INDEXED WHERE a.number > ? "
                                 "ORDER BY a.number LIMIT 1",
                                 kAlone));
        q.bind(number);
        more = q.next();
        if (!more) return;
        a = row_of(q);
        trainee = q.integer(20);
      });
      if (!more) break;
      if (!sound || a.number <= number) {  // on a page that is gone; or one that is read wrongly
        ++number, ++lost;
        continue;
      }
      number = a.number;
      if (a.uuid.empty() || state_in(db, a.uuid)) continue;
      readable([&] {
        Query q(old, "SELECT name FROM trainee NOT INDEXED WHERE id = ?");
        q.bind(trainee);
        if (q.next()) a.trainee = clean_name(q.text(0));
      });
      readable([&] {
        Query q(old, "SELECT samples FROM trace WHERE attempt = ?");
        q.bind(number);
        if (q.next()) a.trace = q.bytes(0);
      });
      Attempt from_recording;
      if (a.trainee.empty() && !a.recording.empty() && fill_from_recording(a.recording, from_recording) &&
          from_recording.uuid == a.uuid)
        a.trainee = from_recording.trainee;
      if (a.trainee.empty()) a.trainee = fmt::format("trainee {}", trainee);
      Transaction one(db);
      write_row(db, a);
      one.commit();
      ++saved;
    }
  });
  if (opened && saved > 0) notice(fmt::format("{} attempts were read from the damaged store", saved));
}

void Store::take_in_recordings(Database& db) {
  std::vector<Attempt> found;
  for (const fs::path& file : files_in(m_folder / "recordings")) {
    Attempt a;
    if (file.extension() != ".rec" || !fill_from_recording(file, a)) continue;
    if (state_in(db, a.uuid)) continue;
    if (AttemptLock::is_held(m_folder, a.uuid)) a.state = AttemptState::running;
    if (a.trainee.empty()) a.trainee = "guest";
    found.push_back(std::move(a));
  }
  if (found.empty()) return;
  const auto begun_before = [](const Attempt& a, const Attempt& b) {
    return std::tie(a.number, a.started, a.uuid) < std::tie(b.number, b.started, b.uuid);
  };
  std::sort(found.begin(), found.end(), begun_before);
  Transaction all(db);
  for (Attempt& a : found) write_row(db, a);
  all.commit();
  notice(fmt::format("{} attempts were taken in from their recordings", found.size()));
}

void Store::take_in_files(Database& db) {
  std::vector<fs::path> folders{m_folder / "waiting", own_temporary_folder()};
  Query running(db, "SELECT recording FROM attempt WHERE state = 'running' AND recording <> ''");
  while (running.next()) folders.push_back(fs::path(running.text(0)).parent_path());
  std::sort(folders.begin(), folders.end());
  folders.erase(std::unique(folders.begin(), folders.end()), folders.end());

  std::vector<std::pair<Attempt, fs::path>> found;
  for (const fs::path& folder : folders) {
    if (folder.empty()) continue;
    for (const fs::path& file : files_in(folder)) {
      const std::string name = file.filename().string();
      if (name.size() < std::strlen(kWaiting) || name.substr(name.size() - std::strlen(kWaiting)) != kWaiting) continue;
      std::optional<Attempt> a = attempt_from_json(read_file(file, 2 * kLargestResult));
      // Other folders are everybody's: there an attempt must say that it belongs to this store.
      const bool ours =
          a && (a->store == fs::absolute(m_folder).string() || (a->store.empty() && folder == m_folder / "waiting"));
      if (!ours) continue;
      if (a->trainee.empty()) a->trainee = "guest";
      const std::string trace =
          read_file(folder / (name.substr(0, name.size() - std::strlen(kWaiting)) + kWaitingTrace), kLargestTrace);
      a->trace.assign(trace.begin(), trace.end());
      found.emplace_back(std::move(*a), file);
    }
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return std::tie(a.first.number, a.first.started, a.first.uuid) <
           std::tie(b.first.number, b.first.started, b.first.uuid);
  });
  for (auto& [attempt, file] : found) {
    Transaction one(db);
    write_row(db, attempt);
    one.commit();
    std::error_code ignored;
    fs::remove(file, ignored);
    std::string trace = file.string();
    trace.replace(trace.size() - std::strlen(kWaiting), std::string::npos, kWaitingTrace);
    fs::remove(trace, ignored);
    notice(fmt::format("an attempt's result that had waited in {} was taken in", file.string()));
  }
}

void Store::settle_running(Database& db) {
  std::vector<Attempt> rows;
  {
    Query q(db, fmt::format("SELECT {}{}WHERE a.state = 'running' ORDER BY a.number", kColumns, kFrom));
    while (q.next()) rows.push_back(row_of(q));
  }
  for (Attempt& a : rows) {
    if (AttemptLock::is_held(m_folder, a.uuid)) continue;
    a.state = AttemptState::interrupted;
    Attempt there = a;
    // Somebody else's recording under the same name says nothing of this attempt.
    Attempt header;
    if (!a.recording.empty() && fill_from_recording(a.recording, header) && header.uuid == a.uuid &&
        fill_from_recording(a.recording, there))
      a = there;
    Transaction one(db);
    if (state_in(db, a.uuid) == AttemptState::running && !AttemptLock::is_held(m_folder, a.uuid)) write_row(db, a);
    one.commit();
    if (a.state == AttemptState::interrupted)
      notice(fmt::format("attempt {} was interrupted: the program ended without saying so; {}", a.number,
                         a.ticks > 0 ? fmt::format("its recording reaches {:.1f} s", a.seconds)
                                     : std::string("there is no recording of it")));
    else
      notice(fmt::format("attempt {} had ended: its result was taken from its recording", a.number));
  }
}

/// Empty, or why the database did not take the row.
std::string Store::put(Attempt& attempt) {
  for (int round = 0; round < 2; ++round) {
    try {
      Database db(database(), Database::Access::write);
      make_durable(db);
      migrate(db);
      Transaction one(db);
      write_row(db, attempt);
      one.commit();
      m_writable = true;
      return {};
    } catch (const DatabaseFault& fault) {
      m_writable = false;
      if (!fault.damaged() || round > 0) return fault.what();
      const OpeningLock lock(m_folder);
      if (damaged()) repair(fault.what());  // unless another program has repaired it meanwhile
    }
  }
  return "the database stays damaged";
}

AttemptLock Store::begin(Attempt& attempt) {
  if (attempt.uuid.empty()) attempt.uuid = new_uuid();
  attempt.trainee = clean_name(attempt.trainee);
  if (attempt.trainee.empty()) attempt.trainee = "guest";
  attempt.state = AttemptState::running;
  attempt.store = fs::absolute(m_folder).string();
  AttemptLock lock(m_folder, attempt.uuid);
  if (const std::string fault = put(attempt); !fault.empty())
    notice(fmt::format("this attempt is not in the session store yet: {}", fault));
  return lock;
}

void Store::update(Attempt& attempt) {
  if (m_writable) put(attempt);
}

void Store::withdraw(const Attempt& attempt, AttemptLock& lock) {
  try {
    Database db(database(), Database::Access::write);
    make_durable(db);
    Query(db, "DELETE FROM attempt WHERE uuid = ?").bind(attempt.uuid).done();
  } catch (const DatabaseFault& fault) {
    core::log::debug("{}", fault.what());
  }
  lock = {};
}

void Store::recording_moved(const fs::path& from, const fs::path& to) {
  try {
    Database db(database(), Database::Access::write);
    make_durable(db);
    migrate(db);
    Query(db, "UPDATE attempt SET recording = ? WHERE recording = ?")
        .bind(fs::absolute(to).string())
        .bind(fs::absolute(from).string())
        .done();
  } catch (const DatabaseFault& fault) {
    core::log::debug("{}", fault.what());
  }
}

Kept Store::end(Attempt& attempt, AttemptLock& lock) {
  lock.give_room();
  Kept kept;
  const std::string fault = put(attempt);
  if (fault.empty()) {
    kept.in_database = true;
  } else {
    kept = set_down(attempt);
    notice(
        kept.anywhere()
            ? whole_reason(fmt::format("the session store did not take the result: {}", fault), kept.file)
            : fmt::format("the result could not be kept anywhere ({}): it is in the recording {} if that has its end",
                          fault, attempt.recording));
  }
  lock = {};
  return kept;
}

/// In a file: in the store's folder, beside the recording, or in the user's own temporary folder.
Kept Store::set_down(const Attempt& attempt) {
  const std::string text = to_json(attempt);
  std::vector<fs::path> folders{m_folder / "waiting"};
  if (!attempt.recording.empty()) folders.push_back(fs::path(attempt.recording).parent_path());
  folders.push_back(own_temporary_folder());
  for (const fs::path& folder : folders) {
    if (folder.empty()) continue;
    std::error_code ignored;
    fs::create_directories(folder, ignored);
    const fs::path file = folder / (attempt.uuid + kWaiting);
    if (!write_file(file, text.data(), text.size()).empty()) continue;
    if (!attempt.trace.empty() && attempt.trace.size() <= kLargestTrace)
      write_file(folder / (attempt.uuid + kWaitingTrace), attempt.trace.data(), attempt.trace.size());
    return {false, file};
  }
  return {};
}

std::vector<Attempt> Store::list(const AttemptFilter& filter) const {
  std::vector<Attempt> out;
  std::error_code error;
  if (!fs::exists(database(), error)) return out;
  try {
    Database db(database(), Database::Access::read);
    Query q(db, fmt::format("SELECT {}{}WHERE (?1 = '' OR t.name = ?1) AND (?2 = '' OR a.exercise = ?2) "
                            "AND (?3 IS NULL OR a.seed = ?3) AND (?4 IS NULL OR a.mode = ?4) "
                            "ORDER BY a.number DESC LIMIT ?5",
                            kColumns, kFrom));
    q.bind(filter.trainee).bind(filter.exercise);
    q.bind(filter.seed ? std::optional<std::int64_t>(std::int64_t(*filter.seed)) : std::nullopt);
    q.bind(filter.mode ? std::optional<std::string>(name_of(*filter.mode)) : std::nullopt);
    q.bind(std::int64_t(filter.limit > 0 ? filter.limit : -1));
    while (q.next()) out.push_back(row_of(q));
  } catch (const DatabaseFault& fault) {
    throw core::EnvironmentLacks(fmt::format("the session store cannot be read: {}", fault.what()));
  }
  std::reverse(out.begin(), out.end());
  return out;
}

std::optional<Attempt> Store::find(const std::string& name) const {
  std::error_code error;
  if (name.empty() || !fs::exists(database(), error)) return std::nullopt;
  const bool number = name.size() < 10 && name.find_first_not_of("0123456789") == std::string::npos;
  try {
    Database db(database(), Database::Access::read);
    Query q(db, fmt::format("SELECT {}{}WHERE {} LIMIT 2", kColumns, kFrom,
                            number ? "a.number = ?1" : "substr(a.uuid, 1, length(?1)) = ?1"));
    if (number)
      q.bind(std::int64_t(std::stoll(name)));
    else
      q.bind(name);
    if (!q.next()) return std::nullopt;
    Attempt a = row_of(q);
    if (q.next()) return std::nullopt;
    Query t(db, "SELECT samples FROM trace WHERE attempt = ?");
    t.bind(a.number);
    if (t.next()) a.trace = t.bytes(0);
    return a;
  } catch (const DatabaseFault& fault) {
    throw core::EnvironmentLacks(fmt::format("the session store cannot be read: {}", fault.what()));
  }
}

std::vector<std::string> Store::trainees() const {
  std::vector<std::string> out;
  std::error_code error;
  if (!fs::exists(database(), error)) return out;
  try {
    Database db(database(), Database::Access::read);
    Query q(db,
            "SELECT t.name FROM attempt a JOIN trainee t ON t.id = a.trainee GROUP BY t.id "
            "ORDER BY max(a.number) DESC");
    while (q.next()) out.push_back(q.text(0));
  } catch (const DatabaseFault& fault) {
    throw core::EnvironmentLacks(fmt::format("the session store cannot be read: {}", fault.what()));
  }
  return out;
}

Store::Forgotten Store::forget(const std::string& trainee) {
  Forgotten out;
  std::vector<std::string> recordings;
  for (const Attempt& a : list({.trainee = trainee})) {
    ++out.attempts;
    if (!a.recording.empty()) recordings.push_back(a.recording);
  }
  try {
    Database db(database(), Database::Access::write);
    make_durable(db);
    migrate(db);
    {
      Transaction all(db);
      Query(db, "DELETE FROM attempt WHERE trainee IN (SELECT id FROM trainee WHERE name = ?)").bind(trainee).done();
      Query(db, "DELETE FROM trainee WHERE name = ?").bind(trainee).done();
      all.commit();
    }
    db.run("VACUUM; PRAGMA wal_checkpoint(TRUNCATE);");
  } catch (const DatabaseFault& fault) {
    throw core::EnvironmentLacks(fmt::format("nothing was deleted: {}", fault.what()));
  }
  std::error_code error;
  const fs::path ours = fs::weakly_canonical(m_folder / "recordings", error);
  for (const std::string& r : recordings) {
    if (!fs::exists(r, error)) continue;
    const bool inside = fs::weakly_canonical(fs::path(r).parent_path(), error) == ours;
    if (inside && fs::remove(r, error))
      out.deleted.emplace_back(r);
    else
      out.left.emplace_back(r);
  }
  for (const fs::path& file : files_in(m_folder))
    if (file.filename().string().rfind("sessions.sqlite.damaged-", 0) == 0) out.left.push_back(file);
  return out;
}

}  // namespace trocar::training
