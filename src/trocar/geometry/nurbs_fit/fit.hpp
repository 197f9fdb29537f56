// Spline surfaces fitted to meshes and to clouds of points: an organ that somebody segmented becomes control points
// that somebody can pull at.
//
//   BodyFit fit = fit_body(mesh, {.around = 16, .along = 20});
//   fit.surface, fit.report.rms, fit.report.greatest, fit.report.volume_of_fit
//
// 1. Vertices get parameters: on the globe (sphere_map.hpp), on the square (square_map.hpp), or, for clouds, by the
//    direction from the middle or the place in the plane that suits best.
// 2. Control points by least squares with some stiffness (surface_system.hpp).
// 3. Each point gets the parameters of the place of the surface that is nearest to it; and again from 2.
// [Hoschek 1988, Intrinsic parametrization for approximation, for the third step]
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <trocar/geometry/nurbs/surface.hpp>
#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry::nurbs {

struct FitReport {
  std::vector<double> residuals;  ///< of each vertex, or point: how far the surface is from it [m]
  double rms = 0.0;               ///< root of the mean of their squares
  double greatest = 0.0;
  /// The other way round: how far places all over the surface are from the mesh (meshes only).
  double back_rms = 0.0, back_greatest = 0.0;
  double volume_of_mesh = 0.0, volume_of_fit = 0.0;  ///< [m^3], above 0; closed ones only
  int rounds = 0;
};

struct Fit {
  Surface surface;
  FitReport report;
};

struct BodyFitOptions {
  int around = 16;  ///< control points around (at least 4)
  int along = 16;   ///< and from pole to pole (at least 5); rows next to a pole follow from three points
  /// Length below which shapes are smoothed away [m]; 0: a sixth of the way between control points.
  double smoothing = 0.0;
  int rounds = 10;  ///< of steps 2 and 3, at most
  std::optional<std::array<Vec3d, 2>>
      poles;  ///< places near which the poles shall be; none: the places farthest apart along edges
};
/// A closed cubic surface, u around (periodic), v from pole to pole, with a tangent plane at the poles.
/// @throws std::invalid_argument for meshes that map_to_sphere refuses
Fit fit_body(const TriMesh& mesh, const BodyFitOptions& options = {});
/// The same for points all around a body that its middle sees (star-shaped).
Fit fit_body(std::span<const Vec3d> cloud, const BodyFitOptions& options = {});

struct PatchFitOptions {
  int count_u = 10, count_v = 10;  ///< control points each way (at least 4)
  double smoothing = 0.0;          ///< as above
  int rounds = 10;
};
/// An open cubic surface over a mesh with one rim, the rim of which becomes the four edges.
/// @throws std::invalid_argument for meshes that map_to_square refuses
Fit fit_patch(const TriMesh& mesh, const PatchFitOptions& options = {});
/// The same over points that lie side by side seen from somewhere: over the rectangle of their principal plane.
Fit fit_patch(std::span<const Vec3d> cloud, const PatchFitOptions& options = {});

/// How a surface suits a mesh, of any origin.
FitReport compare(const Surface& surface, const TriMesh& mesh);

}  // namespace trocar::geometry::nurbs
