// A needle's way into an organ: its point catches in the skin and dents it until that gives way at the tissue's
// puncture force; from then on that place of the skin sits on the needle. It is carried aside with it, and along with
// it as far as friction bears.
//
//   F = k sunk < g F_puncture        before; k 1000 N/m, our choice: how far the skin gives before it is pierced is its
//                                    own. g 0.35: a ground bevel cuts where a taper point has to stretch
//   |F along| <= drag * depth        after                                                         drag 0.05 N/mm
//
// What a point bears on is carried by the skin around it, a bell of 6 mm: a lattice's cells are wider than a point, and
// a single node gives way where tissue does not. The needle itself has no other contact: between skin and point tissue
// takes it along at the skin alone.
#pragma once

#include <array>
#include <cstdint>

#include <trocar/interactions/bodies/bodies.hpp>
#include <trocar/interactions/bodies/material_point.hpp>
#include <trocar/interactions/contact/nearest_skin.hpp>
#include <trocar/interactions/instrument/tool.hpp>

namespace trocar::interactions {

inline constexpr double kPointStiffness = 1000;  ///< [N/m]
inline constexpr double kGroundBevel =
    0.35;  ///< g, of what a tissue's `puncture_N` is for a suture's needle. Our choice
inline constexpr double kCarriedOver = 0.006;   ///< [m] of skin about the point that carries it.          Our choice
inline constexpr double kShaftStiffness = 600;  ///< [N/m] of the skin on the needle.                       Our choice
inline constexpr double kNeedleDrag = 50;       ///< [N/m] that a length in the tissue bears
inline constexpr double kPointFound = 0.008;    ///< [m] how far a point looks for a skin
inline constexpr double kTornOut = 0.015;       ///< [m] the skin's point off the needle: it has come out

/// Where a needle is in space.
struct NeedleLine {
  Vec3d base, point, axis;  ///< the shaft's end; [m]; unit, towards the point
  double out = 0;           ///< length beyond the shaft [m]
};
NeedleLine needle_of(const ToolModel& tool, const ToolShape& shape) noexcept;

/// The skin's place that is nearest to a point of it, and how the skin lies there.
SkinPoint skin_at(const Bodies& bodies, const MaterialPoint& point) noexcept;

/// Where the needle's point is below a skin that it has not pierced; of space: nowhere.
MaterialPoint caught_at(const Bodies& bodies, std::size_t organ, const NeedleLine& needle) noexcept;
/// How far the needle's point is beyond the point of the skin that it has caught, along the needle [m]; 0: it has let
/// go of it.
double sunk_into(const Bodies& bodies, const MaterialPoint& point, const NeedleLine& needle) noexcept;
/// Takes the caught skin along with the point. @return the force along the needle [N]
double press_skin(const Bodies& bodies, const MaterialPoint& point, const NeedleLine& needle,
                  std::int32_t hand) noexcept;

/// Carries the pierced skin. @param anchor  in/out: depth at which it sticks to the needle [m]
void carry_skin(const Bodies& bodies, const MaterialPoint& point, const NeedleLine& needle, double& anchor,
                std::int32_t hand) noexcept;

/// How deep a place is below the nearest point of the skin [m]; negative above it.
double depth_below(const Surface& surface, Vec3d place) noexcept;

}  // namespace trocar::interactions
