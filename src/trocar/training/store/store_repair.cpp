// A damaged database is set aside and built again from what is still readable and from the recordings.
#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/training/store/store_parts.hpp>

namespace trocar::training {

namespace fs = std::filesystem;

namespace {

constexpr int kMostLost = 20'000;  ///< numbers that are tried one by one where pages are gone

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
    salvage(db, aside);
    take_in_recordings(db);
  } catch (const DatabaseFault& fault) {
    notice(tr("a new session store could not be built: {}", fault.what()));
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
  if (opened && saved > 0) notice(tr("{} attempts were read from the damaged store", saved));
}

}  // namespace trocar::training
