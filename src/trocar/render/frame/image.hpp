// Pictures in memory and as PNG files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace trocar::render {

/// 8 bits a channel, R G B, rows from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  ///< (3 * width * height)

  const std::uint8_t* at(int x, int y) const { return rgb.data() + 3 * (std::size_t(y) * width + x); }
};

/// @throws core::EnvironmentLacks if the file cannot be written
void write_png(const std::string& path, const Image& image);
/// @throws core::BadInput if it is not a readable PNG
Image read_png(const std::string& path);

}  // namespace trocar::render
