// The open end of a uterine tube: its wall flares to a bell, the bell's rim parts into soft leaves with frilled edges,
// and the folds of their inner side run down the funnel to a narrow mouth. One closed surface from the outside over the
// leaves' edges to the mouth. Made in the frame of the tube's end, with which it moves rigidly.
#pragma once

#include <vector>

#include <trocar/view/mesh_buffer.hpp>

namespace trocar::view {

inline constexpr double kBellLength = 0.007;                ///< of tube that widens to its end [m]
inline constexpr double kBellFlare = 1.22;                  ///< end's radius over the tube's
inline constexpr int kLeaves = 24;                          ///< of the rim
inline constexpr int kLeafColumns = 6;                      ///< across a leaf
inline constexpr int kRimColumns = kLeaves * kLeafColumns;  ///< vertices of the first ring, which the tube goes on to

/// Coordinates: x along the tube's direction from its end's centre, y and z along the end frame's normal and binormal.
struct FimbriaSite {
  double radius = 0;          ///< of the tube's end [m]
  int seed = 0;               ///< each tube's own shape
  Vec3d down;                 ///< unit: the leaves hang a little
  bool ovary = false;         ///< there is one near: the longest leaf lies on it, its neighbours reach for it
  Vec3d land, slide, normal;  ///< where on it [m], which way onwards on it, and out of it (unit)
};

/// The first kRimColumns vertices are a ring around the tube's end, counter-clockwise seen from beyond it, the first at
/// the end frame's normal.
MeshBuffer fimbriae(const FimbriaSite& site);

/// Radius over the tube's own, `before` its end [m].
double bell_flare(double before);

}  // namespace trocar::view
