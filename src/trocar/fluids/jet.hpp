// Jets: how fast fluid leaves an opening, into what drops it breaks, what a valve lets through, how hard it pushes.
//
//   v = Q / A                        mean speed through an opening of area A
//   v = sqrt(2 dp / rho)             without resistance upstream [Torricelli 1643]
//   Q = Cd a sqrt(2 g h)             an orifice under a head h; Cd 1 for a rounded, 0.61 for a sharp one
//   drop = 1.89 jet diameters        [Rayleigh 1878]
//   F = rho Q v                      on what stops it
#pragma once

#include <cmath>

#include <trocar/core/fields.hpp>

namespace trocar::fluids {

inline constexpr double kSharpOrifice = 0.61;  ///< discharge coefficient Cd

inline double torricelli_speed(double pressure, double density) noexcept {  ///< [Pa], [kg/m^3] -> [m/s]
  return pressure > 0 && density > 0 ? std::sqrt(2 * pressure / density) : 0.0;
}
inline double orifice_flow(double area, double head, double gravity, double cd) noexcept {  ///< [m^3/s]
  return head > 0 && area > 0 ? cd * area * std::sqrt(2 * gravity * head) : 0.0;
}
inline double jet_force(double density, double flow, double speed) noexcept { return density * flow * speed; }  ///< [N]

/// What a hand-held suction-irrigator's lines can give (our choice within what makers state).
struct Lines {
  double irrigation_flow = 1.0e-3 / 60;  ///< irrigation valve wide open: 1 L/min [m^3/s]
  double bag_pressure = 40e3;            ///< 300 mmHg over the saline bag, at which that flow holds [Pa]
  double vacuum = 53.3e3;                ///< 400 mmHg below the room [Pa]
  double liquid_flow = 1.5e-3 / 60;      ///< sucked at that vacuum: 1.5 L/min of liquid [m^3/s]
  double gas_flow = 25e-3 / 60;          ///< or 25 L/min of gas [m^3/s]
  double nozzle_area = 7.07e-6;          ///< 3 mm bore [m^2]
  double capture_radius = 5e-3;          ///< [m]

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("irrigation_flow", s.irrigation_flow), v("bag_pressure", s.bag_pressure), v("vacuum", s.vacuum),
        v("liquid_flow", s.liquid_flow), v("gas_flow", s.gas_flow), v("nozzle_area", s.nozzle_area),
        v("capture_radius", s.capture_radius);
  }
};

/// Flow through a line whose resistance is that of turbulence, Q ~ sqrt(dp), with a valve that opens from 0 to 1.
inline double line_flow(double flow_at_reference, double pressure, double reference, double valve) noexcept {
  if (!(pressure > 0) || !(reference > 0) || !(valve > 0)) return 0;
  return flow_at_reference * std::sqrt(pressure / reference) * (valve < 1 ? valve : 1.0);
}

}  // namespace trocar::fluids
