// What Haply's Inverse Service says and hears, version 3.1 and later of its JSON, on its simulation channel
// (docs.haply.co/inverseSDK, "Simulation Channel"): after its first message, one for each that it is sent.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <trocar/devices/haptics/device.hpp>

namespace trocar::devices {

/// What a message of the service says of the first Inverse3, and of the first grip with it.
struct HaplyState {
  std::string device;   ///< its number in the service's words
  bool small = false;   ///< a Minverse
  HapticSample sample;  ///< without number
  bool turns = false;   ///< a grip said how it is turned
};
/// Nothing where it is no such message, names no Inverse3, or says something that no device does.
std::optional<HaplyState> read_haply(std::string_view message);

/// Its frame is the same: x to the right, y forward, z up. @param first  with the words that begin a session
std::string haply_command(const std::string& device, Vec3d force, bool first);

}  // namespace trocar::devices
