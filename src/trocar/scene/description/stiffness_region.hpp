// Tissue that is stiffer or softer in places than its table says: dabs of a brush, in order.
//
//   for (SpringDescription& s : springs) s.k *= stiffness_at(solid.regions, middle_of(s));
#pragma once

#include <span>

#include <trocar/core/error.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::scene {

/// One dab: whole within half of its radius, nothing beyond it.
struct StiffnessRegion {
  Vec3d centre;
  double radius = 0;     ///< [m]
  double stiffness = 1;  ///< times the tissue's; 1 takes away what was painted before
  core::Location at;
};

/// Share of a dab that counts at a place: 1 within half of its radius, falling as a smooth step to 0 at the radius.
double weight_at(const StiffnessRegion& region, Vec3d place) noexcept;
/// Times the tissue's: from 1 on each dab draws the factor's logarithm towards its own, by its weight. Exactly 1 where
/// none reaches.
double stiffness_at(std::span<const StiffnessRegion> regions, Vec3d place) noexcept;

}  // namespace trocar::scene
