// Rods that touch: two thick segments that must not pass through each other, and a surface that must give way to one.
// Knows positions only.
//
//   Vec3f side{};                                     // kept from tick to tick
//   const RodContact c = touch(shaft, element, side);
//   if (c.depth > 0) push the second rod by c.depth along c.normal at c.t;
#pragma once

#include <trocar/numerics/vec3.hpp>

namespace trocar::collision {

struct Capsule {
  Vec3d a, b;
  double radius = 0;
};

/// The point of the capsule's axis nearest to p.
Vec3d nearest_on_axis(const Capsule& capsule, Vec3d p) noexcept;

/// The longest way that a point of the axis has gone in a straight line [m].
double way_of(const Capsule& from, const Capsule& to) noexcept;

/// Does the segment from->to pass within `radius` of the segment ab?
bool passes_within(Vec3d from, Vec3d to, Vec3d a, Vec3d b, double radius) noexcept;

struct RodContact {
  double s = 0, t = 0;        ///< places on the first and the second axis, 0..1
  Vec3d on_first, on_second;  ///< nearest points of the axes
  Vec3d normal{0, 0, 1};      ///< unit, from the first to the second
  double depth = 0;           ///< how far they overlap [m]; negative: apart
};

/// Distance within which `side` is kept beyond touching [m].
inline constexpr double kRemember = 0.002;
/// How far an axis may have gone beyond the other and still be brought back [m].
inline constexpr double kLost = 0.025;

/// Contact of two rods. `side` is the direction from the first to the second when they last were near, zero when they
/// were not: if the axes have crossed since, the contact still points to the old side and is as deep as it takes to go
/// back there, up to kLost; around a rod's end they part. So rods cannot pass through each other as long as they move
/// less than a radius sum plus kRemember between calls.
RodContact touch(const Capsule& first, const Capsule& second, Vec3f& side) noexcept;

/// The same for rods that have moved in straight lines, however far: they are looked at in as many places as it takes
/// to move less than that in between.
/// @param first0, second0  where they were
RodContact touch(const Capsule& first0, const Capsule& first, const Capsule& second0, const Capsule& second,
                 Vec3f& side) noexcept;

/// How a surface point p with outward normal n must move to give way to a rod; depth 0 where it need not.
struct Push {
  double depth = 0;
  Vec3d direction{0, 0, 0};
};
/// A point that finds itself in front of the rod's axis, seen from outside, is pushed inwards along its own normal,
/// down to `behind` below the axis: an instrument that is pushed in fast does not come out on the other side of the
/// skin.
Push push_out(const Capsule& rod, Vec3d p, Vec3d n, double behind) noexcept;

}  // namespace trocar::collision
