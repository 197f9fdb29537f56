#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include <trocar/devices/mailbox.hpp>

using trocar::devices::Mailbox;

namespace {

struct Sample {
  std::uint64_t words[16];  // all equal: a torn sample would show
};

Sample sample(std::uint64_t number) {
  Sample result;
  for (auto& word : result.words) word = number;
  return result;
}

}  // namespace

TEST(Mailbox, IsEmptyAtFirst) {
  Mailbox<int> box;
  int value = 7;
  EXPECT_FALSE(box.take(value));
  EXPECT_EQ(value, 7);
}

TEST(Mailbox, GivesTheNewestValueOnce) {
  Mailbox<int> box;
  int value = 0;
  for (int round = 0; round < 10; ++round) {
    for (int i = 0; i <= round; ++i) box.put(100 * round + i);
    EXPECT_TRUE(box.take(value));
    EXPECT_EQ(value, 100 * round + round);
    EXPECT_FALSE(box.take(value));
    EXPECT_EQ(value, 100 * round + round);
  }
}

TEST(Mailbox, NeverTearsNeverGoesBackAndTheLastValueArrives) {
  constexpr int kTaken = 20'000;
  Mailbox<Sample> box;
  std::atomic<bool> enough{false};
  std::uint64_t last = 0;
  std::thread device([&] {
    while (!enough) box.put(sample(++last));
  });
  std::uint64_t newest = 0, torn = 0, backwards = 0;
  const auto look = [&] {
    Sample now = sample(0);
    if (!box.take(now)) return false;
    for (const auto word : now.words) torn += word != now.words[0];
    backwards += now.words[0] <= newest;
    newest = now.words[0];
    return true;
  };
  for (int taken = 0; taken < kTaken;)
    if (look())
      ++taken;
    else
      std::this_thread::yield();
  enough = true;
  device.join();
  look();
  EXPECT_EQ(newest, last);
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(backwards, 0u);
}
