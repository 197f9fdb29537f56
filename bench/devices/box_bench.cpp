// What a block of the instrument box costs: found in the stream, unpacked, calibrated and filtered. It comes 50 times a
// second, or 1000 times from new hardware.
#include <vector>

#include <benchmark/benchmark.h>

#include <trocar/devices/box/reading.hpp>

using namespace trocar::devices;

namespace {

std::vector<std::uint8_t> stream(ChannelMask mask, unsigned count) {
  std::vector<std::uint8_t> bytes;
  for (unsigned n = 0; n < count; ++n) {
    BoxBlock block;
    for (unsigned i = 0; i < kBoxChannels; ++i) block.codes[i] = std::uint16_t((i * 97 + n) & 4095u);
    std::vector<std::uint8_t> frame(kLongestData);
    frame.resize(write_data({block, mask, std::uint8_t(n & 15u), 0}, frame));
    bytes.insert(bytes.end(), frame.begin(), frame.end());
  }
  return bytes;
}

constexpr unsigned kFrames = 256;

void parse(benchmark::State& bench, ChannelMask mask, std::size_t portion) {
  const std::vector<std::uint8_t> bytes = stream(mask, kFrames);
  FrameParser parser;
  parser.expect(mask);
  for (auto _ : bench)
    for (std::size_t at = 0; at < bytes.size(); at += portion)
      parser.feed(std::span(bytes).subspan(at, std::min(portion, bytes.size() - at)),
                  [](const DataFrame& frame) { benchmark::DoNotOptimize(frame.block.codes[0]); });
  bench.SetItemsProcessed(std::int64_t(bench.iterations()) * kFrames);
}
BENCHMARK_CAPTURE(parse, All48ChannelsInPortionsOf8Bytes, kAllBoxChannels, 8);
BENCHMARK_CAPTURE(parse, TwentyFiveChannelsInPortionsOf8Bytes, (ChannelMask(1) << 25) - 1, 8);

void noise(benchmark::State& bench) {
  std::vector<std::uint8_t> bytes(1 << 14);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = std::uint8_t(i * i * 2654435761u >> 13);
  FrameParser parser;
  for (auto _ : bench) parser.feed(bytes, [](const DataFrame& frame) { benchmark::DoNotOptimize(frame.seq); });
  bench.SetBytesProcessed(std::int64_t(bench.iterations() * bytes.size()));
}
BENCHMARK(noise);

void read(benchmark::State& bench) {
  BoxReader reader(default_wiring());
  BoxBridge bridge(20'000'000);
  BoxPacket packet;
  packet.mask = default_wiring().mask();
  packet.checked = true;
  for (auto _ : bench) {
    packet.acquired += 20'000'000;
    packet.arrived = packet.acquired + 14'000'000;
    packet.block.codes[3] = std::uint16_t(packet.acquired >> 20 & 4095);
    bridge.take(reader.read(packet));
    benchmark::DoNotOptimize(bridge.at(packet.arrived));
  }
}
BENCHMARK(read);

}  // namespace
