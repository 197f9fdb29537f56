// Who asks and the software box that answers, over a line with a clock of the test's own.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/devices/box/dialogue.hpp>
#include <trocar/devices/box/software_box.hpp>

namespace trocar::devices {
namespace {

constexpr ChannelMask kTwentyFive = (ChannelMask(1) << 25) - 1;
constexpr BoxTime kStep = 100'000;  // [ns]

/// The hundredths of a second since the motion began, on every channel.
BoxBlock hundredths(double seconds) {
  BoxBlock block;
  for (std::size_t i = 0; i < kBoxChannels; ++i)
    block.codes[i] = std::uint16_t(std::lround(seconds * 100) % (kBoxTopCode + 1));
  block.digital = std::uint32_t(std::lround(seconds * 100));
  return block;
}

struct Line {
  BoxDialogueSettings asks;
  SoftwareBoxSettings answers;
  std::vector<BoxPacket> packets;
  BoxTime now = 0;
  BoxCounts counts;
  std::uint64_t sent = 0, dropped = 0;
  BoxTime lose_from = -1, lose_to = -1;  // bytes to the host that are lost meanwhile
  BoxTime sleeps = 0;                    // once a second the host sleeps so long
  std::function<BoxBlock(double)> motion = hundredths;

  bool asleep() const { return sleeps > 0 && now > box_time(1) && now % box_time(1.0071) < sleeps; }

