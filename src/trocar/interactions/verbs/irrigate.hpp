// The suction-irrigator at tissue: where its bore ends and what lies on it, and the push of the drops that land.
//
//   const Bore bore = bore_of(tool, shape, before, tick);
//   valve.blocked = covered(bodies, bore.end, kPlugs);                  // tissue plugs a port that it is so near to
//   const MaterialPoint hit = film_point(bodies, first, order, impact.body, impact.film);   // in the next tick
//
// Drops move when tissue has moved: what they push, it feels in the next tick (sim::State::impacts).
#pragma once

#include <trocar/interactions/bodies/bodies.hpp>
#include <trocar/interactions/bodies/material_point.hpp>
#include <trocar/interactions/instrument/tool.hpp>
#include <trocar/interactions/wetting/fluid_contact.hpp>

namespace trocar::interactions {

/// [m] tissue nearer than that to a port of suction plugs it.                                              Our choice
inline constexpr double kPlugs = 0.001;

/// One bore for both ways, out of the end of a blunt tube.
struct Bore {
  Vec3d end, axis, velocity;  ///< of the tube's round end, where tissue meets it [m]; unit, out of the bore; [m/s]
};
Bore bore_of(const ToolModel& tool, const ToolShape& now, const ToolShape& before, double dt) noexcept;

/// The tube as a body of the fluids: one capsule that ends where its bore does, so that no drop is born inside.
fluids::Capsule tube_of(const ToolModel& tool, const ToolShape& now, const ToolShape& before, double dt) noexcept;

/// The point of a body that a place of film is; of space for walls, and where there is no such place.
/// @param first  film_places(...)
/// @param body   as fluids number them (wet_order.hpp)
MaterialPoint film_point(const Bodies& bodies, std::span<const std::int32_t> first, const WetOrder& order,
                         std::int32_t body, std::int32_t place) noexcept;

}  // namespace trocar::interactions
