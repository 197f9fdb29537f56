#include <atomic>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/log.hpp>
#include <trocar/core/parallel.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/core/random.hpp>

using namespace trocar::core;

namespace {

Fault fault(const std::string& file, int line, int column, const std::string& message) {
  Fault result;
  result.at.file = file;
  result.at.line = line;
  result.at.column = column;
  result.message = message;
  return result;
}

}  // namespace

TEST(Fault, IsPrintedAsPathLineColumnMessage) {
  EXPECT_EQ(to_string(fault("a.json", 12, 7, "expected > 0, got -3")), "a.json:12:7: expected > 0, got -3");
  EXPECT_EQ(to_string(fault("a.json", 12, 0, "m")), "a.json:12: m");
  EXPECT_EQ(to_string(fault("a.json", 0, 0, "m")), "a.json: m");
}

TEST(BadInput, TellsEveryFaultOneALine) {
  std::vector<Fault> faults;
  faults.push_back(fault("a", 1, 2, "x"));
  faults.push_back(fault("b", 3, 4, "y"));
  const BadInput error(faults);
  EXPECT_STREQ(error.what(), "a:1:2: x\nb:3:4: y");
  EXPECT_EQ(error.faults().size(), 2u);
}

TEST(Hash, MatchesThePublishedXxh3OfTheEmptyInput) { EXPECT_EQ(hash_bytes("", 0), 0x2d06800538d394c2ull); }

TEST(Hash, DependsOnEveryByteAndOnOrder) {
  std::vector<unsigned char> bytes(300, 7);
  const auto before = hash_bytes(bytes.data(), bytes.size());
  for (auto& byte : bytes) {
    byte ^= 1;
    EXPECT_NE(hash_bytes(bytes.data(), bytes.size()), before);
    byte ^= 1;
  }
  Hasher ab, ba;
  ab.add(1), ab.add(2);
  ba.add(2), ba.add(1);
  EXPECT_NE(ab.value(), ba.value());
}

TEST(Hasher, TellsWhereOneArrayEndsAndTheNextBegins) {
  Hasher a, b;
  a.add(std::vector<int>{1, 2}), a.add(std::vector<int>{3});
  b.add(std::vector<int>{1}), b.add(std::vector<int>{2, 3});
  EXPECT_NE(a.value(), b.value());
}

TEST(Random, GivesThePublishedSplitmixSequence) {
  Random random(1234567);
  EXPECT_EQ(random.next(), 6457827717110365317ull);
  EXPECT_EQ(random.next(), 3203168211198807973ull);
}

TEST(ThreadPool, RunsEveryItemExactlyOnceForAnyNumberOfThreads) {
  for (int threads = 1; threads <= 5; ++threads) {
    ThreadPool pool(threads);
    EXPECT_EQ(pool.threads(), threads);
    for (int count : {0, 1, 2, 3, 7, 100}) {
      std::vector<int> hits(count, 0);
      run(pool, count, [&](int i) noexcept { ++hits[i]; });
      EXPECT_EQ(hits, std::vector<int>(count, 1)) << threads << " threads";
    }
  }
}

TEST(ThreadPool, FinishesAllItemsBeforeRunReturns) {
  ThreadPool pool(3);
  std::vector<long> value(9, 0);
  for (long round = 1; round <= 20000; ++round) {
    run(pool, 9, [&](int i) noexcept { value[i] += i + 1; });
    ASSERT_EQ(value[8], 9 * round);
    ASSERT_EQ(value[1], 2 * round);
  }
}

TEST(ThreadPool, LateThreadsNeverTakeAnItemOfAnotherRun) {
  ThreadPool pool(4);
  for (int round = 0; round < 30000; ++round) {
    const int count = 2 + round % 3;
    std::vector<int> hits(std::size_t(count), 0);  // gone when the next run begins
    run(pool, count, [&](int i) noexcept { ++hits[std::size_t(i)]; });
    ASSERT_EQ(hits, std::vector<int>(std::size_t(count), 1)) << round;
  }
}

TEST(ThreadPool, WakesThreadsThatHaveGoneToSleep) {
  ThreadPool pool(2);
  for (int round = 0; round < 5; ++round) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::atomic<int> here{0};
    run(pool, 2, [&](int) noexcept {  // neither ends before both have begun
      ++here;
      while (here < 2) std::this_thread::yield();
    });
    EXPECT_EQ(here, 2);
  }
}

TEST(ThreadCount, ObeysTheEnvironmentAndIgnoresNonsenseInIt) {
  const char* old = std::getenv("TROCAR_THREADS");
  const std::string kept = old ? old : "";
  setenv("TROCAR_THREADS", "5", 1);
  EXPECT_EQ(default_thread_count(), 5);
  setenv("TROCAR_THREADS", "nonsense", 1);
  const int fallback = default_thread_count();
  EXPECT_GE(fallback, 1);
  setenv("TROCAR_THREADS", "0", 1);
  EXPECT_EQ(default_thread_count(), fallback);
  if (old)
    setenv("TROCAR_THREADS", kept.c_str(), 1);
  else
    unsetenv("TROCAR_THREADS");
}

TEST(Log, WritesToStandardErrorAtOrAboveTheLevel) {
  testing::internal::CaptureStderr();
  log::set_level(log::Level::warn);
  log::info("unseen {}", 1);
  log::warn("seen {}", 2);
  log::set_level(log::Level::info);
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_EQ(text.find("unseen"), std::string::npos);
  EXPECT_NE(text.find("warning: seen 2"), std::string::npos) << text;
}

TEST(Printable, NothingThatATerminalWouldObeyIsLeft) {
  EXPECT_EQ(printable(std::string_view("a\0b\x1b[31m\n\x7f", 10)), "a\\u0000b\\u001b[31m\\u000a\\u007f");
  EXPECT_EQ(printable("\xc2\x9b"
                      "2J \xe2\x80\xae \xe2\x81\xa6"),
            "\\u009b2J \\u202e \\u2066");
  EXPECT_EQ(printable("\xc3\xa4 \xe2\x82\xac \xe2\x80\x94 \xf0\x9f\x98\x80"),
            "\xc3\xa4 \xe2\x82\xac \xe2\x80\x94 \xf0\x9f\x98\x80");
}

TEST(BadInput, AFaultWithControlCharactersNeitherEndsTheTextNorReachesTheTerminal) {
  const BadInput bad(
      {{{"a\x1b.json", 1, 2}, std::string("expected a name, got \"x\0y\"", 26)}, {{"b.json", 3, 4}, "second"}});
  EXPECT_STREQ(bad.what(), "a\\u001b.json:1:2: expected a name, got \"x\\u0000y\"\nb.json:3:4: second");
}
