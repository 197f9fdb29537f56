// How a surface closes on itself, which of its control points are one and the same mass, and what a closed one
// encloses.
//
//   const Closure ends = closure_of(surface);
//   if (ends.closed()) ... volume(surface) ...
//   Nodes nodes = nodes_of(surface);                   // poles and seams once
//
// Closed bodies are single surfaces: closed around in one direction with a pole at both ends of the other, as a sphere,
// or closed around in both, as a torus. Lengths in metres.
#pragma once

#include <vector>

#include <trocar/geometry/nurbs/surface.hpp>

namespace trocar::geometry::nurbs {

inline constexpr double kSamePlace = 1e-9;  ///< [m] control points nearer to each other than this are one

struct Closure {
  bool around_u = false, around_v = false;  ///< its last curve across this direction is its first
  bool pole_at_u[2]{false, false};          ///< at the start and at the end of u everything is one point
  bool pole_at_v[2]{false, false};

  bool like_sphere() const noexcept {
    return (around_u && pole_at_v[0] && pole_at_v[1]) || (around_v && pole_at_u[0] && pole_at_u[1]);
  }
  bool like_torus() const noexcept { return around_u && around_v; }
  bool closed() const noexcept { return like_sphere() || like_torus(); }
};
Closure closure_of(const Surface& surface, double same_place = kSamePlace);
/// @throws std::invalid_argument: `who`, and which ends are open
void require_closed(const Surface& surface, const char* who);

/// Control points that have to move together, as one node: those of a pole, and those of a seam.
struct Nodes {
  std::vector<int> of_point;  ///< of each control point
  int count = 0;              ///< numbered by their first control points
};
Nodes nodes_of(const Surface& surface, double same_place = kSamePlace);
/// Where the nodes are, and a surface's control points put where its nodes are.
std::vector<Vec3d> places_of(const Nodes& nodes, const std::vector<Vec3d>& points);
void place(const Nodes& nodes, const std::vector<Vec3d>& places, std::vector<Vec3d>& points) noexcept;

/// [m^2], by Gauss's quadrature over spans; exact up to about 1e-6 for smooth surfaces.
double area(const Surface& surface);
/// Enclosed [m^3], above 0 where du x dv points out; likewise, and to rounding for surfaces without weights up to
/// degree
/// 3. The surface must be closed.
double volume(const Surface& surface);
/// The surface with du x dv pointing out of what it encloses: as it is, or u reversed.
Surface outwards(const Surface& surface);

}  // namespace trocar::geometry::nurbs
