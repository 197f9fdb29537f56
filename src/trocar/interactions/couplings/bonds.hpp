// Bonds: loose tissue between the wall of a pouch and what it lies on, or about lobules of fat, that parts when it is
// pulled apart: a gallbladder in its bed. Each couples two material points, by a cohesive law
// (tissue/failure/cohesive.hpp) in all directions alike: also pressed in and shifted along it resists, as what fills
// the gap does.
//
// A bond that is tougher than what it is rooted in parts that instead: torn off, it leaves the organ breached. Cut or
// burnt it still comes apart itself.
//
// The near point bears its bond implicitly, whatever its stiffness; the far one the force as it is when the tick
// begins, and a resistance to changes of its speed (coupled.hpp).
#pragma once

#include <span>
#include <string>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/bodies.hpp>
#include <trocar/interactions/bodies/material_point.hpp>
#include <trocar/tissue/failure/cohesive.hpp>

namespace trocar::interactions {

/// Const after compile.
struct Bond {
  MaterialPoint near;         ///< a node of a wall, or a lobule
  MaterialPoint far;          ///< what it is rooted in; never space
  double area = 0;            ///< that it stands for [m^2]
  std::int32_t vertex = -1;   ///< of an organ's skin, beside the far one; -1: that is no organ
  Vec3d drawn_pull{0, 0, 0};  ///< of the near on the far, in the drawn shape, which bears it already [N]

  std::int32_t node() const noexcept { return near.node[0]; }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("near", s.near), v("far", s.far), v("area", s.area), v("vertex", s.vertex), v("drawn_pull", s.drawn_pull);
  }
};

/// Bonds of one kind, with a name: "bed".
struct BondSet {
  std::string name;
  BodyId of;  ///< whose nodes they tie: a membrane, or fat
  tissue::CohesiveLaw law;
  std::vector<Bond> bonds;
  double oozes = 0;       ///< blood from what it was torn or cut off, until that is burnt [m/s: m^3/s a m^2]
  bool breaches = false;  ///< `law` is that of what they are rooted in: there it tears, not in the bond
  double bleeds = 0;      ///< as `oozes`, from where that has torn

  double area() const noexcept;  ///< of all [m^2]
  bool of_membrane() const noexcept { return of.is(BodyKind::membrane); }
  std::size_t membrane() const noexcept { return of.index(); }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("of", s.of), v("law", s.law), v("bonds", s.bonds), v("oozes", s.oozes),
        v("breaches", s.breaches, core::only_if(s.breaches)), v("bleeds", s.bleeds, core::only_if(s.breaches)),
        v("name", s.name, core::kNotHashed);
  }
};

/// What a bond has been through. It never heals.
struct BondState {
  enum Cause : std::int32_t { whole, pulled, cut, burnt, staunched /**< breached, and burnt since */ };
  float damage = 0;            ///< 0 .. 1
  std::int32_t cause = whole;  ///< of most of it

  bool holds() const noexcept { return damage < 1; }
  /// Is there an open surface where it was?
  bool raw() const noexcept { return !holds() && cause != burnt && cause != staunched; }

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("damage", s.damage), v("cause", s.cause);
  }
};

/// Where it is rooted: on the organ's skin, on the rod's axis, on the sheet [m].
Vec3d root_of(const Bodies& bodies, const Bond& bond) noexcept;
/// How far a bond is from where it was drawn [m].
Vec3d opening_of(const Bodies& bodies, const Bond& bond) noexcept;

/// What damage has come in the last tick, and the loads of the next on both ends.
/// @param states  (bonds)
void bond_loads(const Bodies& bodies, const BondSet& set, std::span<BondState> states, double dt) noexcept;

/// A bond of which the opening counts this many times as much: damage comes sooner, and as burnt.
void weaken(const BondSet& set, double opening, double times, double dt, BondState& state) noexcept;

/// Has what the bond is rooted in torn in its place?
bool breached(const BondSet& set, const BondState& state) noexcept;
/// Of what they are rooted in, all in all [m^2].
double breached_area(const BondSet& set, std::span<const BondState> states) noexcept;
/// A bond that had parted is at an electrode: the surface that it has left dries.
void staunch(const BondSet& set, BondState& state) noexcept;

/// What has been spent on parting them [J].
double energy_spent(const BondSet& set, std::span<const BondState> states) noexcept;

/// Share of the set's area that still holds, 0 .. 1.
double holding_share(const BondSet& set, std::span<const BondState> states) noexcept;

}  // namespace trocar::interactions
