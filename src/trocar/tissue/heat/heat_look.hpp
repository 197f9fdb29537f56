// What heat has made of tissue: colour, stiffness, shrinkage, steam, from a reading at a material point (heat.hpp), so
// that skins and nodes can be coloured and stiffened. Steps follow the states of heated tissue:
//   50-60 C   denaturation: pallor, shrinks by a tenth       (by damage, so by time as well as temperature)
//   80-95 C   desiccation: tan, steam                        (by the highest temperature, or by lost water)
//   100 C     boils until dry: shrinks by another tenth      (by lost water)
//   150-200 C carbonisation: brown, then black, sticks       (by the highest temperature)
// Colours are sRGB; where one begins and the other ends, and the stiffnesses, are our choice.
#pragma once

#include <trocar/numerics/vec3.hpp>
#include <trocar/tissue/heat/heat.hpp>

namespace trocar::tissue {

struct HeatLook {
  float pale = 0;   ///< coagulated
  float tan = 0;    ///< desiccated
  float char_ = 0;  ///< carbonised: 0.5 brown, 1 black
  float steam = 0;  ///< 0 .. 1, wisps from 80 C on while there is water
};
HeatLook look(const HeatReading& reading) noexcept;

/// sRGB 0 .. 1 of tissue whose own colour is `natural`.
Vec3f colour(const HeatLook& look, Vec3f natural) noexcept;

/// Factor on a modulus: 1 as it was, 4 coagulated, 10 dry.
float stiffness(const HeatReading& reading) noexcept;
/// Factor on a length: 1 as it was, 0.9 coagulated, 0.8 dry.
float shrinkage(const HeatReading& reading) noexcept;

}  // namespace trocar::tissue
