// What a closed sheet encloses (bile, urine, gas) and the pressure with which it acts on the sheet from inside.
//
//   constant  p = p0: joined to something large that keeps its pressure
//   liquid    p = p0 + K (V0 - V) / V0: a volume that gives way by a bulk modulus; a large K holds it
//   gas       p = (p0 + pa) V0 / V - pa, with pa the pressure outside: Boyle's law
// p is over the surroundings, at the centre of the volume; where the contents are heavy it grows downwards by rho g h,
// so that all in all they press with their weight. Every triangle is pressed along its normal as it lies now (a
// follower load); a node's share is dV/dx, a third of the area vectors of its triangles, and the load has the potential
// -integral p dV.
//
// In time: the step's end decides. p is that of the volume which the step will end with, p itself included:
//   p = p(V') , V' = V + dt g . (v + dt M^-1 g p) + d,   g = dV/dx,
// with d what all else (the wall's stretch, contacts) changed the volume by in the step before. With p(V) linear around
// V this is one equation for one number, a rank-one stiffness inverted as in [Sherman & Morrison 50]; no bulk modulus,
// however large, asks for a shorter step, and at rest p is that of the law.
//
// Once its wall is cut or torn open, what is inside runs out by the hole's size (leak.hpp): the law continues with what
// is left. The inertia of what ran out stays on the wall.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <trocar/core/fields.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::tissue {

inline constexpr double kAtmosphere = 101325;  ///< [Pa]

struct Enclosure {
  enum Kind : std::int32_t { none, constant, liquid, gas } kind = none;
  double pressure = 0;  ///< p0 in the drawn shape, at the centre of the volume, over the surroundings [Pa]
  double bulk = 0;      ///< K of a liquid [Pa]
  double density = 0;   ///< of what is inside [kg/m^3]
  double volume = 0;    ///< V0 [m^3]; build() sets it

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("kind", s.kind), v("pressure", s.pressure, core::kWithNext), v("bulk", s.bulk, core::kWithNext),
        v("density", s.density, core::kWithNext), v("volume", s.volume);
  }
};

/// Part of a State.
struct EnclosureState {
  double pressure = 0;        ///< at the centre, of the last step [Pa]
  double volume = 0;          ///< where that step began [m^3]
  double expected = 0;        ///< at that step's end, were there nothing but the pressure and what moves on [m^3]
  double left = 1;            ///< share of V0 that has not run out
  std::uint32_t leaking = 0;  ///< 1: the wall is open
  std::uint32_t unused = 0;   ///< keeps the hash free of padding

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("pressure", s.pressure), v("volume", s.volume), v("expected", s.expected), v("left", s.left),
        v("leaking", s.leaking), v("unused", s.unused);
  }
};

struct PressureLaw {
  double pressure = 0;  ///< p [Pa]
  double fall = 0;      ///< -dp/dV [Pa/m^3] >= 0
};
/// At the volume V; volumes below a twentieth of V0 count as that.
/// @param left  share of V0 that is still inside
PressureLaw pressure_at(const Enclosure& enclosure, double volume, double left = 1) noexcept;
/// -integral of p dV from V0 to V [J].
double pressure_energy(const Enclosure& enclosure, double volume) noexcept;

/// Volume, its centre and its gradient.
struct EnclosedVolume {
  double volume = 0;
  Vec3d centre{0, 0, 0};
};
/// @param x         (n) positions [m]
/// @param gradient  (n) dV/dx [m^2], or empty
/// @param heavy     density times gravity of what is inside [N/m^3]
/// @param weight    (n) how it presses on the nodes [N], or empty: on each triangle with the depth of its middle below
///                  the volume's centre; all of it together is the weight of what the volume would hold
EnclosedVolume enclosed_volume(std::span<const std::array<int, 3>> triangles, std::span<const Vec3d> x,
                               std::span<Vec3d> gradient, Vec3d heavy = {}, std::span<Vec3d> weight = {}) noexcept;

/// Makes state.pressure that of the step's end, and notes the volume for the next step.
/// @param rate  g . v with all other impulses of the step's beginning in v [m^3/s]
/// @param give  g . M^-1 g over free nodes [m^4/kg]
void press_step(const Enclosure& enclosure, double volume, double rate, double give, double dt,
                EnclosureState& state) noexcept;

void add_to_hash(core::Hasher& hasher, const Enclosure& enclosure) noexcept;

}  // namespace trocar::tissue
