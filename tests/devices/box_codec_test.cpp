// Blocks and frames of the instrument box: what they are byte by byte, and that they are found again in any stream.
#include <vector>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/devices/box/box_time.hpp>
#include <trocar/devices/box/crc.hpp>
#include <trocar/devices/box/frames.hpp>

namespace trocar::devices {
namespace {

using Bytes = std::vector<std::uint8_t>;

BoxBlock counting_block(unsigned factor = 1733, unsigned first = 291) {
  BoxBlock block;
  for (unsigned i = 0; i < kBoxChannels; ++i)
    block.codes[i] = std::uint16_t((i * factor + first) & unsigned(kBoxTopCode));
  block.digital = 0x8badf00d;
  return block;
}

Bytes packed(const BoxBlock& block, ChannelMask mask = kAllBoxChannels) {
  Bytes bytes(packed_size(mask));
  pack(block, mask, bytes);
  return bytes;
}

Bytes data(unsigned number, ChannelMask mask = kAllBoxChannels) {
  Bytes bytes(data_size(mask));
  bytes.resize(write_data({counting_block(7 + number), mask, std::uint8_t(number & 15), 0}, bytes));
  return bytes;
}

void append(Bytes& to, const Bytes& more) { to.insert(to.end(), more.begin(), more.end()); }

Bytes noise(core::Random& random, std::size_t count) {
  Bytes bytes(count);
  for (std::uint8_t& byte : bytes) byte = std::uint8_t(random.next());
  return bytes;
}

std::vector<DataFrame> parsed(FrameParser& parser, const Bytes& bytes, std::size_t portion = 1u << 20) {
  std::vector<DataFrame> frames;
  for (std::size_t at = 0; at < bytes.size(); at += portion)
    parser.feed(std::span(bytes).subspan(at, std::min(portion, bytes.size() - at)),
                [&](const DataFrame& f) { frames.push_back(f); });
  return frames;
}

// Written down by a program of another language, from the bits: sample after sample, low bit first, digital word last.
const Bytes kGolden = {0x23, 0x81, 0x7e, 0xad, 0x2e, 0x57, 0x37, 0xcc, 0x2f, 0xc1, 0x69, 0x08, 0x4b, 0x07, 0xe1, 0xd5,
                       0xa4, 0xb9, 0x5f, 0x42, 0x92, 0xe9, 0xef, 0x6a, 0x73, 0x8d, 0x43, 0xfd, 0x2a, 0x1c, 0x87, 0xc8,
                       0xf4, 0x11, 0x66, 0xcd, 0x9b, 0x03, 0xa6, 0x25, 0xa1, 0x7e, 0xaf, 0x4e, 0x57, 0x39, 0xec, 0x2f,
                       0xc3, 0x89, 0x08, 0x4d, 0x27, 0xe1, 0xd7, 0xc4, 0xb9, 0x61, 0x62, 0x92, 0xeb, 0x0f, 0x6b, 0x75,
                       0xad, 0x43, 0xff, 0x4a, 0x1c, 0x89, 0xe8, 0xf4, 0x0d, 0xf0, 0xad, 0x8b};

TEST(BoxCodec, TheWholeBlockIsTheGolden608Bits) {
  EXPECT_EQ(kGolden.size() * 8, 608u);
  EXPECT_EQ(packed(counting_block()), kGolden);
  EXPECT_EQ(unpack(kGolden, kAllBoxChannels), counting_block());
}

TEST(BoxCodec, ARawBlockTakesNineteenPointSevenNineMillisecondsAt38400Baud) {
  EXPECT_EQ(kRawBlockBytes, 76u);
  EXPECT_NEAR(box_seconds(time_on_line(kRawBlockBytes, 38'400)), 0.0197917, 1e-7);
  EXPECT_GT(time_on_line(kRawBlockBytes + 1, 38'400), box_time(0.02)) << "one byte more and 50 Hz are not kept";
}

TEST(BoxCodec, FramesHaveTheSizesOfTheTable) {
  const std::pair<int, std::size_t> rows[] = {{10, 25}, {20, 40}, {24, 46}, {40, 70}, {44, 76}, {48, 82}};
  for (const auto& [channels, bytes] : rows) EXPECT_EQ(data_size((ChannelMask(1) << channels) - 1), bytes) << channels;
}

TEST(BoxCodec, EveryMaskKeepsItsChannelsAndTheDigitalWord) {
  core::Random random(3);
  for (int round = 0; round < 200; ++round) {
    const ChannelMask mask = random.next() & random.next() & kAllBoxChannels;
    const BoxBlock block = counting_block(unsigned(random.next() % 4096));
    const BoxBlock again = unpack(packed(block, mask), mask);
    EXPECT_EQ(again.digital, block.digital);
    for (std::size_t i = 0; i < kBoxChannels; ++i)
      EXPECT_EQ(again.codes[i], (mask >> i & 1) != 0 ? block.codes[i] : 0) << i;
  }
}

TEST(BoxCodec, ChecksumsAreThoseOfTheirNames) {
  const Bytes digits = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(box_crc16(digits), 0x906e);
  EXPECT_EQ(box_crc8(digits), 0xd0);
}

TEST(BoxCodec, RequestsAreTheseBytes) {
  Bytes out(kLongestData);
  out.resize(write_config(0x1ffffff, out));
  EXPECT_EQ(out, Bytes({0xa5, 0xc0, 0xff, 0xff, 0xff, 0x01, 0, 0, 0x65, 0xbf}));
  out.resize(kPollBytes);
  EXPECT_EQ(write_poll(7, out), kPollBytes);
  EXPECT_EQ(out, Bytes({0xa5, 0x17, 0x18}));
}

TEST(BoxCodec, TheChecksumFindsEveryBurstOfUpToSixteenBits) {
  const Bytes good = data(5);
  const std::size_t bits = 8 * good.size();
  for (unsigned length = 1; length <= 16; ++length) {
    // A burst of that length begins and ends with a wrong bit; what is between them may be anything: every pattern at
    // some places, and some patterns at every place.
    const unsigned patterns = length <= 2 ? 1u : 1u << (length - 2);
    for (std::size_t at = 0; at + length <= bits; ++at) {
      const unsigned step = at % 97 == 0 ? 1u : 211u;
      for (unsigned inner = unsigned(at) % step; inner < patterns; inner += step) {
        const unsigned burst = length == 1 ? 1u : 1u | inner << 1 | 1u << (length - 1);
        Bytes bad = good;
        for (unsigned k = 0; k < length; ++k)
          if ((burst >> k & 1) != 0) bad[(at + k) / 8] = std::uint8_t(bad[(at + k) / 8] ^ 1u << ((at + k) % 8));
        const std::size_t size = bad.size() - 2;
        ASSERT_NE(box_crc16(std::span(bad).first(size)), bad[size] | bad[size + 1] << 8) << at << ' ' << burst;
      }
    }
  }
}

TEST(BoxParser, FindsFramesInPortionsOfAnySize) {
  Bytes stream;
  for (unsigned i = 0; i < 20; ++i) append(stream, data(i));
  for (const std::size_t portion : {1u, 2u, 7u, 81u, 83u, 1000u}) {
    FrameParser parser;
    const std::vector<DataFrame> frames = parsed(parser, stream, portion);
    ASSERT_EQ(frames.size(), 20u) << portion;
    for (unsigned i = 0; i < 20; ++i) {
      EXPECT_EQ(frames[i].seq, i & 15);
      EXPECT_EQ(frames[i].block, counting_block(7 + i));
    }
    EXPECT_EQ(parser.counts().skipped, 0u);
  }
}

TEST(BoxParser, AfterRandomBytesItIsBackWithinTwoFrames) {
  core::Random random(11);
  for (int round = 0; round < 300; ++round) {
    const ChannelMask mask = (ChannelMask(1) << 25) - 1;
    Bytes stream = noise(random, random.next() % 400);
    if (round % 3 == 0)  // and the worst of noise: beginnings of frames that never come
      for (std::size_t i = 0; i + 3 < stream.size(); i += 5)
        stream[i] = kBoxSync, stream[i + 1] = kBoxData, stream[i + 2] = mask_id(mask);
    FrameParser parser;
    parser.expect(mask);
    parsed(parser, stream, 16);
    std::vector<DataFrame> frames;
    for (unsigned i = 0; i < 2; ++i) {
      const std::vector<DataFrame> more = parsed(parser, data(i, mask), 16);
      frames.insert(frames.end(), more.begin(), more.end());
    }
    ASSERT_FALSE(frames.empty()) << round;
    const BoxBlock newest = frames.back().block;
    EXPECT_TRUE(newest.codes[1] == counting_block(7).codes[1] || newest.codes[1] == counting_block(8).codes[1]);
    parser.silence([&](const DataFrame& f) { frames.push_back(f); });
    EXPECT_EQ(frames.size(), 2u) << "none of the frames is lost, once the line falls silent";
  }
}

TEST(BoxParser, WithOnePerCentOfBadBytesEveryWholeFrameIsFoundAndNoOther) {
  core::Random random(5);
  const ChannelMask mask = (ChannelMask(1) << 25) - 1;
  FrameParser parser;
  parser.expect(mask);
  std::size_t whole = 0, found = 0;
  for (unsigned i = 0; i < 3000; ++i) {
    Bytes frame = data(i, mask);
    bool touched = false;
    for (std::uint8_t& byte : frame)
      if (random.uniform() < 0.01) byte = std::uint8_t(byte ^ (1 + random.next() % 255)), touched = true;
    whole += !touched;
    for (const DataFrame& f : parsed(parser, frame)) {
      ++found;
      bool known = false;  // this one, or the one before where it took until now
      for (unsigned k = 0; k < 3; ++k)
        if (i >= k) known = known || f.block == unpack(packed(counting_block(7 + i - k), mask), mask);
      EXPECT_TRUE(known) << i;
    }
  }
  parser.silence([&](const DataFrame&) { ++found; });
  EXPECT_EQ(found, whole);
  EXPECT_LT(whole, 2300u) << "the test has hit some";
}

TEST(BoxParser, AFrameOfAnotherMaskIsPassedOver) {
  FrameParser parser;
  ASSERT_TRUE(parser.expect(0xff));
  Bytes stream = data(1, 0xfff);
  append(stream, data(2, 0xff));
  append(stream, data(3));  // all channels: a box that was switched on anew
  const std::vector<DataFrame> frames = parsed(parser, stream);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0].mask, 0xffu);
  EXPECT_EQ(frames[1].mask, kAllBoxChannels);
  EXPECT_GE(parser.counts().strangers, 1u);
}

TEST(BoxParser, RequestsAreFoundBetweenNonsense) {
  core::Random random(8);
  RequestParser parser;
  int polls = 0, configs = 0;
  for (int round = 0; round < 500; ++round) {
    Bytes stream = noise(random, random.next() % 30), request(kLongestData);
    for (std::uint8_t& byte : stream) byte = byte == kBoxSync ? 0 : byte;
    const bool config = round % 2 == 0;
    request.resize(config ? write_config(ChannelMask(round), request) : write_poll(std::uint8_t(round), request));
    append(stream, request);
    parser.feed(stream, [&](const BoxRequest& r) {
      EXPECT_EQ(r.kind == BoxRequest::config, config);
      EXPECT_EQ(r.mask, config ? ChannelMask(round) : 0u);
      ++(r.kind == BoxRequest::config ? configs : polls);
    });
  }
  EXPECT_EQ(configs, 250);
  EXPECT_EQ(polls, 250);
}

TEST(BoxParser, RawBlocksAreCutAtSilences) {
  RawParser parser;
  std::vector<BoxBlock> blocks;
  const auto keep = [&](const BoxBlock& b) { blocks.push_back(b); };
  parser.feed(std::span(kGolden).subspan(30), true, keep);  // it was plugged in within a block
  parser.feed(kGolden, true, keep);
  parser.feed(kGolden, false, keep);
  ASSERT_EQ(blocks.size(), 2u);
  EXPECT_EQ(blocks[0], counting_block());
  EXPECT_EQ(blocks[1], counting_block());
  EXPECT_EQ(parser.counts().torn, 1u);
}

}  // namespace
}  // namespace trocar::devices
