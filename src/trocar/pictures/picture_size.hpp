// --size: of pictures and windows.
#pragma once

#include <string>

namespace trocar::pictures {

struct PictureSize {
  int width = 800, height = 600;  ///< [px]
};

/// "800x600", each 64 .. 8192.  @throws core::BadInput
PictureSize parse_size(const std::string& text);

}  // namespace trocar::pictures
