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
  notice(tr("{} attempts were imported from their recordings", found.size()));
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
    notice(tr("an attempt's result was imported from {}", file.string()));
  }
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
        fill_from_recording(a.recording, there))
      a = there;
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
