// What unit a surface's coordinates may be in. Files of most formats do not say; a program that asks a person shows
// what the extent suggests.
//
//   const UnitGuess guess = guess_unit(bounds(mesh.positions));
//   ask(guess.words);      // "longest side 380.5: 38.1 cm in millimetres, 3.81 m in centimetres, 381 m in metres"
//
// Organs and instruments are some millimetres to half a metre long, and few programs write centimetres: that is all
// there is to it.
#pragma once

#include <string>
#include <vector>

#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry {

struct UnitGuess {
  /// Metres in the most likely of the units 1, 0.01 and 0.001; 0 where none makes an organ or instrument of it.
  double metres = 0;
  /// The other units in which it would be one, too: 15 may be centimetres or millimetres.
  std::vector<double> also;
  std::string words;
};
inline constexpr double kShortestBody = 0.004, kLongestBody = 0.8;  ///< [m] what counts as an organ or instrument
inline constexpr double kUsualBody = 0.1;                           ///< [m] nearest to this is likeliest
inline constexpr double kSeldom = 4;  ///< so many times nearer it has to be in centimetres

UnitGuess guess_unit(const Bounds& box);

}  // namespace trocar::geometry
