// A point of tissue, of whatever kind of body, at its surface or deep in it: where it is now, how fast it goes, and
// what presses on it. What a needle has pierced and a thread goes through is tied to such points.
//
//   TissuePoint p = stick_to(bodies, BodyId::organ(2), place);   // when it is pierced
//   ... point_of(bodies, p) ...
//   press_on(bodies, p, force, stiffness * tick, loads);
#pragma once

#include <array>
#include <span>

#include <trocar/interactions/bodies/bodies.hpp>

namespace trocar::interactions {

inline constexpr int kPointNodes = 8;

/// Of an organ or a fold: nodes with weights that add up to 1 and give the place for every affine motion of them; of a
/// strand: an element, a place in it and an offset in its frame. No padding.
struct TissuePoint {
  BodyId body;
  std::int32_t count = 0;
  std::array<std::int32_t, kPointNodes> node{};
  std::array<float, kPointNodes> weight{};
  std::array<float, 3> offset{};  ///< from there [m]; of a strand along its tangent, normal and binormal

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("body", s.body), v("count", s.count), v("node", s.node), v("weight", s.weight), v("offset", s.offset);
  }
};
static_assert(sizeof(TissuePoint) == 4 * (2 + 2 * kPointNodes + 3), "no padding");

/// The point of that body that is at p now; it looks at all of the body's nodes.
TissuePoint stick_to(const Bodies& bodies, BodyId body, Vec3d p) noexcept;
Vec3d point_of(const Bodies& bodies, const TissuePoint& point) noexcept;
Vec3d velocity_of(const Bodies& bodies, const TissuePoint& point) noexcept;
/// Where it was when the scene was drawn.
/// @param rest  of the body's nodes [m]
Vec3d drawn_place(std::span<const Vec3d> rest, const TissuePoint& point) noexcept;

/// @param resists  to changes of its velocity: stiffness of what presses times the tick [N s/m]
/// @param damps    to moving beside what presses, which goes with `velocity` [N s/m]
void press_on(const Bodies& bodies, const TissuePoint& point, Vec3d force, double resists, double damps,
              Vec3d velocity) noexcept;

}  // namespace trocar::interactions
