// What the database does not know yet: recordings, results that waited in files, attempts whose program died.
#include <algorithm>
#include <cstring>
#include <tuple>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/training/store/store_parts.hpp>

namespace trocar::training {

namespace fs = std::filesystem;

void Store::take_in_recordings(Database& db) {
  std::vector<Attempt> found;
  for (const fs::path& file : files_in(m_folder / "recordings")) {
    Attempt a;
    if (file.extension() != ".rec" || !fill_from_recording(file, a)) continue;
    if (state_in(db, a.uuid)) continue;
    if (AttemptLock::is_held(m_folder, a.uuid)) a.state = AttemptState::running;
    if (a.trainee.empty()) a.trainee = "guest";
    mark_unverified(a);
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
  notice(tr("{} attempts were imported from their recordings; their scores are not verified", found.size()));
}

namespace {

bool ends_with(const std::string& name, const char* ending) {
  const std::size_t size = std::strlen(ending);
  return name.size() >= size && name.compare(name.size() - size, size, ending) == 0;
}

/// The motion that waits with a result.
fs::path trace_of(const fs::path& file) {
  std::string name = file.string();
  return name.replace(name.size() - std::strlen(kWaiting), std::string::npos, kWaitingTrace);
}

/// Also by another name: a link, a slash at its end.
bool same_folder(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return fs::equivalent(a, b, error) || fs::weakly_canonical(a, error) == fs::weakly_canonical(b, error);
}

bool has_ended(const Attempt& row) { return row.state == AttemptState::finished || row.state == AttemptState::aborted; }

/// Is the row as the file says already? Then the program was killed before it took the file away.
bool is_taken_in(const Attempt& row, const Attempt& a) {
  return row.state == a.state && row.trainee == a.trainee && row.score == a.score && row.result == a.result;
}

/// Empty, or why a file may not complete this row. It never changes whose an attempt is, nor one that has ended.
std::string refusal(const Attempt& row, const Attempt& a) {
  if (has_ended(row)) return tr("attempt {} has ended already", row.number);
  if (row.trainee != a.trainee || row.exercise != a.exercise || row.seed != a.seed)
    return tr("attempt {} is of another trainee, exercise or patient", row.number);
  return {};
}

void take_away(const fs::path& file) {
  std::error_code ignored;
  fs::remove(file, ignored);
  fs::remove(trace_of(file), ignored);
}

}  // namespace

/// Does the file belong to this store? What lies in its own folder does, whatever that was called before. Elsewhere the
/// file must say so; one of a store that is gone is reported.
bool Store::is_own(const fs::path& file, const Attempt& a) {
  if (same_folder(file.parent_path(), m_folder / "waiting")) return true;
  if (a.store.empty() || same_folder(a.store, m_folder)) return !a.store.empty();
  std::error_code error;
  if (!fs::exists(a.store, error))
    notice(tr("{} is a result for {}, which is not there: move it to {} to import it", file.string(), a.store,
              (m_folder / "waiting").string()));
  return false;
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
      if (!ends_with(file.filename().string(), kWaiting)) continue;
      std::optional<Attempt> a = attempt_from_json(read_file(file, 2 * kLargestResult));
      if (!a && folder == m_folder / "waiting")
        notice(tr("{} is no result of an attempt and stays where it is", file.string()));
      if (!a || !is_own(file, *a)) continue;
      if (a->trainee.empty()) a->trainee = "guest";
      const bool own = same_folder(folder, m_folder / "waiting") || folder == own_temporary_folder();
      if (!own) mark_unverified(*a);  // it may come from anybody
      const std::string trace = read_file(trace_of(file), kLargestTrace);
      a->trace.assign(trace.begin(), trace.end());
      found.emplace_back(std::move(*a), file);
    }
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
    return std::tie(a.first.number, a.first.started, a.first.uuid) <
           std::tie(b.first.number, b.first.started, b.first.uuid);
  });
  for (auto& [attempt, file] : found) take_in(db, attempt, file);
}

void Store::take_in(Database& db, Attempt& attempt, const fs::path& file) {
  Transaction one(db);
  const std::optional<Attempt> row = row_in(db, attempt.uuid);
  if (row && is_taken_in(*row, attempt)) return take_away(file);
  if (const std::string why = row ? refusal(*row, attempt) : std::string(); !why.empty()) {
    std::error_code error;
    const fs::path kept = file.string() + kRefused;
    fs::rename(file, kept, error);
    return notice(tr("{} was not imported: {}. It is kept as {}", file.string(), why, (error ? file : kept).string()));
  }
  write_row(db, attempt);
  one.commit();
  take_away(file);
  notice(tr("an attempt's result was imported from {}", file.string()));
}

void Store::settle_running(Database& db) {
  std::vector<Attempt> rows;
  {
    Query q(db, fmt::format("SELECT {}{}WHERE a.state = 'running' ORDER BY a.number", kAttemptColumns, kFrom));
    while (q.next()) rows.push_back(row_of(q));
  }
  for (Attempt& a : rows) {
    if (AttemptLock::is_held(m_folder, a.uuid)) continue;
    a.state = AttemptState::interrupted;
    Attempt there = a;
    // Somebody else's recording under the same name says nothing of this attempt.
    Attempt header;
    if (!a.recording.empty() && fill_from_recording(a.recording, header) && header.uuid == a.uuid &&
        fill_from_recording(a.recording, there)) {
      a = there;
      mark_unverified(a);
    }
    Transaction one(db);
    // Between our reading the rows and asking for its lock it may have ended in its own program, as it should.
    if (state_in(db, a.uuid) != AttemptState::running || AttemptLock::is_held(m_folder, a.uuid)) continue;
    write_row(db, a);
    one.commit();
    if (a.state == AttemptState::interrupted)
      notice(tr("attempt {} was interrupted: the program ended unexpectedly; {}", a.number,
                a.ticks > 0 ? tr("its recording reaches {:.1f} s", a.seconds) : std::string("it has no recording")));
    else
      notice(tr("attempt {} had ended: its result was imported from its recording", a.number));
  }
}

}  // namespace trocar::training
