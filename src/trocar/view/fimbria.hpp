// The open end of a uterine tube: its wall flares to a bell, whose inside narrows to the mouth, and from the bell's rim
// and inside grow many narrow fronds with frilled edges, in clumps. Each is a closed surface whose root is hidden in
// the bell's wall. Made in the frame of the tube's end, with which it moves rigidly.
#pragma once

#include <vector>

#include <trocar/view/mesh_buffer.hpp>

namespace trocar::view {

inline constexpr double kBellLength = 0.007;  ///< of tube that widens to its end [m]
inline constexpr double kBellFlare = 1.22;    ///< end's radius over the tube's
inline constexpr int kRimColumns = 48;        ///< vertices of the first ring, which the tube goes on to
inline constexpr int kFronds = 53;

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
