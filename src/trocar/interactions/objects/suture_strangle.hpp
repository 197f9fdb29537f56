// What loops of slings do to strands that they lie around. A loop lies around a strand where the strand's middle line
// passes through the surface that the loop spans. It sinks in where it is drawn tight: for each piece of it the strand
// pushes back along its normal with
//
//   f = E R e / (1 - e / e_m) a length of thread,   e = depth / R, E the strand's modulus, R its radius
//
// which a loop of the radius r takes with the tension f r: a soft wall gives until it lies on itself (e_m), and then
// bears. Near a free end the surface that it is drawn into is steeper towards that end, by the angle whose tangent is
// (depth / R) exp(-2 d / R) at the distance d: what friction does not hold there slips off. All our estimates.
// docs/guides/endoloop.md.
//
//   strangle(...)           after rest_on_tissue(): bodies have not advanced
//   LoopClosure c = ...     what is left of a lumen
#pragma once

#include <trocar/interactions/objects/suture.hpp>

namespace trocar::interactions {

inline constexpr double kCrushed = 0.3;  ///< of the wall's thickness: as thin a loop crushes a strand.     [d]
inline constexpr double kSteepness = 2;  ///< of the slope towards a free end, a radius.                    [d]

/// Force a length of thread at a depth in a strand, and how it grows with that [N/m], [N/m^2].
struct StrangleLaw {
  double force = 0, slope = 0;
};
/// @param lumen  radius of the lumen [m]; 0: it is solid
StrangleLaw strangle_law(double youngs, double radius, double lumen, double depth) noexcept;
/// Tangent of the slope towards a free end that is `away` [m].
double slope_to_end(double radius, double depth, double away) noexcept;
/// The share of a lumen's width that a loop takes from it: 1 where it is drawn to the thickness of the wall.
/// @param inner  radius within the loop, drawn round [m]
double cover_of_loop(double radius, double lumen, double inner) noexcept;

double cover_of_loop(const BodyModels& models, const SlingAround& a) noexcept;

/// Is it drawn so close that it can be in its groove all around? A wide one that is pulled against one side is not.
inline bool has_sunk_in(const StrandBody& body, const SlingAround& a) noexcept {
  return a.radius < body.model.radius[std::size_t(a.at.element)];
}

double youngs_of(const StrandBody& body, int element) noexcept;
/// From a place of a strand along it to the next free end or cut, and which way that is: +1, -1, or 0 where there is
/// none [m].
struct FreeEnd {
  double away = 1e9;
  int side = 0;
};
FreeEnd free_end(const StrandBody& body, const tissue::StrandState& s, StrandPlace place) noexcept;

/// Which strands loops lie around, what they press on them in this tick, and what strands bear of the last one.
void strangle(const SutureModels& models, const Bodies& bodies, std::uint64_t tick, double dt, Suture::States& states,
              SutureWorks& work) noexcept;

}  // namespace trocar::interactions
