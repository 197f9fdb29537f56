// Which device a person names: simulated | haply[:PORT] | seam:PORT.
#pragma once

#include <memory>
#include <string>

#include <trocar/devices/haptics/device.hpp>

namespace trocar::devices {

inline constexpr char kHapticDevices[] = "simulated, haply[:PORT] or seam:PORT";

/// Not yet open. @param option  how the choice is called where it is refused  @throws core::BadInput
std::unique_ptr<HapticDevice> choose_haptic_device(const std::string& name, const std::string& option);

}  // namespace trocar::devices
