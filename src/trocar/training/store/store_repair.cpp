// A damaged database is set aside and built again from what is still readable and from the recordings.
#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include <trocar/core/files.hpp>
#include <trocar/core/text.hpp>
#include <trocar/training/store/store_parts.hpp>

namespace trocar::training {

namespace fs = std::filesystem;

namespace {

constexpr int kMostLost = 20'000;                   ///< numbers that are tried one by one where pages are gone
constexpr std::size_t kLargestMended = 1 << 30;     ///< [bytes]
constexpr std::size_t kPage = 4096, kHeader = 100;  ///< [bytes] as SQLite makes them for the store

/// A copy whose first hundred bytes say what those of every store say; empty where it cannot be made.
/// [https://www.sqlite.org/fileformat.html#the_database_header]
fs::path with_sound_header(const fs::path& damaged) {
  std::string bytes = read_file(damaged, kLargestMended);
  if (bytes.size() < kPage) return {};
  const std::string_view magic("SQLite format 3\0", 16);
  const std::string_view sizes("\x10\x00\x01\x01\x00\x40\x20\x20", 8);  // of a page; no WAL; shares of a page
  std::string header =
      std::string(magic) + std::string(sizes) + std::string(kHeader - magic.size() - sizes.size(), '\0');
  const auto put = [&header](std::size_t at, std::size_t number) {
    for (std::size_t i = 0; i < 4; ++i) header[at + i] = char(number >> (8 * (3 - i)) & 0xff);
  };
  put(28, bytes.size() / kPage);
  put(44, 4);  // of the schema
  put(56, 1);  // UTF-8
  std::copy(header.begin(), header.end(), bytes.begin());
  const fs::path mended = damaged.string() + ".mended";
  return core::write_file(mended, bytes.data(), bytes.size(), 0600).empty() ? mended : fs::path();
}

}  // namespace

void Store::repair(const std::string& what) {
  fs::path aside;
  std::error_code error;
  for (int n = 1; aside.empty() || fs::exists(aside, error); ++n)
    aside = m_folder / fmt::format("sessions.sqlite.damaged-{}", n);
  fs::rename(database(), aside, error);
  if (error) {
    notice(tr("{} is damaged ({}) and cannot be renamed: {}", database().string(), what, error.message()));
    return;
  }
  for (const char* tail : {"-wal", "-shm"}) fs::rename(database().string() + tail, aside.string() + tail, error);
  notice(tr("the session store was damaged ({}): it is kept as {}, and a new store is built", what, aside.string()));
  try {
    Database db(database(), Database::Access::write, m_patience);
    make_durable(db);
    migrate(db);
    int saved = salvage(db, aside);
    if (const fs::path mended = saved == 0 ? with_sound_header(aside) : fs::path(); !mended.empty()) {
      saved = salvage(db, mended);
      fs::remove(mended, error);
    }
    if (saved > 0) notice(tr("{} attempts were read from the damaged store", saved));
    take_in_recordings(db);
  } catch (const DatabaseFault& fault) {
    notice(tr("a new session store could not be built: {}", fault.what()));
  }
}

/// Row by row, since a page that is gone takes only its own rows along.
int Store::salvage(Database& db, const fs::path& damaged) {
  const auto readable = [](const auto& read) {
    try {
      read();
      return true;
    } catch (const DatabaseFault&) {
      return false;
    }
  };
  int saved = 0;
  readable([&] {
    Database old(damaged, Database::Access::salvage);
    const Query there(old, "SELECT number FROM attempt NOT INDEXED LIMIT 0");  // else no number is worth a try
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
  return saved;
}

}  // namespace trocar::training
