// What runs out of a closed sheet whose wall is open, by the hole's size.
//
//   Q = c A sqrt(2 p / rho)    [Torricelli 1643], c = 0.61: a jet through a sharp edge contracts
//
// p is the pressure at the hole: that of what is enclosed, and more below its centre. A, of the hole, is what the torn
// triangles have grown beyond their drawn areas: lips that part open it, lips that are pressed together nearly close
// it. Spilled contents are no longer in the enclosure's law, so the wall slackens. Where it encloses more than is left,
// gas has come in from outside: there is no pressure but that of the height of the liquid over the hole, as in a vessel
// with upright walls, and the rest drips, or is pressed out by a squeeze.
#pragma once

#include <cstdint>
#include <span>

#include <trocar/tissue/membrane/membrane.hpp>

namespace trocar::tissue {

/// Of one tick.
struct Leak {
  double area = 0;              ///< of the hole [m^2]; 0: the wall is whole
  Vec3d place;                  ///< its middle [m]
  Vec3d direction{0, 0, 1};     ///< out of it, unit
  std::int64_t picolitres = 0;  ///< that ran out
};

/// Takes what runs out in one tick from the enclosure. After advance().
/// @param parted (triangles) 1 = cut open
Leak leak(const MembraneModel& model, std::span<const std::uint8_t> parted, const MembraneWork& work,
          MembraneState& state) noexcept;
/// The same through an opening that is not in the wall: the lumen of a tube that leads out of it and is open.
/// @param area       of the lumen [m^2]
/// @param place      of the tube's open end: the pressure is that of its height [m]
/// @param direction  out of it, unit
Leak leak_through(const MembraneModel& model, double area, Vec3d place, Vec3d direction, const MembraneWork& work,
                  MembraneState& state) noexcept;

/// Takes `volume` [m^3] of what is inside away, as a stone does that falls out.
void take_out(const MembraneModel& model, double volume, MembraneState& state) noexcept;

}  // namespace trocar::tissue
