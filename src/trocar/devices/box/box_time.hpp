// Time on a steady clock in nanoseconds: what codec, dialogue and software box reckon with, so that tests hand them a
// clock of their own.
#pragma once

#include <chrono>
#include <cstdint>

#include <trocar/devices/steady_now.hpp>

namespace trocar::devices {

using BoxTime = std::int64_t;  ///< [ns]

constexpr BoxTime box_time(double seconds) noexcept { return BoxTime(seconds * 1e9); }
constexpr double box_seconds(BoxTime time) noexcept { return double(time) * 1e-9; }

inline BoxTime box_now() noexcept { return steady_now(); }

inline constexpr int kBitsPerByte = 10;  ///< on the line: start bit, eight, stop bit
/// How long the line needs for so many bytes.
constexpr BoxTime time_on_line(std::size_t bytes, int baud) noexcept {
  return BoxTime(bytes) * kBitsPerByte * 1'000'000'000 / baud;
}

/// Between two blocks, for a box that turns to the next request: with less, blocks wait for each other on the line.
inline constexpr BoxTime kBetweenBlocks = 150'000;
/// Blocks a second that a line carries at most.
constexpr double most_blocks(std::size_t bytes, int baud) noexcept {
  return 1 / box_seconds(time_on_line(bytes, baud) + kBetweenBlocks);
}

}  // namespace trocar::devices
