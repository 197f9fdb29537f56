// Which way the fibres of an organ run at a place: along strokes drawn near it, or along the organ's own middle line.
//
//   const std::vector<Vec3d> fibres = fibres_in(solid, middles_of_cells);   // empty: one direction, or none
#pragma once

#include <span>
#include <vector>

#include <trocar/scene/description/description.hpp>

namespace trocar::scene {

inline constexpr std::size_t kMostStrokePoints = 2000;  ///< of all strokes of an organ together

/// Unit, of either sense: every stroke counts with its direction where it is nearest to the place, over the square of
/// that distance: the principal axis of sum t t^T / d^2. Directions turn smoothly along a stroke, from the mean of two
/// pieces at the point between them to the next.
/// @param strokes  at least one, of at least two points that lie apart [m]
Vec3d fibre_at(std::span<const Stroke> strokes, Vec3d place) noexcept;

/// Centres of the sections, or points on the line of a tube. @throws std::invalid_argument where it has neither
Stroke middle_line(const Solid& solid);

/// At each of the places; empty where neither strokes nor the middle line say it: Solid::fibre then does.
/// @throws std::invalid_argument
std::vector<Vec3d> fibres_in(const Solid& solid, std::span<const Vec3d> places);

}  // namespace trocar::scene
