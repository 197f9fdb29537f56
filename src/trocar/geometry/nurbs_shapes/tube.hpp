// Tubes along a spine, and lids for what is open: vessels, ducts, guts.
//
//   const Surface duct = tube(spine, {0.002, 0.003, 0.002});        // a radius at each knot of the spine
//   const Surface solid = capped(duct, CapShape::flat, CapShape::round);
//   const Surface pipe = hollow_tube(spine, {0.01}, 0.002);         // one closed surface: outer wall, inner wall, rims
//
// Sections are exact circles at right angles to the spine, turned along it as little as possible; between them the
// surface is a cubic along v, so it is exact for straight spines of even radius and off by a small share of the
// radius's and the bend's change over a station otherwise (docs/science/nurbs.md has figures).
#pragma once

#include <vector>

#include <trocar/geometry/nurbs/curve.hpp>
#include <trocar/geometry/nurbs/surface.hpp>

namespace trocar::geometry::nurbs {

struct TubeOptions {
  int stations = 4;   ///< sections to a span of the spine's knots
  Vec3d up{0, 0, 1};  ///< u = 0 looks this way at the spine's start, as far as the spine allows
};
/// The open wall, u around (periodic), v along as the spine's parameter, scaled to 0 .. 1; for a closed spine v is
/// periodic, too. @param radii [m] at the spine's distinct knots, or a single one for all of it; between them a smooth
/// curve that never passes beyond its neighbours
Surface tube(const Curve& spine, const std::vector<double>& radii, const TubeOptions& options = {});

enum class CapShape {
  none,
  flat,  ///< straight to the middle of the rim, with an edge
  round  ///< half an ellipsoid as deep as the rim's mean radius
};
/// The surface, closed around in u and open in v, with lids on its ends, which end in poles. Its v is elevated to
/// degree 2 at least for round ones.
Surface capped(const Surface& wall, CapShape start, CapShape end);

/// The wall between a tube of these radii and one thinner by `thickness`, as one surface like a torus: v runs along the
/// outer wall, over the rim, back along the inner wall and over the other rim. Open spines only.
/// @param thickness [m] given as radii are: at the spine's distinct knots, or a single one
Surface hollow_tube(const Curve& spine, const std::vector<double>& radii, const std::vector<double>& thickness,
                    const TubeOptions& options = {});
inline Surface hollow_tube(const Curve& spine, const std::vector<double>& radii, double thickness,
                           const TubeOptions& options = {}) {
  return hollow_tube(spine, radii, std::vector<double>{thickness}, options);
}

}  // namespace trocar::geometry::nurbs
