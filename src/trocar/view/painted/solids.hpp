// What operating rooms and mechanisms are made of, as painted meshes: rods with round ends, boxes with broken edges,
// discs.
#pragma once

#include <trocar/geometry/figure/figure.hpp>
#include <trocar/numerics/mat3.hpp>
#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view::painted {

/// sRGB of a painted surface.
struct Colour {
  std::uint8_t r = 255, g = 255, b = 255, a = 255;
  Paint paint() const { return {r, g, b, a}; }
};
Colour darker(Colour c, double share);  ///< towards black
Colour mixed(Colour a, Colour b, double t);

inline constexpr Colour kEnamel{226, 229, 231}, kGunmetal{74, 80, 88}, kRubber{48, 52, 58}, kDrape{92, 152, 164},
    kGown{98, 158, 168}, kSkin{214, 166, 140}, kGlove{228, 222, 204}, kMask{196, 220, 226}, kTrousers{58, 84, 104},
    kSteel{170, 176, 182}, kAccent{232, 160, 64}, kCushion{52, 58, 66}, kFloor{150, 160, 166};

/// A rod with round ends of two sizes.
void add_rod(MeshBuffer& b, Vec3d from, Vec3d to, double radius_from, double radius_to, Colour colour, int sides = 28);
/// A cylinder with broken edges.
void add_cylinder(MeshBuffer& b, Vec3d from, Vec3d to, double radius, Colour colour, int sides = 36);
/// A box with broken edges. @param half of its edges
void add_box(MeshBuffer& b, Vec3d middle, const Mat3d& axes, Vec3d half, double bevel, Colour colour);
/// Rings of points, each around a middle: joined, closed at both ends.
void add_loft(MeshBuffer& b, const std::vector<std::vector<Vec3d>>& rings, const std::vector<Colour>& colours);

/// Two unit directions square to a unit axis and to each other.
std::pair<Vec3d, Vec3d> across(Vec3d axis);

}  // namespace trocar::view::painted
