// What comes over the line from a box, and what a box hears, in portions with pauses: the first byte chooses frames or
// raw blocks, and how many channels; every portion begins with its size and the time since the one before. A box.json
// that reads well is written and read again as the same.
#include <cmath>

#include <trocar/attempt/box/box_file.hpp>
#include <trocar/devices/box/box_thread.hpp>
#include <trocar/devices/box/software_box.hpp>

#include "targets.hpp"

namespace trocar::fuzz {
namespace {

using namespace devices;

bool finite(const BoxPose& pose) {
  for (const auto& actor : pose.axes)
    for (const double axis : actor)
      if (!std::isfinite(axis)) return false;
  return true;
}

/// Calls f(bytes, now) for each portion.
template <class F>
void for_portions(Bytes bytes, F&& f) {
  BoxTime now = 0;
  while (bytes.size() > 2) {
    const std::size_t size = std::min<std::size_t>(bytes[0], bytes.size() - 2);
    now += BoxTime(bytes[1]) * 500'000;
    f(bytes.subspan(2, size), now);
    bytes = bytes.subspan(2 + size);
  }
}

}  // namespace

void box_line(Bytes bytes) {
  if (bytes.empty()) return;
  BoxWiring wiring = default_wiring();
  wiring.raw = (bytes[0] & 1) != 0;
  BoxDialogueSettings settings = dialogue_settings(wiring);
  if ((bytes[0] & 2) != 0) settings.mask = kAllBoxChannels;
  BoxDialogue dialogue(settings);
  BoxReader reader(wiring);
  BoxBridge bridge(settings.period());
  SoftwareBox box({.raw = wiring.raw}, [](double) { return BoxBlock{}; });
  std::array<std::uint8_t, 256> out;
  std::uint64_t blocks = 0, heard = 0;
  for_portions(bytes.subspan(1), [&](Bytes portion, BoxTime now) {
    require(dialogue.ask(now).size() <= kConfigBytes + kPollBytes, "a request is short");
    dialogue.hear(portion, now, [&](const BoxPacket& packet) {
      ++blocks;
      require(packet.acquired <= packet.arrived && packet.arrived == now, "nothing is measured after it has come");
      for (std::size_t i = 0; i < kBoxChannels; ++i)
        require(packet.block.codes[i] <= kBoxTopCode && ((packet.mask >> i & 1) != 0 || packet.block.codes[i] == 0),
                "codes have twelve bits, and come from channels that were sent");
      bridge.take(reader.read(packet));
    });
    require(finite(bridge.at(now + 60'000'000)), "poses are finite, between blocks too");
    heard += portion.size();
    box.hear(portion, now);
    require(box.due(now, out) <= out.size(), "no more is sent than was asked for");
  });
  const std::size_t least = wiring.raw ? kRawBlockBytes : data_size(settings.mask);
  require(blocks * least <= heard, "every block has come byte by byte");
  require(dialogue.counts().blocks <= blocks, "none is counted twice");
}

std::vector<Seed> box_seeds() {
  std::vector<Seed> seeds;
  for (const bool raw : {false, true}) {
    const ChannelMask mask = raw ? kAllBoxChannels : default_wiring().mask();
    std::vector<std::uint8_t> bytes = {std::uint8_t(raw ? 1 : 0)};
    for (unsigned n = 1; n < 6; ++n) {
      BoxBlock block;
      for (unsigned i = 0; i < kBoxChannels; ++i) block.codes[i] = std::uint16_t(2000 + 10 * i + n);
      block.digital = n == 3 ? 0x1ff : 0;
      std::array<std::uint8_t, kLongestData> frame{};
      const std::size_t size = raw ? kRawBlockBytes : write_data({block, mask, std::uint8_t(n), 0}, frame);
      if (raw) pack(block, mask, frame);
      bytes.push_back(std::uint8_t(size));
      bytes.push_back(n == 4 ? 60 : 40);
      bytes.insert(bytes.end(), frame.begin(), frame.begin() + std::ptrdiff_t(size));
    }
    seeds.push_back({raw ? "raw" : "framed", bytes});
  }
  std::vector<std::uint8_t> requests = {0};
  std::array<std::uint8_t, kLongestData> out{};
  for (unsigned n = 0; n < 5; ++n) {
    const std::size_t size = n == 0 ? write_config(0xff, out) : write_poll(std::uint8_t(n), out);
    requests.push_back(std::uint8_t(size));
    requests.push_back(40);
    requests.insert(requests.end(), out.begin(), out.begin() + std::ptrdiff_t(size));
  }
  seeds.push_back({"requests", requests});
  return seeds;
}

void box_file(Bytes bytes) {
  std::vector<core::Fault> faults;
  const scene::MemoryFiles files{{"box.json", text_of(bytes)}};
  const BoxWiring wiring = attempt::read_box_file("box.json", faults, &files);
  for (const core::Fault& f : faults) require(!f.message.empty(), "a fault says what was expected");
  for (const auto& actor : wiring.axes)
    for (const WiredAxis& axis : actor) {
      require(axis.channel < kBoxChannels, "channels are there");
      if (axis.channel < 0) continue;
      require(unfit(axis.table).empty(), "tables are monotone");
      for (int code = 0; code <= kBoxTopCode; code += 273)
        require(std::isfinite(axis.table.value(code)), "and finite at every code");
    }
  if (!faults.empty()) return;
  const std::string text = attempt::box_file_text(wiring);
  const scene::MemoryFiles again{{"box.json", text}};
  const BoxWiring second = attempt::read_box_file("box.json", faults, &again);
  require(faults.empty() && attempt::box_file_text(second) == text, "what was read is written and read again");
}

std::vector<Seed> box_file_seeds() {
  BoxWiring other = default_wiring();
  other.raw = true;
  other.from_placed = false;
  other.inverted = 0x80000001;
  other.axes[1] = {};
  return {{"built_in", bytes_of(attempt::box_file_text(default_wiring()))},
          {"other", bytes_of(attempt::box_file_text(other))}};
}

}  // namespace trocar::fuzz
