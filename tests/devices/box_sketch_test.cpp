// The sketch for a box's microcontroller (docs/guides/trocar_box), compiled for this machine with a board of software:
// what its converters and switches have arrives at who asks, by the protocol as it is read here.
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/devices/box/crc.hpp>
#include <trocar/devices/box/dialogue.hpp>

#include "arduino/SPI.h"

namespace sketch {
#include "../../docs/guides/trocar_box/trocar_box.ino"
}  // namespace sketch

namespace trocar::devices {
namespace {

constexpr ChannelMask kSome = 0x0000'a55a'1234'8001;

/// Runs the sketch for a whole round of measurements.
void run_sketch() {
  for (int i = 0; i <= kBoxChannels; ++i) sketch::loop();
}

std::vector<std::uint8_t> taken() { return std::exchange(arduino::board().out, {}); }

void say(std::span<const std::uint8_t> bytes) {
  arduino::board().in.insert(arduino::board().in.end(), bytes.begin(), bytes.end());
}

/// Something else on every input.
BoxBlock set_inputs(core::Random& random) {
  BoxBlock block;
  for (std::size_t i = 0; i < kBoxChannels; ++i) {
    block.codes[i] = std::uint16_t(random.next() % (kBoxTopCode + 1));
    arduino::board().converters[i / 8].code[i % 8] = block.codes[i];
  }
  block.digital = std::uint32_t(random.next());
  for (std::size_t k = 0; k < 2; ++k) arduino::board().switches[k].closed = std::uint16_t(block.digital >> (16 * k));
  return block;
}

BoxBlock only(BoxBlock block, ChannelMask mask) {
  for (std::size_t i = 0; i < kBoxChannels; ++i)
    if ((mask >> i & 1) == 0) block.codes[i] = 0;
  return block;
}

class BoxSketch : public testing::Test {
 protected:
  void SetUp() override {
    arduino::board() = arduino::Board();
    sketch::box = decltype(sketch::box)();
    sketch::setup();
  }
};

TEST_F(BoxSketch, WhatItsInputsHaveArrivesAtWhoAsks) {
  core::Random random(5);
  BoxDialogue dialogue({.mask = kSome});
  BoxTime now = 0;
  for (int round = 0; round < 40; ++round, now += dialogue.settings().period()) {
    const BoxBlock inputs = set_inputs(random);
    run_sketch();
    say(dialogue.ask(now));
    sketch::loop();
    int heard = 0;
    dialogue.hear(taken(), now + 5'000'000, [&](const BoxPacket& p) {
      ++heard;
      EXPECT_EQ(p.block, only(inputs, p.mask)) << round;
      EXPECT_EQ(p.mask, kSome) << "it is told its channels with the first request";
      EXPECT_EQ(p.flags, 0) << round;
    });
    EXPECT_EQ(heard, 1) << round;
  }
  EXPECT_EQ(dialogue.counts().missed + dialogue.counts().bad + dialogue.counts().skipped, 0u);
  EXPECT_EQ(dialogue.counts().configs, 1u);
}

TEST_F(BoxSketch, ASwitchedOnBoxSaysSoAndSendsAllChannels) {
  core::Random random(6);
  const BoxBlock inputs = set_inputs(random);
  run_sketch();
  std::array<std::uint8_t, kPollBytes> poll{};
  write_poll(7, poll);
  say(poll);
  sketch::loop();
  FrameParser parser;
  int heard = 0;
  parser.feed(taken(), [&](const DataFrame& frame) {
    ++heard;
    EXPECT_EQ(frame.block, inputs);
    EXPECT_EQ(frame.seq, 7);
    EXPECT_EQ(frame.flags, kBoxFresh);
  });
  EXPECT_EQ(heard, 1);
}

TEST_F(BoxSketch, AfterNonsenseOnTheLineItFindsTheNextRequestAsTheSoftwareBoxDoes) {
  core::Random random(7);
  run_sketch();
  RequestParser reference;
  ChannelMask mask = kAllBoxChannels;
  std::uint64_t asked = 0;
  for (int round = 0; round < 3000; ++round) {
    std::vector<std::uint8_t> bytes;
    for (std::uint64_t n = random.next() % 4; n > 0; --n) {
      constexpr std::uint8_t kLikely[] = {kBoxSync, kBoxPoll, kBoxConfig, 0};
      bytes.push_back(random.next() % 2 != 0 ? kLikely[random.next() % 4] : std::uint8_t(random.next()));
    }
    std::array<std::uint8_t, kConfigBytes> request{};
    const std::size_t size =
        random.next() % 5 == 0 ? write_config(random.next(), request) : write_poll(std::uint8_t(round), request);
    if (random.next() % 10 == 0) request[random.next() % size] ^= 4;
    bytes.insert(bytes.end(), request.begin(), request.begin() + std::ptrdiff_t(size));
    std::vector<std::size_t> sizes;  // of the answers that there must be
    reference.feed(bytes, [&](const BoxRequest& r) {
      if (r.kind == BoxRequest::config)
        mask = r.mask;
      else
        sizes.push_back(data_size(mask));
    });
    say(bytes);
    sketch::loop();
    const std::vector<std::uint8_t> out = taken();
    std::size_t at = 0;
    for (const std::size_t size : sizes) {
      ASSERT_LE(at + size, out.size()) << round;
      const auto frame = std::span(out).subspan(at, size);
      EXPECT_EQ(box_crc16(frame.first(size - 2)), unsigned(frame[size - 2] | frame[size - 1] << 8)) << round;
      at += size;
    }
    ASSERT_EQ(at, out.size()) << round;
    asked += sizes.size();
  }
  EXPECT_GT(asked, 2000u);
}

TEST(BoxSketchRaw, ARawBlockIsReadAsWhatWasMeasured) {
  arduino::board() = arduino::Board();
  core::Random random(8);
  sketch::trocar_box::Measured measured{};
  BoxBlock block;
  for (std::size_t i = 0; i < kBoxChannels; ++i)
    measured.code[i] = block.codes[i] = std::uint16_t(random.next() % (kBoxTopCode + 1));
  measured.bits = block.digital = 0x8000'0401;
  sketch::trocar_box::Box::send_raw(measured, Serial);
  const std::vector<std::uint8_t> out = taken();
  ASSERT_EQ(out.size(), kRawBlockBytes);
  EXPECT_EQ(unpack(out, kAllBoxChannels), block);
}

}  // namespace
}  // namespace trocar::devices
