// What the files of the session store share: rows in SQL (store_rows.cpp) and files on the disk (store_files.cpp).
// Private to the folder; who uses the store wants store.hpp.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <trocar/training/store/attempt.hpp>
#include <trocar/training/store/database.hpp>
#include <trocar/training/store/store.hpp>

namespace trocar::training {

inline constexpr std::size_t kLargestResult = 16 << 20, kLargestTrace = 64 << 20, kLongestText = 4096;  ///< [B]
inline constexpr std::uint64_t kLargestNumber = 1'000'000'000;  ///< that a file may claim
inline constexpr const char* kWaiting = ".attempt.json";        ///< results that the database did not take
inline constexpr const char* kWaitingTrace = ".attempt.trace";
inline constexpr const char* kRefused = ".refused";  ///< behind the name of a file that was not taken in

inline std::string bounded(const std::string& text) { return text.substr(0, kLongestText); }

/// What row_of() reads, of attempt a and trainee t.
inline constexpr const char* kAttemptColumns =
    "a.number, a.uuid, t.name, a.exercise, a.title, a.mode, a.seed, a.input, a.started, a.ended, a.state, a.score, "
    "a.passed, a.seconds, a.ticks, a.recording, a.result, a.program_version, a.model_hash, "
    "EXISTS (SELECT 1 FROM trace WHERE trace.attempt = a.number)";
/// The same without the trainee's table, for a database in which that may be gone.
inline constexpr const char* kAlone =
    "a.number, a.uuid, '', a.exercise, a.title, a.mode, a.seed, a.input, a.started, a.ended, a.state, a.score, "
    "a.passed, a.seconds, a.ticks, a.recording, a.result, a.program_version, a.model_hash, 0";
inline constexpr const char* kFrom = " FROM attempt a JOIN trainee t ON t.id = a.trainee ";

Attempt row_of(const Query& q);
/// Nothing: the attempt has no row.
std::optional<AttemptState> state_in(Database& db, const std::string& uuid);
/// Without its trace. Nothing: it has no row.
std::optional<Attempt> row_in(Database& db, const std::string& uuid);
/// The row of `a.uuid`, new or as it is now; sets a.number.
void write_row(Database& db, Attempt& a);
/// Throws a DatabaseFault that is damage where tables or columns are missing.
void check_tables(Database& db);
/// Every transaction is on the disk when it returns, also if the power goes the moment after.
void make_durable(Database& db);

/// One program at a time opens, repairs and takes in. Without effect where the folder cannot be written.
class OpeningLock {
 public:
  explicit OpeningLock(const std::filesystem::path& folder);
  ~OpeningLock();
  OpeningLock(const OpeningLock&) = delete;
  OpeningLock& operator=(const OpeningLock&) = delete;

 private:
  int m_file;
};

/// What lies in a folder, by name. What cannot be listed is left out: a folder may vanish or fail while it is read.
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder);
/// Empty where there is no file or one of more than so many bytes.
std::string read_file(const std::filesystem::path& path, std::size_t most);

}  // namespace trocar::training
