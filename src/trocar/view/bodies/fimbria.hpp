// The open end of a uterine tube: its wall flares to a bell, whose inside narrows to the mouth. Its rim runs out into
// tapering fronds with frilled edges, in clumps: one surface with the bell, whose folds they continue from. Within
// stand more of them, closed surfaces that rise out of its inner side. Made in the frame of the tube's end, with which
// it moves rigidly.
#pragma once

#include <vector>

#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

inline constexpr double kBellLength = 0.007;  ///< of tube that widens to its end [m]
inline constexpr double kBellFlare = 1.22;    ///< end's radius over the tube's
inline constexpr int kRimColumns = 96;        ///< vertices of the first ring, which the tube continues to
inline constexpr int kRimFronds = 24;         ///< that the rim runs out into
inline constexpr int kFoldFronds = 25;        ///< that stand within

/// Coordinates: x along the tube's direction from its end's centre, y and z along the end frame's normal and binormal.
struct FimbriaSite {
  double radius = 0;          ///< of the tube's end [m]
  int seed = 0;               ///< each tube's own shape
  Vec3d down;                 ///< unit: the fronds hang
  bool ovary = false;         ///< there is one near: one frond lies on it, its neighbours reach for it
  Vec3d land, slide, normal;  ///< where on it [m], which way onwards on it, and out of it (unit)
};

/// The first kRimColumns vertices are a ring around the tube's end, counter-clockwise seen from beyond it, the first at
/// the end frame's normal.
MeshBuffer fimbriae(const FimbriaSite& site);

/// Radius over the tube's own, `before` its end [m].
double bell_flare(double before);

}  // namespace trocar::view
