#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/files.hpp>
#include <trocar/core/log.hpp>
#include <trocar/core/text.hpp>
#include <trocar/training/store/store_parts.hpp>

namespace trocar::training {

namespace fs = std::filesystem;

namespace {

constexpr unsigned kOwn = 0600;  // names are nobody else's business

std::string whole_reason(const std::string& what, const fs::path& kept) {
  return tr("{}; the result is kept in {} and imported when the store is next opened", what, kept.string());
}

}  // namespace

Store::Store(fs::path folder, int patience) : m_folder(std::move(folder)), m_patience(patience) {
  make_own_folder(m_folder);  // names are nobody else's business
  open();
}

Store::~Store() = default;

void Store::notice(const std::string& text) {
  if (std::find(m_notices.begin(), m_notices.end(), text) != m_notices.end()) return;
  core::log::warn("{}", text);
  m_notices.push_back(text);
}

/// Empty, or why the database did not take the row.
std::string Store::put(Attempt& attempt) {
  for (int round = 0; round < 2; ++round) {
    try {
      Database db(database(), Database::Access::write, m_patience);
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
    notice(tr("this attempt is not in the session store yet: {}", fault));
  return lock;
}

void Store::update(Attempt& attempt) {
  if (m_writable) put(attempt);
}

void Store::withdraw(const Attempt& attempt, AttemptLock& lock) {
  try {
    Database db(database(), Database::Access::write, m_patience);
    make_durable(db);
    Query(db, "DELETE FROM attempt WHERE uuid = ?").bind(attempt.uuid).done();
  } catch (const DatabaseFault& fault) {
    core::log::debug("{}", fault.what());
  }
  lock = {};
}

void Store::recording_moved(const fs::path& from, const fs::path& to) {
  try {
    Database db(database(), Database::Access::write, m_patience);
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
    notice(kept.anywhere() ? whole_reason(tr("the session store could not save the result: {}", fault), kept.file)
                           : tr("the result could not be saved ({}): a complete recording {} contains it", fault,
                                attempt.recording));
  }
  lock = {};
  return kept;
}

/// In a file where the next opening looks: in the store's folder, in the user's own temporary folder, or, where a row
/// says where that is, beside the recording.
Kept Store::set_down(const Attempt& attempt) {
  const std::string text = to_json(attempt);
  std::vector<fs::path> folders{m_folder / "waiting"};
  folders.push_back(own_temporary_folder());
  if (!attempt.recording.empty()) {
    // Without a row nobody finds it there, so that comes last; with one it outlives the temporary folder.
    const auto place = attempt.number > 0 ? folders.end() - 1 : folders.end();
    folders.insert(place, fs::path(attempt.recording).parent_path());
  }
  for (const fs::path& folder : folders) {
    if (folder.empty()) continue;
    std::error_code ignored;
    fs::create_directories(folder, ignored);
    const fs::path file = folder / (attempt.uuid + kWaiting), motion = folder / (attempt.uuid + kWaitingTrace);
    // The motion first: what is taken in is complete, wherever the program was killed.
    if (!attempt.trace.empty() && attempt.trace.size() <= kLargestTrace)
      core::write_file(motion, attempt.trace.data(), attempt.trace.size(), kOwn);
    if (core::write_file(file, text.data(), text.size(), kOwn).empty()) return {false, file};
    fs::remove(motion, ignored);
  }
  return {};
}

}  // namespace trocar::training
