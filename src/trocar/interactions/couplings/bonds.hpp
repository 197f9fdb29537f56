// Bonds: loose tissue between the wall of a pouch and what it lies on, that parts when it is pulled apart: a
// gallbladder in its bed. Each ties a node of the wall to a place on an organ or a strand, by a cohesive law
// (tissue/failure/cohesive.hpp) in all directions alike: also pressed in and shifted along it resists, as what fills
// the gap does.
//
// A bond that is tougher than what it is rooted in parts that instead: torn off, it leaves the organ breached. Cut or
// burnt it still comes apart itself.
//
// The node bears its bond implicitly, whatever its stiffness; the holder the force as it is when the tick begins, and a
// resistance to changes of its speed. A light node is each time where its holder was about to be a tick before; with
// that, a holder of mass m that resists with r dt is stable from m + r dt >= k dt^2 + 2 d dt on, so r = k dt + 2 d
// holds the lightest.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/bodies.hpp>
#include <trocar/tissue/failure/cohesive.hpp>

namespace trocar::interactions {

/// Const after compile.
struct Bond {
  std::int32_t node = -1;  ///< of the wall
  BorderHold hold;         ///< never space; drawn_pull: the wall's on the bond, in the drawn shape
  double area = 0;         ///< that it stands for [m^2]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("node", s.node), v("hold", s.hold), v("area", s.area);
  }
};

/// Bonds of one kind, with a name: "bed".
struct BondSet {
  std::string name;
  std::int32_t membrane = -1;  ///< whose nodes; -1: not a membrane's
  tissue::CohesiveLaw law;
  std::vector<Bond> bonds;
  double oozes = 0;       ///< blood from what it was torn or cut off, until that is burnt [m/s: m^3/s a m^2]
  bool breaches = false;  ///< `law` is that of what they are rooted in: there it tears, not in the bond
  double bleeds = 0;      ///< as `oozes`, from where that has torn

  double area() const noexcept;  ///< of all [m^2]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("membrane", s.membrane), v("law", s.law), v("bonds", s.bonds), v("oozes", s.oozes),
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

/// What a set of bonds ties: nodes of a wall, or lobules of fat.
struct BondedNodes {
  const tissue::NetworkModel& model;
  const tissue::NetworkState& state;
  NetworkLoads& loads;
};

/// How far a bond is from where it was drawn [m].
Vec3d opening_of(const Bond& bond, const BondedNodes& nodes, const Bodies& bodies) noexcept;

/// What damage has come in the last tick, and the loads of the next on wall and holders.
/// @param states  (bonds)
void bond_loads(const BondSet& set, std::span<BondState> states, const BondedNodes& nodes, const Bodies& bodies,
                double dt) noexcept;

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

void add_to_hash(core::Hasher& hasher, const BondSet& set) noexcept;

}  // namespace trocar::interactions
