#include <trocar/devices/box/block.hpp>

namespace trocar::devices {
namespace {

/// Calls f(channel, place) with the place of each channel of `mask` among the samples that are sent.
template <class F>
void for_channels(ChannelMask mask, F&& f) noexcept {
  std::size_t place = 0;
  for (std::size_t channel = 0; channel < kBoxChannels; ++channel)
    if ((mask >> channel & 1) != 0) f(channel, place++);
}

}  // namespace

void pack(const BoxBlock& block, ChannelMask mask, std::span<std::uint8_t> out) noexcept {
  const std::size_t size = packed_size(mask);
  for (std::uint8_t& byte : out.first(size)) byte = 0;
  for_channels(mask, [&](std::size_t channel, std::size_t place) {
    const unsigned code = block.codes[channel] & unsigned(kBoxTopCode), at = unsigned(place / 2 * 3);
    if (place % 2 == 0) {
      out[at] = std::uint8_t(code);
      out[at + 1] = std::uint8_t(code >> 8);
    } else {
      out[at + 1] = std::uint8_t(out[at + 1] | (code << 4 & 0xf0));
      out[at + 2] = std::uint8_t(code >> 4);
    }
  });
  for (std::size_t i = 0; i < 4; ++i) out[size - 4 + i] = std::uint8_t(block.digital >> (8 * i));
}

BoxBlock unpack(std::span<const std::uint8_t> bytes, ChannelMask mask) noexcept {
  BoxBlock block;
  const std::size_t size = packed_size(mask);
  for_channels(mask, [&](std::size_t channel, std::size_t place) {
    const std::size_t at = place / 2 * 3;
    const unsigned code = place % 2 == 0 ? bytes[at] | unsigned(bytes[at + 1] & 0x0f) << 8
                                         : unsigned(bytes[at + 1] >> 4) | unsigned(bytes[at + 2]) << 4;
    block.codes[channel] = std::uint16_t(code);
  });
  for (std::size_t i = 0; i < 4; ++i) block.digital |= std::uint32_t(bytes[size - 4 + i]) << (8 * i);
  return block;
}

}  // namespace trocar::devices
