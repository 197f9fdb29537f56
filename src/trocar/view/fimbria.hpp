// The open end of a uterine tube: a trumpet whose rim frays into whorls of soft fingers, curled and lobed, the inner
// ones springing from inside. Made in the frame of the tube's end, with which it moves rigidly.
#pragma once

#include <vector>

#include <trocar/view/mesh_buffer.hpp>

namespace trocar::view {

inline constexpr double kBellLength = 0.008;  ///< of tube that widens to the rim [m]
inline constexpr double kBellFlare = 1.85;    ///< rim's radius over the tube's
inline constexpr int kRimLobes = 17;

/// Fingers around a rim of `radius` [m]. Coordinates: x along the tube's direction from the rim's centre, y and z
/// along the end frame's normal and binormal. @param seed each tube's own shape
MeshBuffer fimbriae(double radius, int seed);

/// Radius over the tube's own, `before` the rim [m].
double bell_flare(double before);

/// The inside of the trumpet, from the rim to its mouth.
struct FunnelRow {
  double along, radius;  ///< in rim radii
  double openness;
};
const std::vector<FunnelRow>& funnel();

}  // namespace trocar::view
