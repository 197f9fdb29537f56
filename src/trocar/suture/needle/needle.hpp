// A needle: a steel wire bent to a part of a circle, rigid, with its middle line measured by arc length from the tip.
//
//   const NeedleModel m = make_needle(*needle_kind("half_26"));
//   const Vec3d tip = place_of(s, m.place(0)), drives = rotate(s.q, m.along(0));
//
// In its own frame the centre of mass is at 0, the bend lies in the plane z = 0, symmetric about x, and a turn about +z
// through the bend's middle drives it along itself, tip first.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/numerics/quat.hpp>
#include <trocar/suture/needle/kinds.hpp>

namespace trocar::suture {

inline constexpr int kMostBeads = 64;  ///< places of a needle that are looked at for contacts

struct NeedleModel {
  double length = 0, turn = 0, wire = 0;  ///< [m], [rad], [m]
  double radius = 0;                      ///< of the bend [m]; 0: straight
  double mass = 0;                        ///< [kg]
  Mat3d inertia{};                        ///< about the centre of mass, own frame [kg m^2]
  Vec3d centre{0, 0, 0};                  ///< of the bend [m]
  std::int32_t beads = 0;                 ///< evenly from the tip (0) to the swage

  bool straight() const noexcept { return radius <= 0; }
  /// Of the middle line, own frame [m].
  /// @param s  from the tip [m]; outside 0 .. length the circle continues
  Vec3d place(double s) const noexcept;
  /// Unit, towards the tip: the way it is driven.
  Vec3d along(double s) const noexcept;
  /// Where the middle line comes nearest to a point of its own frame; below 0 before the tip, above `length` behind the
  /// swage.
  double nearest(Vec3d own) const noexcept;
  double bead(int i) const noexcept { return length * i / (beads - 1); }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("length", s.length), v("turn", s.turn), v("wire", s.wire), v("radius", s.radius), v("mass", s.mass),
        v("inertia", s.inertia), v("centre", s.centre), v("beads", s.beads);
  }
};

NeedleModel make_needle(const NeedleKind& kind);

/// No padding.
struct NeedleState {
  Vec3d x;                               ///< centre of mass [m]
  Quatd q;                               ///< own axes -> the scene's
  Vec3d v, w;                            ///< [m/s], [rad/s] about the scene's axes
  std::array<Vec3d, kMostBeads> slid{};  ///< of each bead: by how much friction holds it strained [m]

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("x", s.x), v("q", s.q), v("v", s.v), v("w", s.w), v("slid", s.slid);
  }
};
static_assert(sizeof(NeedleState) == (13 + 3 * kMostBeads) * sizeof(double), "no padding");

inline Vec3d place_of(const NeedleState& s, Vec3d own) noexcept { return s.x + rotate(s.q, own); }
inline Vec3d own_of(const NeedleState& s, Vec3d place) noexcept { return rotate(conjugate(s.q), place - s.x); }
inline Vec3d speed_of(const NeedleState& s, Vec3d arm) noexcept { return s.v + cross(s.w, arm); }
/// Of the middle line, in the scene.
inline Vec3d needle_point(const NeedleModel& m, const NeedleState& s, double arc) noexcept {
  return place_of(s, m.place(arc));
}
inline Vec3d needle_direction(const NeedleModel& m, const NeedleState& s, double arc) noexcept {
  return rotate(s.q, m.along(arc));
}

}  // namespace trocar::suture
