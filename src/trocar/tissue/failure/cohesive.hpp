// How much a bond between two surfaces still holds after it has been opened: a cohesive law of two straight lines.
//
//   traction  rises to `peak` at the opening `yields`, falls from there to nothing at `opens`; the area below is the
//             toughness: what it takes to part a square metre  [Dugdale 60, Barenblatt 62; the triangle is the usual
//             choice]
//   damage    0 .. 1: by how much the slope from the origin has fallen. It only grows, so that what has been opened and
//             is pressed together again holds no more than it did. The opening that it stands for grows by `pace` at
//             most (our estimate): a sudden pull stretches tissue for a moment and does not burst a whole seam at once
//
//   law = CohesiveLaw::of(50, 0.005);                        // 50 J/m^2, gone at 5 mm
//   damage = damage_after(law, damage, opening, dt);
//   force = (1 - damage) * law.stiffness() * area * opening;
#pragma once

#include <algorithm>

namespace trocar::tissue {

struct CohesiveLaw {
  double peak = 0;    ///< [Pa]
  double yields = 0;  ///< opening at which it is reached [m]
  double opens = 0;   ///< opening at which nothing holds [m]
  double pace = 0;    ///< at most that fast [m/s]

  static constexpr double kYieldsAt = 0.2;  ///< of `opens`; our estimate
  static constexpr double kQuickest = 0.2;  ///< until nothing holds, however it is pulled [s]; our estimate

  /// @param toughness [J/m^2]  @param opens [m]
  static CohesiveLaw of(double toughness, double opens) noexcept {
    return {2 * toughness / opens, kYieldsAt * opens, opens, opens / kQuickest};
  }
  double toughness() const noexcept { return 0.5 * peak * opens; }  ///< [J/m^2]
  double stiffness() const noexcept { return peak / yields; }       ///< while it is whole [Pa/m]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("peak", s.peak), v("yields", s.yields), v("opens", s.opens), v("pace", s.pace);
  }
};

/// Of a bond that has slowly been opened that far.
inline double damage_at(const CohesiveLaw& law, double opening) noexcept {
  if (opening <= law.yields) return 0;
  if (opening >= law.opens) return 1;
  return law.opens * (opening - law.yields) / (opening * (law.opens - law.yields));
}

/// The opening that has done that damage [m].
inline double opening_of(const CohesiveLaw& law, double damage) noexcept {
  return law.opens * law.yields / (law.opens - damage * (law.opens - law.yields));
}

/// After a further `dt` [s] at that opening.
inline double damage_after(const CohesiveLaw& law, double before, double opening, double dt) noexcept {
  return std::max(before, damage_at(law, std::min(opening, opening_of(law, before) + law.pace * dt)));
}

/// What the damage has taken, of a square metre [J/m^2]: the area below the curve up to where it came, without what
/// comes back when the bond is let go.
inline double spent(const CohesiveLaw& law, double damage) noexcept {
  return 0.5 * law.peak * damage * opening_of(law, damage);
}

}  // namespace trocar::tissue
