#include <thread>

#include <gtest/gtest.h>

#include <trocar/core/triple_buffer.hpp>

namespace trocar::core {
namespace {

struct Pair {
  std::vector<std::uint64_t> a = std::vector<std::uint64_t>(64), b = a;
};

TEST(TripleBuffer, TheReaderNeverSeesAHalfWrittenValueNorAnOlderOneAfterANewer) {
  constexpr std::uint64_t kLast = 20000;
  TripleBuffer<Pair> published{Pair{}};
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kLast; ++i) {
      Pair& p = published.next();
      p.a.assign(p.a.size(), i);
      p.b.assign(p.b.size(), i);
      published.publish();
    }
  });
  std::uint64_t last = 0;
  bool whole = true, rising = true;
  while (last < kLast) {
    if (!published.refresh()) continue;
    const Pair& p = published.latest();
    for (std::size_t i = 0; i < p.a.size(); ++i) whole = whole && p.a[i] == p.a[0] && p.b[i] == p.a[0];
    rising = rising && p.a[0] > last;
    last = p.a[0];
  }
  writer.join();
  EXPECT_TRUE(whole);
  EXPECT_TRUE(rising);
  EXPECT_FALSE(published.refresh());
}

TEST(TripleBuffer, BeforeAnythingIsPublishedTheFirstValueIsRead) {
  TripleBuffer<int> published(7);
  EXPECT_FALSE(published.refresh());
  EXPECT_EQ(published.latest(), 7);
  published.next() = 8;
  published.publish();
  EXPECT_TRUE(published.refresh());
  EXPECT_EQ(published.latest(), 8);
}

TEST(TripleBuffer, CopyingIntoASlotReusesItsMemory) {
  const std::vector<int> big(1000, 1);
  TripleBuffer<std::vector<int>> published(big);
  for (int i = 0; i < 9; ++i) {
    const int* before = published.next().data();
    published.next() = big;
    EXPECT_EQ(published.next().data(), before);
    published.publish();
    published.refresh();
  }
}

}  // namespace
}  // namespace trocar::core
