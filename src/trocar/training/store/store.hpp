// The session store: every attempt that was ever begun, in one SQLite file beside the recordings. It is built to lose
// nothing: a result that the database does not take (full disk, read-only folder, locked or damaged file) goes into a
// small file and is taken in when the store is opened next; an attempt whose program died is found by the lock that
// died with it, and told with as much as its recording holds; a damaged database is set aside and built again from what
// is still readable and from the recordings. Any number of programs may use one store at a time.
//
//   Store store(folder);                                     // never throws: what is wrong stands in notices()
//   AttemptLock lock = store.begin(attempt);                 // "running", as long as the lock lives
//   attempt.state = AttemptState::finished; ...
//   store.end(attempt, lock);
//   for (const Attempt& a : store.list({.trainee = "ada"})) ...
//
// The store looks at no clock; times are the caller's texts, order is the number it gives. Layout:
// docs/guides/sessions.md.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <trocar/training/store/attempt.hpp>

namespace trocar::training {

class Database;

/// Says that an attempt's process lives, as long as it does, and keeps some room on the disk for the result.
class AttemptLock {
 public:
  AttemptLock() = default;
  /// Locks FOLDER/locks/UUID; without effect where that cannot be written.
  AttemptLock(const std::filesystem::path& folder, const std::string& uuid);
  ~AttemptLock();
  AttemptLock(AttemptLock&& other) noexcept;
  AttemptLock& operator=(AttemptLock&& other) noexcept;

  bool held() const { return m_file >= 0; }
  void give_room();  ///< lets go of the kept room: the result is about to be written

  /// Is there somebody who holds this attempt's lock?
  static bool is_held(const std::filesystem::path& folder, const std::string& uuid);

  /// Removes the files of locks that nobody holds: left by programs that died.
  static void sweep(const std::filesystem::path& folder);

  static constexpr std::int64_t kRoom = 1 << 20;  ///< [B]

 private:
  void release();
  std::filesystem::path m_path;
  int m_file = -1;
};

struct AttemptFilter {
  std::string trainee{}, exercise{};  ///< empty: all
  std::optional<std::uint64_t> seed{};
  std::optional<AttemptMode> mode{};
  int limit = 0;  ///< the newest so many; 0: all
};

/// Where an attempt's result came to be.
struct Kept {
  bool in_database = false;
  std::filesystem::path file;  ///< if not: the file that waits for the next opening
  bool anywhere() const { return in_database || !file.empty(); }
};

class Store {
 public:
  /// Opens FOLDER/sessions.sqlite (made if need be), brings it up to date, repairs it, takes in results that waited,
  /// and marks as interrupted what runs without a living program.
  /// @param patience  [ms] how long it waits for another program that writes
  explicit Store(std::filesystem::path folder, int patience = 5000);
  ~Store();

  /// A new row, state running; sets number, and uuid where it is empty. Without a database the attempt continues all
  /// the same and number stays 0.
  AttemptLock begin(Attempt& attempt);
  /// The row as it stands, if the database takes it; otherwise nothing.
  void update(Attempt& attempt);
  /// An attempt that never began: as if begin() had not been called.
  void withdraw(const Attempt& attempt, AttemptLock& lock);
  /// A recording got another name.
  void recording_moved(const std::filesystem::path& from, const std::filesystem::path& to);
  /// The row as it stands, in the database or in a file. `number` is set if the database took it.
  Kept end(Attempt& attempt, AttemptLock& lock);

  /// Oldest first, without traces.  @throws core::EnvironmentLacks when the database cannot be read
  std::vector<Attempt> list(const AttemptFilter& filter = {}) const;
  /// By number, uuid or its first digits; with its trace. Nothing: there is none, or there are several.
  std::optional<Attempt> find(const std::string& name) const;
  std::vector<std::string> trainees() const;  ///< who has attempts, last first

  /// Deletes a trainee's attempts, also from the database file's free pages, and those files of recordings that the
  /// store placed: in its own folder and in the user's temporary one. @throws core::EnvironmentLacks: nothing is
  /// deleted
  struct Forgotten {
    int attempts = 0;
    std::vector<std::filesystem::path> deleted;  ///< recordings
    std::vector<std::filesystem::path> left;     ///< recordings elsewhere, and set-aside databases: may hold the name
    std::string not_overwritten;  ///< empty, or why the database file's free pages still hold what was there
  };
  Forgotten forget(const std::string& trainee);

  /// What people should know: repairs, faults, what was taken in. Grows with every call that has something to say.
  const std::vector<std::string>& notices() const { return m_notices; }
  bool writable() const { return m_writable; }
  const std::filesystem::path& folder() const { return m_folder; }
  std::filesystem::path database() const { return m_folder / "sessions.sqlite"; }

  static constexpr int kVersion = 1;  ///< of the tables

 private:
  void open();
  void migrate(Database& db);
  void check(Database& db);
  bool damaged();  ///< still, or again: asked under the opening lock
  void repair(const std::string& what);
  int salvage(Database& db, const std::filesystem::path& damaged);
  void take_in_recordings(Database& db);
  void take_in_files(Database& db);
  void take_in(Database& db, Attempt& attempt, const std::filesystem::path& file);
  bool is_own(const std::filesystem::path& file, const Attempt& attempt);
  void settle_running(Database& db);
  void notice(const std::string& text);
  Kept set_down(const Attempt& attempt);
  std::string put(Attempt& attempt);

  std::filesystem::path m_folder;
  int m_patience;  ///< [ms]
  std::vector<std::string> m_notices;
  bool m_writable = false;
};

/// Makes a folder that is its user's alone (mode 0700); those above it as usual. One that is there stays as it is.
/// Nothing is said of failure.
void make_own_folder(const std::filesystem::path& folder);

/// TMPDIR/trocar-UID, where the store looks for results when it is opened: a real folder that belongs to this user and
/// that nobody else can enter, or nothing.
std::filesystem::path own_temporary_folder();

/// Fills what a recording knows of its attempt: everything if it has its end mark, else how far it reaches.
/// False: the file is no recording.
bool fill_from_recording(const std::filesystem::path& file, Attempt& attempt);

}  // namespace trocar::training
