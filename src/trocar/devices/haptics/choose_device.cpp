#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/devices/haptics/choose_device.hpp>
#include <trocar/devices/haptics/haply_device.hpp>
#include <trocar/devices/haptics/seam_device.hpp>
#include <trocar/devices/haptics/simulated_device.hpp>

namespace trocar::devices {
namespace {

constexpr int kLargestPort = 65535;

/// 1..65535, or 0 where it is none.
int port_of(const std::string& digits) {
  int port = 0;
  for (const char c : digits) {
    if (c < '0' || c > '9') return 0;
    port = 10 * port + (c - '0');
    if (port > kLargestPort) return 0;
  }
  return port;
}

}  // namespace

std::unique_ptr<HapticDevice> choose_haptic_device(const std::string& name, const std::string& option) {
  const std::size_t colon = name.find(':');
  const std::string kind = name.substr(0, colon);
  const int port = colon == std::string::npos ? 0 : port_of(name.substr(colon + 1));
  if (name == "simulated") return std::make_unique<SimulatedDevice>();
  if (name == "haply") return std::make_unique<HaplyDevice>();
  if (kind == "haply" && port > 0) return std::make_unique<HaplyDevice>(port);
  if (kind == "seam" && port > 0) return std::make_unique<SeamDevice>(port);
  throw core::BadInput({{{option, 0, 0}, tr("expected {}, got '{}'", kHapticDevices, name)}});
}

}  // namespace trocar::devices
