// Where the fonts of windows and legends are: beside the program (PREFIX/share/trocar/fonts), else where distributions
// put DejaVu.
#pragma once

#include <string>

namespace trocar::core {

/// @param name  "DejaVuSans.ttf"  @return a path; empty where there is no such font
std::string font_file(const std::string& name);

}  // namespace trocar::core
