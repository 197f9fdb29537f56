// The datagrams by which a program of somebody's own brings its device (docs/guides/haptics.md has the format and an
// example).
#pragma once

#include <optional>
#include <span>

#include <trocar/devices/haptics/device.hpp>

namespace trocar::devices {

inline constexpr std::size_t kSampleBytes = 80, kForceBytes = 64, kAbilityBytes = 80;

/// What a datagram says, or nothing where it is no such one: another length, another mark, a value that no device has.
std::optional<HapticSample> read_sample(std::span<const std::uint8_t> datagram) noexcept;
std::optional<HapticCapabilities> read_abilities(std::span<const std::uint8_t> datagram);

void write_force(std::span<std::uint8_t, kForceBytes> to, std::uint32_t number, const HapticForce& force) noexcept;

/// For programs on the other side, and for tests.
void write_sample(std::span<std::uint8_t, kSampleBytes> to, const HapticSample& sample) noexcept;
void write_abilities(std::span<std::uint8_t, kAbilityBytes> to, const HapticCapabilities& device) noexcept;
std::optional<HapticForce> read_force(std::span<const std::uint8_t> datagram, std::uint32_t& number) noexcept;

}  // namespace trocar::devices
