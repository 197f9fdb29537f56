// What a value looks like: points of value, colour and opacity, straight lines in between.
//
//   TransferFunction look = transfer_preset(TransferPreset::bone);
//   look.points[1].opacity = 0.3;
#pragma once

#include <array>
#include <string>
#include <vector>

namespace trocar::volumes {

struct TransferPoint {
  double value = 0;                ///< of the volume, as HU
  std::array<double, 3> colour{};  ///< red, green, blue, 0 .. 1
  double opacity = 0;              ///< 0 .. 1, of a layer of a millimetre
};

/// Before the first and behind the last point as there.
struct TransferFunction {
  std::vector<TransferPoint> points;  ///< ascending values
  TransferPoint at(double value) const;
};

enum class TransferPreset : unsigned char { bone, skin, vessels, soft_tissue };
/// For CT in Hounsfield units; vessels with contrast agent.
TransferFunction transfer_preset(TransferPreset preset);
/// From black and clear at one value to white and opaque at another: for MR and all that has no known unit.
TransferFunction grey_ramp(double from, double to);

}  // namespace trocar::volumes
