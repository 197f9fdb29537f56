// The session store under everything that can go wrong with files: what ended is never lost, what did not end is said.
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <set>
#include <thread>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <trocar/core/error.hpp>
#include <trocar/core/log.hpp>
#include <trocar/sim/recording/recording.hpp>
#include <trocar/training/store/database.hpp>
#include <trocar/training/store/store.hpp>

#include "../other_process.hpp"

namespace trocar::training {
namespace {

namespace fs = std::filesystem;

constexpr const char* kResult = R"({"passed":true,"ticks":4200,"assessment":{"score":{"total":87.5}}})";

class StoreTest : public testing::Test {
 protected:
  void SetUp() override {
    core::log::set_level(core::log::Level::off);
    m_root = fs::temp_directory_path() / ("trocar_store_test_" + std::to_string(getpid()) + "_" +
                                          testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(m_root);
    fs::create_directories(m_root / "tmp");
    fs::permissions(m_root, fs::perms::all);
    fs::permissions(m_root / "tmp", fs::perms::all);
    setenv("TMPDIR", (m_root / "tmp").c_str(), 1);  // the last resort, too, is the test's own
  }
  void TearDown() override {
    unsetenv("TMPDIR");
    core::log::set_level(core::log::Level::info);
    fs::permissions(folder(), fs::perms::owner_all, m_ignored);
    fs::remove_all(m_root, m_ignored);
  }
  fs::path folder() const { return m_root / "data"; }
  fs::path database() const { return folder() / "sessions.sqlite"; }

  static Attempt attempt(const std::string& trainee = "ada") {
    Attempt a;
    a.trainee = trainee;
    a.exercise = "gynaecology/sterilisation";
    a.title = "Sterilisation";
    a.seed = 7;
    a.input = "mouse";
    a.started = "2026-03-01T10:00:00Z";
    a.program_version = "0.1.0";
    a.model_hash = 0xfedcba9876543210;
    return a;
  }
  static void finish(Attempt& a) {
    a.state = AttemptState::finished;
    a.ended = "2026-03-01T10:05:00Z";
    fill_from_result(kResult, a);
  }
  /// A whole attempt; where it went.
  static Kept make(Store& store, Attempt& a) {
    AttemptLock lock = store.begin(a);
    finish(a);
    return store.end(a, lock);
  }
  /// A recording of `ticks` ticks that says whose it is; with its end mark if there is a result.
  fs::path record(const Attempt& a, int ticks, const std::string& result = {}) const {
    fs::create_directories(folder() / "recordings");
    const fs::path path = folder() / "recordings" / (a.uuid + ".rec");
    sim::RecordingHeader header;
    header.exercise = a.exercise;
    header.seed = a.seed;
    header.metadata_json = "{\"uuid\":\"" + a.uuid + "\",\"number\":" + std::to_string(a.number) + ",\"trainee\":\"" +
                           a.trainee + "\",\"input\":\"mouse\",\"started\":\"" + a.started + "\"}";
    sim::RecordingWriter writer(path, header);
    for (int t = 0; t < ticks; ++t) writer.tick(std::uint64_t(t), sim::Input{});
    writer.flush();
    if (!result.empty()) writer.finish(result);
    return path;
  }
  static std::string bytes_of(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  fs::path m_root;
  std::error_code m_ignored;
};

TEST_F(StoreTest, WhatEndedIsThereWithAllItsFields) {
  Attempt a = attempt();
  a.trace = {1, 2, 3, 0, 255};
  a.recording = "/somewhere/a.rec";
  {
    Store store(folder());
    EXPECT_TRUE(store.notices().empty());
    EXPECT_TRUE(make(store, a).in_database);
  }
  const Store again(folder());
  const std::vector<Attempt> all = again.list();
  ASSERT_EQ(all.size(), 1u);
  const Attempt b = again.find(a.uuid.substr(0, 8)).value();
  EXPECT_EQ(b.trainee, "ada");
  EXPECT_EQ(b.exercise, a.exercise);
  EXPECT_EQ(b.title, a.title);
  EXPECT_EQ(b.mode, AttemptMode::assessed);
  EXPECT_EQ(b.state, AttemptState::finished);
  EXPECT_EQ(b.seed, 7u);
  EXPECT_EQ(b.score, 87.5);
  EXPECT_EQ(b.passed, true);
  EXPECT_EQ(b.ticks, 4200u);
  EXPECT_DOUBLE_EQ(b.seconds, 4.2);
  EXPECT_EQ(b.started, a.started);
  EXPECT_EQ(b.ended, a.ended);
  EXPECT_EQ(b.recording, a.recording);
  EXPECT_EQ(b.result, kResult);
  EXPECT_EQ(b.model_hash, a.model_hash);
  EXPECT_EQ(b.trace, a.trace);
  EXPECT_EQ(again.find("1")->uuid, a.uuid);
}

TEST_F(StoreTest, OrderIsByNumberAlsoWhenTheClockGoesBack) {
  Store store(folder());
  for (const char* clock : {"2026-03-01T10:00:00Z", "2031-01-01T00:00:00Z", "1999-12-31T23:59:59Z"}) {
    Attempt a = attempt();
    a.started = clock;
    make(store, a);
  }
  const std::vector<Attempt> all = store.list();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[1].started.substr(0, 4), "2031");
  EXPECT_EQ(all[2].started.substr(0, 4), "1999");
  EXPECT_LT(all[0].number, all[1].number);
  EXPECT_LT(all[1].number, all[2].number);
}

TEST_F(StoreTest, ANumberIsNeverUsedTwice) {
  Store store(folder());
  Attempt a = attempt("ada"), b = attempt("bob");
  make(store, a);
  make(store, b);
  store.forget("bob");
  Attempt c = attempt("cem");
  make(store, c);
  EXPECT_GT(c.number, b.number);
}

TEST_F(StoreTest, FamiliarisationHasNoScoreAndNoVerdict) {
  Store store(folder());
  Attempt a = attempt();
  a.mode = AttemptMode::familiarisation;
  make(store, a);
  const Attempt b = store.list().front();
  EXPECT_EQ(b.mode, AttemptMode::familiarisation);
  EXPECT_FALSE(b.score || b.passed);
  EXPECT_TRUE(store.list({.mode = AttemptMode::assessed}).empty());
}

TEST_F(StoreTest, WhatRunsInALivingProgramIsRunningForOthers) {
  Store store(folder());
  Attempt a = attempt();
  const AttemptLock lock = store.begin(a);
  ASSERT_TRUE(lock.held());
  const Store other(folder());
  EXPECT_TRUE(other.notices().empty());
  EXPECT_EQ(other.list().front().state, AttemptState::running);
}

TEST_F(StoreTest, WhatRanInADeadProgramWasInterruptedAndItsRecordingSaysHowFarItCame) {
  const int status = test::elsewhere([&] {
    Store store(folder());
    Attempt a = attempt();
    const AttemptLock lock = store.begin(a);
    a.recording = record(a, 2345).string();
    store.update(a);
    kill(getpid(), SIGKILL);
    return 0;
  });
  EXPECT_EQ(status, -1);
  const Store store(folder());
  ASSERT_EQ(store.notices().size(), 1u);
  EXPECT_NE(store.notices()[0].find("interrupted"), std::string::npos);
  const Attempt a = store.list().front();
  EXPECT_EQ(a.state, AttemptState::interrupted);
  EXPECT_EQ(a.ticks, 2345u);
  EXPECT_EQ(a.trainee, "ada");
  EXPECT_TRUE(fs::is_empty(folder() / "locks"));
  EXPECT_TRUE(Store(folder()).notices().empty()) << "told once";
}

TEST_F(StoreTest, KilledBetweenRecordingAndRowItHasEndedAllTheSame) {
  test::elsewhere([&] {
    Store store(folder());
    Attempt a = attempt();
    const AttemptLock lock = store.begin(a);
    a.recording = record(a, 300, kResult).string();
    store.update(a);
    kill(getpid(), SIGKILL);
    return 0;
  });
  const Store store(folder());
  const Attempt a = store.list().front();
  EXPECT_EQ(a.state, AttemptState::finished);
  EXPECT_EQ(a.score, 87.5);
  EXPECT_TRUE(is_unverified(a)) << "only its recording says so";
}

TEST_F(StoreTest, AnothersRecordingUnderTheSameNameIsNotTaken) {
  Attempt a = attempt(), b = attempt("bob");
  {
    Store store(folder());
    { const AttemptLock lock = store.begin(a); }
    b.uuid = new_uuid();
    a.recording = record(b, 100, kResult).string();
    store.update(a);
  }
  const Store store(folder());
  EXPECT_EQ(store.find(a.uuid)->state, AttemptState::interrupted);
  EXPECT_FALSE(store.find(a.uuid)->score.has_value());
}

constexpr int kShort = 200;  // [ms] of patience, where another's lock does not go away

TEST_F(StoreTest, ALockedDatabaseCostsNothing) {
  Store store(folder(), kShort);
  Attempt a = attempt();
  AttemptLock lock = store.begin(a);
  a.trace = {9, 8, 7};
  Kept kept;
  {
    Database other(database(), Database::Access::write);
    const Transaction all(other);
    finish(a);
    kept = store.end(a, lock);
  }
  EXPECT_FALSE(kept.in_database);
  EXPECT_TRUE(fs::exists(kept.file));
  EXPECT_FALSE(store.notices().empty());
  const Store again(folder());
  EXPECT_EQ(again.find(a.uuid)->state, AttemptState::finished);
  EXPECT_EQ(again.find(a.uuid)->score, 87.5);
  EXPECT_EQ(again.find(a.uuid)->trace, a.trace);
  EXPECT_FALSE(fs::exists(kept.file)) << "taken in";
}

TEST_F(StoreTest, AnotherThatWritesForAMomentIsWaitedFor) {
  Store store(folder());
  Attempt a = attempt();
  AttemptLock lock = store.begin(a);
  finish(a);
  Kept kept;
  {
    Database other(database(), Database::Access::write);
    auto all = std::make_unique<Transaction>(other);
    std::thread snapshot([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
      all.reset();
    });
    kept = store.end(a, lock);
    snapshot.join();
  }
  EXPECT_TRUE(kept.in_database);
  EXPECT_TRUE(store.notices().empty());
}

TEST_F(StoreTest, AReadOnlyFolderCostsNothingAndCanBeRead) {
  Attempt old = attempt();
  {
    Store store(folder());
    make(store, old);
  }
  fs::permissions(folder(), fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read |
                                fs::perms::others_exec | fs::perms::group_read | fs::perms::group_exec);
  fs::permissions(database(), fs::perms::others_read | fs::perms::owner_read);
  fs::permissions(folder() / "locks", fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_exec);
  const int failed = test::elsewhere([&] {
    if (!test::become_nobody()) return 77;
    Store store(folder());
    if (store.list().size() != 1 || store.list()[0].score != 87.5) return 1;
    Attempt a = attempt("nobody");
    AttemptLock lock = store.begin(a);
    finish(a);
    const Kept kept = store.end(a, lock);
    if (kept.in_database || kept.file.empty() || store.notices().empty()) return 2;
    if (kept.file.string().rfind(getenv("TMPDIR"), 0) != 0) return 3;
    const std::optional<Attempt> there = attempt_from_json(bytes_of(kept.file));
    return there && there->score == 87.5 && there->trainee == "nobody" ? 0 : 4;
  });
  fs::permissions(folder(), fs::perms::owner_all);
  if (failed == 77) GTEST_SKIP() << "cannot give up root's rights here";
  EXPECT_EQ(failed, 0);
}

TEST_F(StoreTest, WithoutARowTheResultIsPutWhereTheNextOpeningLooksNotBesideTheRecording) {
  fs::create_directories(folder());
  fs::permissions(folder(),
                  fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read | fs::perms::others_exec);
  const fs::path aside = folder().parent_path() / "aside";
  fs::create_directories(aside);
  fs::permissions(aside, fs::perms::all);
  const int failed = test::elsewhere([&] {
    if (!test::become_nobody()) return 77;
    Attempt a = attempt("nobody");
    {
      Store store(folder());
      AttemptLock lock = store.begin(a);
      if (a.number != 0) return 1;
      a.recording = (aside / "x.rec").string();
      finish(a);
      a.trace = {5, 6, 7};
      if (const Kept kept = store.end(a, lock); !kept.anywhere() || kept.in_database) return 2;
    }
    if (!fs::is_empty(aside)) return 3;
    fs::rename(folder(), folder().parent_path() / "read-only");  // the same name, and now it can be written
    const std::optional<Attempt> taken_in = Store(folder()).find(a.uuid);
    return taken_in && taken_in->score == 87.5 && taken_in->trace == a.trace ? 0 : 4;
  });
  fs::permissions(folder(), fs::perms::owner_all);
  if (failed == 77) GTEST_SKIP() << "cannot give up root's rights here";
  EXPECT_EQ(failed, 0) << "3: it lies beside the recording, where nobody looks; 4: it was not taken in";
}

TEST_F(StoreTest, AFullDiskCostsNothing) {
  Attempt a = attempt();
  const int failed = test::elsewhere([&] {
    Store store(folder());
    for (int i = 0; i < 40; ++i) {
      Attempt earlier = attempt();
      make(store, earlier);
    }
    AttemptLock lock = store.begin(a);
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{16384, 16384};  // no file may grow beyond: the database is larger, a result is not
    setrlimit(RLIMIT_FSIZE, &small);
    finish(a);
    const Kept kept = store.end(a, lock);
    if (kept.in_database) return 1;
    return kept.file.empty() ? 2 : store.notices().empty() ? 3 : 0;
  });
  EXPECT_EQ(failed, 0);
  const Store store(folder());
  EXPECT_EQ(store.list().size(), 41u);
  const Attempt last = store.list().back();
  EXPECT_EQ(last.state, AttemptState::finished);
  EXPECT_EQ(last.score, 87.5);
}

TEST_F(StoreTest, ADamagedDatabaseIsSetAsideAndBuiltAnewFromTheRecordings) {
  Attempt a = attempt(), b = attempt("bob");
  {
    Store store(folder());
    make(store, a);
    make(store, b);
    record(a, 100, kResult);
    record(b, 200);
  }
  std::ofstream(database(), std::ios::binary) << std::string(20000, 'x');
  Store store(folder());
  ASSERT_FALSE(store.notices().empty());
  EXPECT_NE(store.notices()[0].find("damaged"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder() / "sessions.sqlite.damaged-1"));
  const std::vector<Attempt> all = store.list();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].uuid, a.uuid);
  EXPECT_EQ(all[0].number, a.number);
  EXPECT_EQ(all[0].state, AttemptState::finished);
  EXPECT_EQ(all[0].score, 87.5);
  EXPECT_EQ(all[1].trainee, "bob");
  EXPECT_EQ(all[1].state, AttemptState::interrupted);
  Attempt c = attempt("cem");
  EXPECT_TRUE(make(store, c).in_database);
  EXPECT_GT(c.number, b.number);
}

TEST_F(StoreTest, RowsThatCanStillBeReadAreSavedFromADamagedDatabase) {
  constexpr int kRows = 60;
  {
    Store store(folder());
    for (int i = 0; i < kRows; ++i) {
      Attempt a = attempt("trainee " + std::to_string(i));
      make(store, a);
    }
  }
  const auto size = fs::file_size(database());
  std::fstream file(database(), std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(std::streamoff(size / 2 / 4096 * 4096));
  file << std::string(4096, '\xa5');
  file.close();
  const Store store(folder());
  EXPECT_FALSE(store.notices().empty());
  EXPECT_GT(store.list().size(), std::size_t(kRows / 4)) << "of " << kRows;
  EXPECT_TRUE(fs::exists(folder() / "sessions.sqlite.damaged-1"));
}

TEST_F(StoreTest, DamageDuringAnAttemptDoesNotCostIt) {
  Store store(folder());
  Attempt a = attempt();
  AttemptLock lock = store.begin(a);
  std::ofstream(database(), std::ios::binary) << std::string(20000, 'y');
  finish(a);
  EXPECT_TRUE(store.end(a, lock).in_database);
  EXPECT_EQ(Store(folder()).find(a.uuid)->score, 87.5);
}

TEST_F(StoreTest, ADeletedDatabaseIsBuiltAnewFromTheRecordings) {
  Attempt a = attempt();
  {
    Store store(folder());
    make(store, a);
    record(a, 100, kResult);
  }
  fs::remove(database());
  const Store store(folder());
  EXPECT_EQ(store.list().front().score, 87.5);
}

TEST_F(StoreTest, ANewerVersionOfTheTablesIsNotTouched) {
  {
    const Store store(folder());
    Database db(database(), Database::Access::write);
    db.run("PRAGMA user_version = 99");
  }
  const std::string before = bytes_of(database());
  Store store(folder());
  EXPECT_FALSE(store.writable());
  Attempt a = attempt();
  const Kept kept = make(store, a);
  EXPECT_FALSE(kept.in_database);
  EXPECT_TRUE(fs::exists(kept.file));
  EXPECT_FALSE(fs::exists(folder() / "sessions.sqlite.damaged-1"));
  EXPECT_EQ(Database(database(), Database::Access::read).number_of("PRAGMA user_version"), 99);
}

TEST_F(StoreTest, ProgramsShareAStore) {
  constexpr int kPrograms = 4, kAttempts = 15;
  std::vector<pid_t> children;
  for (int p = 0; p < kPrograms; ++p) {
    children.push_back(fork());
    if (children.back() != 0) continue;
    int bad = 0;
    for (int i = 0; i < kAttempts; ++i) {
      Store store(folder());
      Attempt a = attempt("program " + std::to_string(p));
      const bool kept = make(store, a).in_database;
      for (const std::string& notice : store.notices()) std::cerr << "program " << p << ": " << notice << '\n';
      bad += !kept || !store.notices().empty();
    }
    _exit(bad);
  }
  for (const pid_t child : children) {
    int status = -1;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  }
  std::set<std::int64_t> numbers;
  for (const Attempt& a : Store(folder()).list()) {
    EXPECT_EQ(a.state, AttemptState::finished);
    numbers.insert(a.number);
  }
  EXPECT_EQ(numbers.size(), std::size_t(kPrograms * kAttempts));
}

TEST_F(StoreTest, WhatIsForgottenIsNowhereInTheFiles) {
  Attempt a = attempt("Zebedäus"), b = attempt("bob");
  {
    Store store(folder());
    make(store, a);
    make(store, b);
  }
  a.recording = record(a, 100, kResult).string();
  const fs::path elsewhere = folder().parent_path() / "elsewhere.rec";
  {
    Store store(folder());
    store.update(a);
    Attempt c = attempt("Zebedäus");
    std::ofstream(elsewhere) << "x";
    c.recording = elsewhere.string();
    make(store, c);
    const Store::Forgotten gone = store.forget("Zebedäus");
    EXPECT_EQ(gone.attempts, 2);
    ASSERT_EQ(gone.deleted.size(), 1u);
    ASSERT_EQ(gone.left.size(), 1u);
    EXPECT_EQ(gone.left[0], elsewhere);
  }
  for (const fs::directory_entry& file : fs::recursive_directory_iterator(folder()))
    if (file.is_regular_file()) {
      EXPECT_EQ(bytes_of(file.path()).find("Zebedäus"), std::string::npos) << file.path();
    }
  const std::vector<Attempt> left = Store(folder()).list();
  ASSERT_EQ(left.size(), 1u);
  EXPECT_EQ(left[0].trainee, "bob");
}

TEST_F(StoreTest, WhatAnotherProgramStillReadsIsForgottenAllTheSameAndSaidToBeInTheFile) {
  Attempt a = attempt();
  Store store(folder(), kShort);
  make(store, a);
  a.recording = record(a, 10, kResult).string();
  store.update(a);
  {
    Database other(database(), Database::Access::read);
    Query reading(other, "SELECT uuid FROM attempt");
    ASSERT_TRUE(reading.next());
    const Store::Forgotten gone = store.forget("ada");
    EXPECT_FALSE(gone.not_overwritten.empty());
    EXPECT_EQ(gone.attempts, 1);
    EXPECT_EQ(gone.deleted.size(), 1u) << "recordings go, whatever becomes of the database file";
  }
  EXPECT_TRUE(store.list().empty());
  EXPECT_TRUE(store.forget("ada").not_overwritten.empty()) << "done again when nobody reads it";
}

TEST_F(StoreTest, NamesAreTextAndNothingElse) {
  Store store(folder());
  Attempt a = attempt("Robert'); DROP TABLE attempt;--");
  make(store, a);
  EXPECT_EQ(store.list({.trainee = a.trainee}).size(), 1u);
  EXPECT_TRUE(store.list({.trainee = "' OR 1=1 --"}).empty());
  EXPECT_FALSE(store.find("%").has_value());
  EXPECT_FALSE(store.find("").has_value());
  EXPECT_EQ(clean_name("  Ada\n\tL\x01  "), "Ada L");
  EXPECT_EQ(clean_name("\xff\xfe"
                       "a\xc3"),
            "a");
  EXPECT_EQ(clean_name(std::string(300, 'a')).size(), 100u);
  EXPECT_EQ(clean_name("日本"), "日本");
}

TEST_F(StoreTest, FilesThatAreNoResultsAreLeftAlone) {
  fs::create_directories(folder() / "waiting");
  for (const auto& [name, text] : {std::pair("a.attempt.json", "{"),
                                   {"b.attempt.json", "[1,2]"},
                                   {"c.attempt.json", R"({"trocar_attempt":1})"},
                                   {"d.attempt.json", R"({"trocar_attempt":1,"uuid":7,"seed":-1})"},
                                   {"e.txt", "x"}})
    std::ofstream(folder() / "waiting" / name) << text;
  const Store store(folder());
  EXPECT_TRUE(store.list().empty());
  EXPECT_TRUE(fs::exists(folder() / "waiting" / "a.attempt.json"));
}

TEST_F(StoreTest, AResultOfAnyDepthIsNoHarm) {
  constexpr std::size_t kDeep = 2'000'000;
  fs::create_directories(folder() / "waiting");
  std::ofstream(folder() / "waiting" / "deep.attempt.json")
      << R"({"trocar_attempt":1,"uuid":"0123456789abcdef","result":{"passed":true,"x":)" << std::string(kDeep, '[')
      << std::string(kDeep, ']') << "}}";
  const Store store(folder());
  ASSERT_EQ(store.list().size(), 1u);
  EXPECT_NE(store.list()[0].result.find("\"passed\":true"), std::string::npos);
}

TEST_F(StoreTest, StrangeResultsAndNumbersAreNoHarm) {
  Store store(folder());
  for (const char* result :
       {"", "[]", "{\"assessment\":[]}", "{\"assessment\":{\"score\":7}}", "{\"ticks\":-1,\"passed\":3}"}) {
    Attempt a = attempt();
    AttemptLock lock = store.begin(a);
    a.state = AttemptState::finished;
    fill_from_result(result, a);
    EXPECT_FALSE(a.score || a.passed) << result;
    EXPECT_TRUE(store.end(a, lock).in_database);
  }
  Attempt huge = attempt();
  huge.uuid = new_uuid();
  huge.number = std::numeric_limits<std::int64_t>::max();
  fs::create_directories(folder() / "waiting");
  std::ofstream(folder() / "waiting" / (huge.uuid + ".attempt.json")) << to_json(huge);
  EXPECT_EQ(Store(folder()).find(huge.uuid)->number, 6) << "nobody uses up the numbers";
}

TEST_F(StoreTest, AUuidIsNeverAPath) {
  fs::create_directories(folder() / "waiting");
  const fs::path precious = folder() / "precious";
  std::ofstream(precious) << "mine";
  for (const std::string& uuid : {precious.string(), std::string("../precious"), std::string("A b"), std::string()}) {
    EXPECT_FALSE(is_uuid(uuid)) << uuid;
    Attempt a = attempt();
    a.uuid = uuid;
    a.state = AttemptState::running;
    std::ofstream(folder() / "waiting" / "x.attempt.json") << to_json(a);
    EXPECT_TRUE(Store(folder()).list().empty()) << uuid;
    EXPECT_TRUE(fs::exists(precious)) << uuid;
  }
  EXPECT_TRUE(is_uuid(new_uuid()));
}

TEST_F(StoreTest, AUuidIsNeverTakenForANumberNorForAnothersBeginning) {
  for (const char* text : {"1", "12", "abc", "0123456789abcde"}) EXPECT_FALSE(is_uuid(text)) << text;
  Attempt claims = attempt();
  claims.uuid = "1";
  Attempt there;
  ASSERT_TRUE(fill_from_recording(record(claims, 5), there));
  EXPECT_EQ(there.uuid.rfind("recording-", 0), 0u) << there.uuid;
  Attempt brief = attempt("brief"), lengthy = attempt("lengthy");
  brief.uuid = "0123456789abcdef";
  lengthy.uuid = brief.uuid + "-and-more";
  Store store(folder());
  make(store, brief);
  make(store, lengthy);
  ASSERT_TRUE(store.find(brief.uuid).has_value()) << "it is a whole uuid and the beginning of another one";
  EXPECT_EQ(store.find(brief.uuid)->trainee, "brief");
  EXPECT_FALSE(store.find("01234567-").has_value());
}

TEST_F(StoreTest, DigitsNameANumberAndEightOfThemTheBeginningOfAUuid) {
  Attempt digits = attempt("digits"), second = attempt("second");
  digits.uuid = "20345678-0000-4000-8000-000000000000";
  second.uuid = "abcdef01-0000-4000-8000-000000000000";
  Store store(folder());
  make(store, digits);
  make(store, second);
  ASSERT_TRUE(store.find("20345678").has_value());
  EXPECT_EQ(store.find("20345678")->trainee, "digits");
  EXPECT_EQ(store.find("2")->trainee, "second");
  EXPECT_FALSE(store.find("20").has_value());
}

TEST_F(StoreTest, TheFolderBelongsToItsUserAlone) {
  const mode_t before = umask(022);
  Store(folder()).list();
  umask(before);
  EXPECT_EQ(fs::status(folder()).permissions(), fs::perms::owner_all);
}

TEST_F(StoreTest, LocksThatNobodyHoldsAreSweptAway) {
  Store(folder()).list();
  Attempt living = attempt();
  Store store(folder());
  AttemptLock lock = store.begin(living);
  const fs::path left = folder() / "locks" / new_uuid();  // killed before its row was written
  std::ofstream(left) << "x";
  Store(folder()).list();
  EXPECT_FALSE(fs::exists(left));
  EXPECT_TRUE(AttemptLock::is_held(folder(), living.uuid));
  EXPECT_EQ(Store(folder()).find(living.uuid)->state, AttemptState::running);
}

TEST_F(StoreTest, AnAttemptThatNeverBeganLeavesNothing) {
  Store store(folder());
  Attempt a = attempt();
  AttemptLock lock = store.begin(a);
  store.withdraw(a, lock);
  EXPECT_FALSE(lock.held());
  EXPECT_TRUE(Store(folder()).list().empty());
}

TEST_F(StoreTest, AResultOfAnotherStoreWaitsForItsOwn) {
  Attempt a = attempt();
  a.uuid = new_uuid();
  a.store = (folder().parent_path() / "another").string();
  fs::create_directories(a.store);
  const fs::path file = own_temporary_folder() / (a.uuid + ".attempt.json");
  std::ofstream(file) << to_json(a);
  {
    const Store store(folder());
    EXPECT_TRUE(store.list().empty());
    EXPECT_TRUE(store.notices().empty());
  }
  fs::remove(a.store);
  const Store store(folder());
  EXPECT_TRUE(store.list().empty());
  ASSERT_EQ(store.notices().size(), 1u) << "its store is gone";
  EXPECT_NE(store.notices()[0].find("move it to"), std::string::npos);
  EXPECT_TRUE(fs::exists(file));
}

/// A store whose database takes nothing, so that a result waits in its folder.
class WaitingResult : public StoreTest {
 protected:
  void SetUp() override {
    StoreTest::SetUp();
    Store store(folder());
    m_attempt = attempt();
    AttemptLock lock = store.begin(m_attempt);
    {
      Database db(database(), Database::Access::write);
      db.run("PRAGMA user_version = 99");
    }
    finish(m_attempt);
    m_attempt.trace = {1, 2, 3};
    ASSERT_EQ(store.end(m_attempt, lock).file.parent_path(), folder() / "waiting");
    Database db(database(), Database::Access::write);
    db.run("PRAGMA user_version = 1");
  }
  void expect_taken_in(const fs::path& by) const {
    Store store(by);
    const std::optional<Attempt> a = store.find(m_attempt.uuid);
    ASSERT_TRUE(a.has_value()) << by;
    EXPECT_EQ(a->state, AttemptState::finished) << by;
    EXPECT_EQ(a->score, 87.5) << by;
    EXPECT_EQ(a->trace.size(), 3u) << by;
  }
  Attempt m_attempt;
};

TEST_F(WaitingResult, IsTakenInUnderAnotherSpellingOfTheFolder) { expect_taken_in(folder() / ""); }

TEST_F(WaitingResult, IsTakenInThroughALink) {
  const fs::path link = folder().parent_path() / "link";
  fs::create_directory_symlink(folder(), link);
  expect_taken_in(link);
}

TEST_F(WaitingResult, IsTakenInWhereTheFolderWasMoved) {
  const fs::path moved = folder().parent_path() / "moved";
  fs::rename(folder(), moved);
  expect_taken_in(moved);
}

TEST_F(StoreTest, AFileNeverRewritesAnAttemptThatHasEnded) {
  Attempt a = attempt();
  {
    Store store(folder());
    a.trace = {1, 2, 3};
    make(store, a);
  }
  Attempt forged = a;
  forged.trainee = "eve";
  forged.score = 100;
  forged.trace.clear();
  fs::create_directories(folder() / "waiting");
  const std::string file = (folder() / "waiting" / (a.uuid + ".attempt.json")).string();
  std::ofstream(file) << to_json(forged);
  Store store(folder());
  ASSERT_EQ(store.notices().size(), 1u);
  EXPECT_NE(store.notices()[0].find("has ended already"), std::string::npos) << store.notices()[0];
  EXPECT_TRUE(fs::exists(file + ".refused"));
  EXPECT_FALSE(fs::exists(file));
  const Attempt kept = store.find(a.uuid).value();
  EXPECT_EQ(kept.trainee, "ada");
  EXPECT_EQ(kept.score, 87.5);
  EXPECT_EQ(kept.trace.size(), 3u);
  EXPECT_TRUE(Store(folder()).notices().empty()) << "told once";
}

TEST_F(StoreTest, AFileThatWasTakenInAlreadyIsRemovedWithoutAWord) {
  Attempt a = attempt();
  {
    Store store(folder());
    make(store, a);
  }
  fs::create_directories(folder() / "waiting");
  const fs::path file = folder() / "waiting" / (a.uuid + ".attempt.json");
  std::ofstream(file) << to_json(a);
  const Store store(folder());
  EXPECT_TRUE(store.notices().empty());
  EXPECT_FALSE(fs::exists(file));
}

TEST_F(StoreTest, AFileNeverChangesWhoseAnInterruptedAttemptIs) {
  Attempt a = attempt();
  {
    Store store(folder());
    const AttemptLock lock = store.begin(a);
  }
  EXPECT_EQ(Store(folder()).find(a.uuid)->state, AttemptState::interrupted);
  Attempt other = a;
  other.trainee = "eve";
  finish(other);
  fs::create_directories(folder() / "waiting");
  const fs::path file = folder() / "waiting" / (a.uuid + ".attempt.json");
  std::ofstream(file) << to_json(other);
  EXPECT_EQ(Store(folder()).find(a.uuid)->trainee, "ada");
  other.trainee = "ada";
  std::ofstream(file) << to_json(other);
  EXPECT_EQ(Store(folder()).find(a.uuid)->score, 87.5) << "it may be completed";
}

TEST_F(StoreTest, ScoresFromRecordingsAreMarkedAsNotVerified) {
  Attempt a = attempt(), b = attempt("bob");
  {
    Store store(folder());
    make(store, a);
    record(a, 100, R"({"from_recording":false,"passed":true})");
    make(store, b);
  }
  EXPECT_FALSE(is_unverified(Store(folder()).find(a.uuid).value()));
  fs::remove(database());
  EXPECT_TRUE(is_unverified(Store(folder()).find(a.uuid).value()));
}

/// A store of some attempts, and what is done to its file.
class DamagedStore : public StoreTest {
 protected:
  static constexpr int kRows = 12;
  void SetUp() override {
    StoreTest::SetUp();
    Store store(folder());
    for (int i = 0; i < kRows; ++i) {
      Attempt a = attempt("trainee " + std::to_string(i));
      make(store, a);
    }
  }
  void write_at(std::streamoff at, const std::string& bytes) const {
    std::fstream file(database(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(at);
    file << bytes;
  }
  void expect_saved(std::size_t at_least) const {
    Store store(folder());
    EXPECT_FALSE(store.notices().empty());
    EXPECT_GE(store.list().size(), at_least);
    EXPECT_TRUE(fs::exists(folder() / "sessions.sqlite.damaged-1"));
    EXPECT_FALSE(fs::exists(folder() / "sessions.sqlite.damaged-1.mended"));
    Attempt a = attempt();
    EXPECT_TRUE(make(store, a).in_database);
    EXPECT_TRUE(Store(folder()).notices().empty());
  }
};

TEST_F(DamagedStore, ThatLacksItsLastPageIsReadAllTheSame) {
  fs::resize_file(database(), fs::file_size(database()) - 4096);
  expect_saved(kRows / 2);
}

TEST_F(DamagedStore, WhoseHeaderIsGoneIsReadAllTheSame) {
  write_at(0, std::string(60, 'x'));
  expect_saved(kRows);
}

TEST_F(DamagedStore, OfVersion0IsReadAllTheSame) {
  Database(database(), Database::Access::write).run("PRAGMA user_version = 0");
  expect_saved(kRows);
}

TEST_F(DamagedStore, OfAVersionBelowAnyIsReadAllTheSame) {
  Database(database(), Database::Access::write).run("PRAGMA user_version = -3");
  expect_saved(kRows);
}

TEST_F(DamagedStore, WithoutItsTableIsBuiltAgain) {
  {
    Database db(database(), Database::Access::write);
    db.run("DROP TABLE attempt");
  }
  expect_saved(0);
}

TEST_F(StoreTest, AFolderThatCannotBeMadeIsTold) {
  std::ofstream(folder()) << "a file where the folder should be";
  Store store(folder());
  EXPECT_FALSE(store.writable());
  EXPECT_FALSE(store.notices().empty());
  Attempt a = attempt();
  const Kept kept = make(store, a);
  EXPECT_TRUE(kept.anywhere()) << "the temporary folder is left";
  EXPECT_TRUE(store.list().empty());
  fs::remove(folder());
}

}  // namespace
}  // namespace trocar::training
