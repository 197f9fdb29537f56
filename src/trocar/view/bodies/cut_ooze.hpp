// Blood that oozes from a cut organ, as drawn: a sheet over the cut's lower lip, and runs that start there and follow
// the skin down, unequal, some of them merging, and drip where it turns under (drawn only).
#pragma once

#include <span>
#include <vector>

#include <trocar/render/frame/liquid.hpp>

namespace trocar::view {

/// The skin around a cut.
struct CutSkin {
  std::span<const Vec3f> position, normal;  ///< (vertices), as drawn
  std::span<const std::uint32_t> rim;       ///< vertices along the cut's edge
  std::span<const Vec3f> outwards;          ///< (rim) along the skin away from the cut, unit; 0 where that is not known
  std::span<const std::uint32_t> around;    ///< ... and those as far as blood runs
};

inline constexpr float kOozeReach = 0.024f;  ///< [m] the longest run

/// Adds films to liquid.splats. @returns from where blood drips
std::vector<Vec3f> list_ooze(const CutSkin& skin, render::Liquid& liquid);

/// How much of the sheet lies on the skin, 0..1 (around).
/// @param rest  (vertices) [m]
std::vector<float> sheet_below(const CutSkin& skin, std::span<const Vec3f> rest, Vec3f down);

}  // namespace trocar::view
