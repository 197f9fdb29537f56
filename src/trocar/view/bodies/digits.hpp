// Digits as strokes, for what is written on marks.
#pragma once

#include <string>

namespace trocar::view {

/// How much ink is at (x, y), 0..1. The text stands around the origin, one unit high, y upwards; other characters than
/// digits leave a gap.
/// @param soft  width of a stroke's border, in the same unit
double ink_at(const std::string& digits, double x, double y, double soft);

}  // namespace trocar::view
