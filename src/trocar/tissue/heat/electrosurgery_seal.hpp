// Whether heat and pressure have sealed a vessel: fusing its walls takes temperature, time, and that they touch.
//
//   dS/dt = A exp(-Ea / R T) close        the tissue's damage rate (heat.hpp), counted while the lumen is shut
//   close = 1 up to the calibre that this pressing holds shut, none at 1.2 of it
//   quality = (1 - exp(-S / needed)) (1 - brittle char)
//   holds up to quality^2 x strongest [Pa]
// Calibres are those of practice: 1 mm for a bare electrode, 3 mm between bipolar jaws, 7 mm with a sealing forceps.
// `needed` 100 asks for 2 s at 80 C, a quarter of a second at 90 C: our choice, as are strength and brittleness.
#pragma once

#include <trocar/core/fields.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/tissue/heat/heat.hpp>

namespace trocar::tissue {

struct SealDescription {
  double bare = 1e-3;       ///< outer diameter that is shut without pressing [m]
  double pressed = 3e-3;    ///< when fully pressed [m]
  double needed = 100;      ///< S
  double brittle = 0.6;     ///< what char takes from the quality
  double strongest = 80e3;  ///< [Pa], 600 mmHg

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("bare", s.bare), v("pressed", s.pressed), v("needed", s.needed), v("brittle", s.brittle),
        v("strongest", s.strongest);
  }
};
inline SealDescription sealing_forceps() noexcept {
  SealDescription d;
  d.pressed = 7e-3;
  return d;
}

struct SealState {
  double damage = 0;  ///< S
  double char_ = 0;   ///< worst so far, 0 .. 1

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("damage", s.damage), v("char_", s.char_);
  }
};

struct SealInput {
  double diameter = 2e-3;          ///< outer [m]
  double compression = 0;          ///< 0 .. 1: jaws' force beside what shuts `pressed`
  double temperature = kBodyHeat;  ///< of the wall, along what is held [C]
  double char_ = 0;                ///< heat_look.hpp
};

/// Largest outer diameter that stays shut [m].
double sealing_calibre(const SealDescription& description, double compression) noexcept;
void seal(const HeatDescription& tissue, const SealDescription& description, const SealInput& input, double dt,
          SealState& state) noexcept;
double seal_quality(const SealDescription& description, const SealState& state) noexcept;    ///< 0 .. 1
double burst_pressure(const SealDescription& description, const SealState& state) noexcept;  ///< [Pa]

void add_to_hash(core::Hasher& hasher, const SealState& state) noexcept;

}  // namespace trocar::tissue
