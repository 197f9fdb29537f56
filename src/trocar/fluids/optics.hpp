// What colour a depth of blood, saline and bile has: absorption by the law of Beer and Lambert, and the light that red
// cells send back.
//
//   T = exp(-mu f l)                  transmitted, per channel; f = share of the fluid, l = path down and up
//   C = C_bed T + C_deep (1 - T)      seen from above; C_deep what a bottomless depth sends back
// mu of whole blood of 150 g/L haemoglobin is 2.303 eps 150 / 64500 with the tabulated eps of oxygenated and
// deoxygenated haemoglobin [Prahl 1999] at 630, 540 and 460 nm, arterial blood 98 % saturated, venous 70 %. A camera's
// red channel is broad and sees more light than 630 nm alone: 0.8 /mm (our choice). Bile: our choice, from its look.
// C_deep, linear (0.12, 0.006, 0.007): our choice, such that a pool under the endoscope's light is about (87, 15, 16)
// in sRGB, as pools in real pictures are.
//
//   const Rgb t = transmission(optics, {.blood = 0.05}, 0.010);    // 5 % blood in saline, 10 mm of light path
#pragma once

namespace trocar::fluids {

struct Rgb {
  double r = 0, g = 0, b = 0;  ///< linear
};

struct Optics {
  Rgb arterial{0.8e3, 28e3, 24e3};  ///< absorption of whole blood [1/m]
  Rgb venous{1.06e3, 27e3, 20e3};   ///< [1/m]
  Rgb saline{0, 0, 0};              ///< [1/m]
  Rgb bile{0.40e3, 0.62e3, 4.5e3};  ///< of a gallbladder's, golden in a film, olive in depth [1/m]; our choice
  Rgb deep_blood{0.12, 0.006, 0.007};
  Rgb deep_bile{0.115, 0.095, 0.006};
};

/// At one wavelength, as tabulated: the narrow figure for 630 nm, where the camera's channel is broad.
inline constexpr Rgb kArterialAt630And540And460{0.38e3, 28e3, 24e3};

/// Shares of the volume, 0 .. 1; what is left is saline.
struct Shares {
  double blood = 0, bile = 0;
  double saturation = 0.98;  ///< of the blood with oxygen: 0.98 arterial, 0.70 venous; between and beyond, linear
};

/// @param path  length of light's way through the fluid, down and up [m]
Rgb transmission(const Optics& optics, const Shares& shares, double path) noexcept;

/// What is seen of a bed (linear colour) under that much fluid.
Rgb seen_through(const Optics& optics, const Shares& shares, double path, Rgb bed) noexcept;

/// How bright shed blood is, against fresh: 1 until it clots, then down to 0.4 between 180 and 300 s (our choice of
/// a straight line between the two).  @param age since it left the vessel [s]
double clot_brightness(double age) noexcept;

}  // namespace trocar::fluids
