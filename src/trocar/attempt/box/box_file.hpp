// The file that says how a box is wired and calibrated (JSON with comments, docs/guides/box.md):
//
//   {"format": 1, "baud": 38400, "rate_hz": 50, "protocol": "framed", "zero": "placed", "filter_hz": 5,
//    "hands": [{"hand": "left", "yaw": {"channel": 0, "deg": [[409, -60], [3686, 60]]}, ...
//               "depth": {"channel": 3, "mm": [[409, 0], [3686, 300]]},
//               "handle": {"channel": 4, "closed": [[409, 0], [3686, 1]]}, "next_instrument": 8}],
//    "scope": {...}, "pedals": {"coagulate": 0, ...}, "closed_is_low": []}
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <trocar/devices/box/wiring.hpp>
#include <trocar/scene/json/shape.hpp>

namespace trocar::attempt {

inline constexpr double kLeastBoxRate = 10, kMostBoxRate = 1000;  ///< [blocks/s]

/// What is wrong is appended to `faults`; what is right is taken all the same.
devices::BoxWiring read_box_file(const std::filesystem::path& file, std::vector<core::Fault>& faults,
                                 const scene::MemoryFiles* memory = nullptr);
/// The wiring that `file` says; without one, that of box.json in the data folder; without that, default_wiring().
/// @throws core::BadInput with every fault
devices::BoxWiring load_wiring(const std::string& file);
/// The file's text: what is read from it again is the same, but for the last bit of an angle.
std::string box_file_text(const devices::BoxWiring& wiring);

}  // namespace trocar::attempt