  void run(double seconds) {
    SoftwareBox box(answers, motion);
    BoxDialogue dialogue(asks);
    BoxTime due = now;
    std::vector<std::uint8_t> waiting;
    for (const BoxTime end = now + box_time(seconds); now < end; now += kStep) {
      std::array<std::uint8_t, 64> bytes;
      const std::size_t count = box.due(now, bytes);
      if (!(now >= lose_from && now < lose_to))
        waiting.insert(waiting.end(), bytes.begin(), bytes.begin() + long(count));
      if (asleep()) continue;
      dialogue.hear(waiting, now, [this](const BoxPacket& p) { packets.push_back(p); });
      waiting.clear();
      if (now < due) continue;
      box.hear(dialogue.ask(now), now);
      due = dialogue.next(std::max(due + asks.period(), now));
    }
    counts = dialogue.counts();
    sent = box.sent();
    dropped = box.dropped();
  }
};

TEST(BoxDialogue, AsksTenMinutesAtFiftyHertzWithoutALoss) {
  Line line;
  line.asks.mask = kTwentyFive;
  line.run(600);
  EXPECT_EQ(line.counts.missed, 0u);
  EXPECT_EQ(line.counts.bad + line.counts.skipped, 0u);
  EXPECT_GE(line.packets.size(), 29'998u);
  EXPECT_EQ(line.counts.configs, 1u) << "the box is told its channels once";
  for (const BoxPacket& p : line.packets) {
    ASSERT_EQ(p.missed, 0u);
    ASSERT_LT(p.arrived - p.acquired, box_time(0.020));
  }
  EXPECT_EQ(line.packets.back().mask, kTwentyFive);
}

TEST(BoxDialogue, AllChannelsWithoutFramesKeepFiftyHertzOnlyBecauseRequestsOverlapAnswers) {
  Line line;
  line.asks.raw = line.answers.raw = true;
  line.run(30);
  EXPECT_GE(line.packets.size(), 1498u);
  EXPECT_EQ(line.counts.missed, 0u);
  EXPECT_EQ(line.counts.bad, 0u);
}

TEST(BoxDialogue, ABlockTakesAtMostTwentyMillisecondsWithAsManyChannelsAsTheLineCarries) {
  struct Case {
    bool raw;
    int baud;
    ChannelMask mask;
    double bound;  // [ms]
  };
  for (const Case& c : {Case{true, 38'400, kAllBoxChannels, 20}, Case{false, 38'400, (ChannelMask(1) << 44) - 1, 20},
                        Case{false, 57'600, kAllBoxChannels, 15}, Case{false, 38'400, kAllBoxChannels, 21.6}}) {
    Line line;
    line.asks = {c.baud, 50, c.raw, c.mask};
    line.answers.raw = c.raw;
    line.answers.baud = c.baud;
    const std::size_t bytes = c.raw ? kRawBlockBytes : data_size(c.mask);
    line.asks.rate = std::min(50.0, most_blocks(bytes, c.baud));
    line.run(30);  // shorter than until the codes wrap round, which raw blocks are not believed
    EXPECT_EQ(line.counts.missed, 0u);
    double most = 0;
    for (const BoxPacket& p : line.packets) most = std::max(most, 1000 * box_seconds(p.arrived - p.acquired));
    EXPECT_LE(most, c.bound + 1e-6 * double(kStep)) << bytes << " bytes at " << c.baud << " Bd";
    EXPECT_GT(most, 1000 * box_seconds(time_on_line(bytes, c.baud))) << "that is what the line alone takes";
  }
}

TEST(BoxDialogue, AllChannelsWithFramesComeAsFastAsTheLineCarriesThem) {
  Line line;
  line.run(60);
  EXPECT_NEAR(double(line.packets.size()) / 60, most_blocks(kLongestData, 38'400), 0.5) << "fewer than fifty";
  EXPECT_EQ(line.counts.missed, 0u);
}

TEST(BoxDialogue, ASleepOfTheHostDelaysTheBlocksOfThatMomentAlone) {
  Line line;
  line.asks.mask = (ChannelMask(1) << 44) - 1;  // the line has 0.2 ms to spare in every period
  line.sleeps = box_time(0.015);
  line.run(60);
  int late = 0;
  for (const BoxPacket& p : line.packets) late += p.arrived - p.acquired > box_time(0.0201);
  EXPECT_GE(late, 10) << "it does happen";
  EXPECT_LE(late, 59) << "once a sleep at most";
  EXPECT_EQ(line.counts.missed, 0u);
}

TEST(BoxDialogue, WhatTheHostSleptThroughIsNoSilence) {
  for (const bool raw : {false, true}) {
    Line line;
    line.asks.raw = line.answers.raw = raw;
    line.asks.mask = raw ? kAllBoxChannels : kTwentyFive;
    line.sleeps = box_time(0.030);
    line.run(30);
    EXPECT_EQ(line.counts.bad + line.counts.skipped, 0u) << raw;
    EXPECT_GT(line.packets.size(), 1400u) << raw;
  }
}

TEST(BoxDialogue, WhatIsDroppedIsMissedAndCountedExactly) {
  Line line;
  line.asks.mask = kTwentyFive;
  line.answers.drop = 0.05;
  line.run(120);
  EXPECT_GT(line.dropped, 200u);
  EXPECT_NEAR(double(line.counts.missed), double(line.dropped), 2) << "those at the two ends are not between blocks";
  EXPECT_EQ(line.counts.bad, 0u);
}

TEST(BoxDialogue, WithOnePerCentOfBadBytesTheNextGoodBlockIsTheNextGoodBlock) {
  Line line;
  line.asks.mask = kTwentyFive;
  line.answers.corrupt = 0.01;
  line.run(120);
  EXPECT_GT(line.counts.bad, 500u);
  // 48 bytes, each whole in 99 of 100 cases: 0.617 of the blocks.
  EXPECT_NEAR(double(line.packets.size()) / 6000, std::pow(0.99, 48), 0.03);
  double before = -1;
  for (const BoxPacket& p : line.packets) {
    EXPECT_EQ(p.block.codes[3], p.block.digital % (kBoxTopCode + 1)) << "no block that is not the box's";
    EXPECT_GT(p.block.digital, before);
    before = p.block.digital;
  }
}

TEST(BoxDialogue, RawBlocksAreCutRightlyAgainAfterALostByte) {
  const auto waves = [](double seconds) {
    BoxBlock block;
    for (unsigned i = 0; i < kBoxChannels; ++i)
      block.codes[i] = std::uint16_t(2048 + 1500 * std::sin(2.4 * i + seconds));
    return block;
  };
  for (int place = 0; place < 40; ++place) {
    Line line;
    line.asks.raw = line.answers.raw = true;
    line.motion = waves;
    line.lose_from = 1'000'000'000 + place * 500'000;
    line.lose_to = line.lose_from + 4 * kStep;  // a byte, or two
    line.run(4);
    EXPECT_GE(line.counts.bad, 1u) << place;
    EXPECT_GT(line.packets.size(), 190u) << place << ": few blocks are lost until it is right again";
    int wrong = 0;
    for (std::size_t n = 1; n < line.packets.size(); ++n)
      wrong += unlikely_after(line.packets[n - 1].block, line.packets[n].block, kAllBoxChannels);
    EXPECT_EQ(wrong, 0) << place << ": none that was cut at a wrong place is believed";
  }
}

TEST(BoxDialogue, ABoxThatIsSwitchedOnAnewIsToldItsChannelsAnew) {
  BoxDialogue dialogue({.mask = kTwentyFive});
  SoftwareBox box({}, hundredths);
  std::vector<BoxPacket> packets;
  std::array<std::uint8_t, 64> bytes;
  for (BoxTime now = 0, due = 0; now < box_time(2); now += kStep) {
    if (now == box_time(1)) box.hang_up();
    if (now >= due) {
      box.hear(dialogue.ask(now), now);
      due += dialogue.settings().period();
    }
    const std::size_t count = box.due(now, bytes);
    dialogue.hear(std::span(bytes).first(count), now, [&](const BoxPacket& p) { packets.push_back(p); });
  }
  EXPECT_EQ(dialogue.counts().configs, 2u);
  EXPECT_EQ(packets.back().mask, kTwentyFive);
  EXPECT_EQ(packets.back().flags & kBoxFresh, 0);
}

TEST(BoxDialogue, AnswersThatNobodyAskedForAreNotBelieved) {
  BoxDialogue dialogue({.mask = kTwentyFive});
  int heard = 0;
  std::array<std::uint8_t, kLongestData> out{};
  const auto answer = [&](std::uint8_t seq, BoxTime now) {
    const std::size_t size = write_data({hundredths(1), kTwentyFive, seq, 0}, out);
    dialogue.hear(std::span(out).first(size), now, [&](const BoxPacket&) { ++heard; });
  };
  answer(1, 0);
  EXPECT_EQ(heard, 0) << "before anything was asked";
  static_cast<void>(dialogue.ask(1'000'000));  // with seq 1
  answer(9, 2'000'000);
  EXPECT_EQ(heard, 0) << "another one";
  answer(1, 14'000'000);
  answer(1, 15'000'000);
  EXPECT_EQ(heard, 1) << "once";
  EXPECT_EQ(dialogue.counts().blocks, 1u);
  EXPECT_EQ(dialogue.counts().bad, 3u);
}

TEST(BoxDialogue, ABoxThatSendsByItselfIsCountedToo) {
  Line line;
  line.asks.mask = kTwentyFive;
  line.answers.stream_rate = 500;
  line.answers.baud = line.asks.baud = 1'000'000;
  line.answers.drop = 0.02;
  line.run(10);
  EXPECT_NEAR(double(line.packets.size() + line.dropped), 5000, 3);
  EXPECT_NEAR(double(line.counts.missed), double(line.dropped), 3);
}

TEST(SoftwareBox, SendsByteAfterByteAtTheBaudRate) {
  SoftwareBox box({.raw = true, .turnaround = 0}, hundredths);
  const std::uint8_t request = kRawRequest;
  box.hear({&request, 1}, 0);
  std::array<std::uint8_t, 100> bytes;
  const BoxTime asked = time_on_line(1, 38'400);
  EXPECT_EQ(box.due(asked + time_on_line(1, 38'400) - 1, bytes), 0u);
  EXPECT_EQ(box.due(asked + time_on_line(1, 38'400), bytes), 1u);
  EXPECT_EQ(box.due(asked + time_on_line(75, 38'400), bytes), 74u);
  EXPECT_EQ(box.next_due(), asked + time_on_line(76, 38'400));
  EXPECT_EQ(box.due(box.next_due(), bytes), 1u);
  EXPECT_NEAR(box_seconds(time_on_line(76, 38'400)), 0.01979, 1e-5);
}

TEST(SoftwareBox, ByRequestsItsMotionIsTheSameHoweverLongTheyTake) {
  for (const double rate : {50.0, 7.0}) {
    Line line;
    line.asks.mask = kTwentyFive;
    line.asks.rate = rate;
    line.answers.per_request = 0.02;
    line.run(100 / rate);
    ASSERT_GE(line.packets.size(), 98u);
    for (std::size_t i = 0; i < 98; ++i) EXPECT_EQ(line.packets[i].block.digital, 2 * i) << rate;
  }
}

TEST(SoftwareBox, ItsMotionWaitsWhileWhoReadsHasStopped) {
  for (const double per_request : {0.0, 0.02}) {
    SoftwareBox box({.per_request = per_request}, hundredths);
    BoxDialogue dialogue({.mask = kTwentyFive});
    std::vector<std::uint32_t> heard;
    std::array<std::uint8_t, 64> bytes;
    const BoxTime period = dialogue.settings().period(), stopped = box_time(4);
    BoxTime due = 0, break_at = box_time(2);
    for (BoxTime now = 0; now < box_time(8); now += kStep) {
      if (now >= due) {
        box.hear(dialogue.ask(now), now);
        due += period;
        if (now >= break_at) due = now + stopped, break_at = box_time(100);  // as by SIGSTOP
      }
      const std::size_t count = box.due(now, bytes);
      dialogue.hear(std::span(bytes).first(count), now, [&](const BoxPacket& p) { heard.push_back(p.block.digital); });
      EXPECT_EQ(box.waits(now), now > box_time(2.5) && now < box_time(6)) << now;
    }
    ASSERT_GT(heard.size(), 150u);
    for (std::size_t i = 1; i < heard.size(); ++i) {
      ASSERT_GE(heard[i], heard[i - 1]) << "it does not begin again";
      ASSERT_LE(heard[i], heard[i - 1] + 5) << "and has not gone on meanwhile";
    }
    EXPECT_GT(heard.back(), 350u) << "and goes on afterwards";
  }
}

TEST(SoftwareBox, NoiseHasTheSizeThatWasAskedFor) {
  Line line;
  line.asks.mask = kTwentyFive;
  line.answers.noise = 3;
  line.motion = [](double) {
    BoxBlock block;
    block.codes.fill(2000);
    return block;
  };
  line.run(20);
  double sum = 0, squares = 0;
  for (const BoxPacket& p : line.packets) {
    sum += p.block.codes[4] - 2000;
    squares += (p.block.codes[4] - 2000) * (p.block.codes[4] - 2000);
  }
  const double n = double(line.packets.size());
  EXPECT_NEAR(sum / n, 0, 0.4);
  EXPECT_NEAR(std::sqrt(squares / n), 3, 0.3);
}

}  // namespace
}  // namespace trocar::devices
