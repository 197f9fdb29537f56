// The gas that holds the abdomen open. An insufflator gives what it can towards its set pressure; who sucks gas takes
// it away, and what the wall gives way for a pressure says how far that falls:
//   C dp/dt = q - sucked,  q = flow (set - p) / band between 0 and flow
// So a sucker that draws more than the insufflator gives empties the abdomen, and what the pressure held shut (veins)
// bleeds more. The wall does not come nearer in the picture.
//
//   CavityGas gas = full(insufflator);
//   advance(insufflator, sucked, 1e-3, gas);
#pragma once

#include <trocar/core/fields.hpp>

namespace trocar::fluids {

struct Insufflator {
  double set = 12 * 133.322;             ///< 12 mmHg over the air outside [Pa]
  double flow = 20e-3 / 60;              ///< at most; 20 L/min as of a usual one [m^3/s]
  double band = 3 * 133.322;             ///< it gives all of it from this far below the set pressure: our choice [Pa]
  double compliance = 0.3e-3 / 133.322;  ///< C, 0.3 L/mmHg: our choice for a relaxed wall [m^3/Pa]

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("set", s.set), v("flow", s.flow), v("band", s.band), v("compliance", s.compliance);
  }
};
struct CavityGas {
  double pressure = 0;  ///< [Pa]
  double flow = 0;      ///< q of the last tick [m^3/s]

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("pressure", s.pressure), v("flow", s.flow);
  }
};

CavityGas full(const Insufflator& insufflator) noexcept;
/// One tick. @param sucked  [m^3/s]; @param dt  [s]
void advance(const Insufflator& insufflator, double sucked, double dt, CavityGas& gas) noexcept;

}  // namespace trocar::fluids
