// What the instrument box measures at one moment, and how it lies in bytes: 48 analogue channels of 12 bits and 32
// digital bits ("up to 48 analog 12-Bit input channels and 32-Bits digital input for foot switches").
//
// Packed LSB first: two samples in three bytes, channels rising, then the digital word, low byte first. All channels
// are 48 * 12 + 32 = 608 bits = 76 bytes; with 10 bits a byte on the line that is 19.79 ms at 38,400 Bd.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace trocar::devices {

inline constexpr int kBoxChannels = 48;
inline constexpr int kBoxDigitalBits = 32;
inline constexpr int kBoxTopCode = 4095;

/// A set of channels, bit i for channel i.
using ChannelMask = std::uint64_t;
inline constexpr ChannelMask kAllBoxChannels = (ChannelMask(1) << kBoxChannels) - 1;
inline constexpr std::size_t kBoxMaskBytes = 6;

struct BoxBlock {
  std::array<std::uint16_t, kBoxChannels> codes{};  ///< 0 .. kBoxTopCode; 0 for channels that were not sent
  std::uint32_t digital = 0;

  bool operator==(const BoxBlock&) const = default;
};

constexpr int channels_in(ChannelMask mask) noexcept {
  int count = 0;
  for (mask &= kAllBoxChannels; mask != 0; mask &= mask - 1) ++count;
  return count;
}

/// Bytes of a block with the channels of `mask`: ceil(1.5 n) + 4.
constexpr std::size_t packed_size(ChannelMask mask) noexcept { return std::size_t(3 * channels_in(mask) + 1) / 2 + 4; }
inline constexpr std::size_t kRawBlockBytes = packed_size(kAllBoxChannels);
static_assert(kRawBlockBytes == 76);

/// Writes packed_size(mask) bytes. Codes above kBoxTopCode lose their upper bits.
void pack(const BoxBlock& block, ChannelMask mask, std::span<std::uint8_t> out) noexcept;
/// Reads packed_size(mask) bytes.
BoxBlock unpack(std::span<const std::uint8_t> bytes, ChannelMask mask) noexcept;

}  // namespace trocar::devices
