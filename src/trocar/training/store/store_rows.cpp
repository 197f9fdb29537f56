#include <trocar/training/store/store_parts.hpp>

namespace trocar::training {
namespace {

std::int64_t trainee_id(Database& db, const std::string& name) {
  Query(db, "INSERT INTO trainee (name) VALUES (?) ON CONFLICT (name) DO NOTHING").bind(name).done();
  Query q(db, "SELECT id FROM trainee WHERE name = ?");
  q.bind(name);
  return q.next() ? q.integer(0) : 0;
}

}  // namespace

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

std::optional<AttemptState> state_in(Database& db, const std::string& uuid) {
  Query q(db, "SELECT state FROM attempt WHERE uuid = ?");
  q.bind(uuid);
  return q.next() ? state_named(q.text(0)) : std::nullopt;
}

std::optional<Attempt> row_in(Database& db, const std::string& uuid) {
  Query q(db, std::string("SELECT ") + kAttemptColumns + kFrom + "WHERE a.uuid = ?");
  q.bind(uuid);
  return q.next() ? std::optional(row_of(q)) : std::nullopt;
}

void check_tables(Database& db) {
  try {
    const Query q(db, std::string("SELECT ") + kAttemptColumns + kFrom + "LIMIT 0");
    const Query traces(db, "SELECT attempt, samples FROM trace LIMIT 0");
  } catch (const DatabaseFault& fault) {
    if (!fault.is_schema()) throw;
    throw DatabaseFault(fault.what(), DatabaseFault::kDamaged);
  }
}

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

void make_durable(Database& db) {
  db.run("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON; PRAGMA secure_delete = ON;");
}

}  // namespace trocar::training
