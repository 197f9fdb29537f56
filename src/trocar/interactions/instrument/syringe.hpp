// A syringe and its needle: what pressure a flow takes, and what a thumb on the plunger feels.
//
//   p = p_tip + R Q,  R = 128 mu L / (pi d^4)                                                  [Poiseuille]
//   F = p A                                                                                    [plunger]
//   Q = (p_tip - p_pore) / R_seep below the pressure at which a cavity opens; there, whatever comes
//   Q_in = (p_tip - p_open) / R_fill,  Q_back = (p_tip - p_open) C,  Q = Q_in + Q_back          [back flow]
//
// Below the opening pressure fluid seeps between cells, slowly; a thumb that wants more raises the pressure until a
// cavity opens. No more is needed until the tissue around it fills: then it resists, and beyond the opening pressure
// the hole around the needle gapes, so that more and more comes back along it. A hand has a flow in mind and a force
// that it does not exceed.
#pragma once

#include <trocar/core/fields.hpp>

namespace trocar::interactions {

/// Const.
struct NeedleModel {
  bool there = false;
  double length = 0.020;     ///< beyond the shaft's end when it is out [m]
  double radius = 0.00035;   ///< outer: 22 G [m]
  double bore = 0.00041;     ///< d, inner diameter [m]
  double plunger = 0.0145;   ///< diameter of the syringe's bore: 10 mL [m]
  double holds = 10e-6;      ///< in the syringe at the start [m^3]
  double flow = 10e-6 / 60;  ///< that a hand has in mind [m^3/s]
  double most_force = 40;    ///< of a thumb [N]
  double units = 0;          ///< of the drug in a millilitre [IU]; 0: saline, which blanches nothing

  double resistance(double viscosity) const noexcept;  ///< R [Pa s/m^3]
  double area() const noexcept;                        ///< A of the plunger [m^2]
  bool drugged() const noexcept { return units > 0; }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("length", s.length), v("radius", s.radius), v("bore", s.bore), v("plunger", s.plunger), v("holds", s.holds),
        v("flow", s.flow), v("most_force", s.most_force), v("units", s.units), v("there", s.there, core::kNotHashed);
  }
};

inline constexpr double kInjected = 0.7e-3;  ///< mu of saline at 37 C [Pa s]
inline constexpr double kDrawn = 3.5e-3;     ///< mu of blood [Pa s]
inline constexpr double kSeeps = 1e-6 / 60;  ///< that seeps away at the opening pressure [m^3/s].   Our choice
inline constexpr double kVacuum = 20e3;      ///< that a hand draws with [Pa].                       Our choice

/// What the tip is in.
struct AtTip {
  double pressure = 0;  ///< there, before anything flows [Pa]
  double opening = 0;   ///< of a cavity [Pa]; 0: it is open already: air, a vessel
  double fills = 0;     ///< R_fill of the tissue around the cavity [Pa s/m^3]
  double gapes = 0;     ///< C of the hole around the needle beyond the opening pressure [m^3/Pa s]
};

struct PlungerPush {
  double flow = 0;   ///< out of the needle [m^3/s]
  double tip = 0;    ///< pressure there [Pa]
  double force = 0;  ///< on the plunger [N]
  double back = 0;   ///< of the flow: comes back along the needle [m^3/s]
};
/// @param wanted  flow that the hand has in mind [m^3/s]
PlungerPush push_plunger(const NeedleModel& needle, const AtTip& at, double wanted) noexcept;

/// Blood drawn by a hand at kVacuum, of a vessel with that pressure.                                     [m^3/s]
double drawn_flow(const NeedleModel& needle, double pressure) noexcept;

}  // namespace trocar::interactions
