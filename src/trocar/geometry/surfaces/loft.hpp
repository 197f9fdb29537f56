// Closed bodies from a few cross-sections (a uterus, an ovary, a gallbladder): a smooth surface through them, rounded
// off at both ends, and its triangle mesh.
//
//   const std::vector<Section> sections{{{0, 0, 0}, {0.02, 0, 0}, {0, 0.01, 0}, 2.0}, ...};   // along the body
//   const NurbsSurface surface = loft(sections);
//   const TriMesh mesh = tessellate(surface, 0.002);
//
// u runs around (periodic, 0 .. 1, from `across` to `deep`), v along from the first end's pole to the last's (0 .. 1).
#pragma once

#include <span>

#include <trocar/geometry/curves/spline.hpp>
#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry {

/// An ellipse (squareness 2) or superellipse (above 2: boxier) in the plane of two half-axis vectors [m].
struct Section {
  Vec3d centre;
  Vec3d across, deep;
  double squareness = 2.0;
};
/// The section's outline at the angle `turn` (0 .. 1 once around): centre + r (across cos + deep sin), with
/// |cos|^n + |sin|^n = r^-n.
Vec3d outline(const Section& section, double turn);

struct LoftOptions {
  int around = 24;  ///< points at which each outline is followed (at least 8)
  /// How far the rounded ends reach beyond the first and last section, in units of that section's smaller half-axis.
  double first_cap = 1.0, last_cap = 1.0;
};

/// The surface: passes through every section's outline, C2 inside, and closes in a pole at each end like half an
/// ellipsoid. At least 2 sections. Throws std::invalid_argument, also where neighbouring sections coincide.
NurbsSurface loft(std::span<const Section> sections, const LoftOptions& options = {});

/// A closed, outwards oriented, even mesh of a surface that is periodic in u and closes in poles at both ends of v,
/// with edges of about `target_edge` [m]: rings of vertices by arc length, then edge flips and smoothing on the
/// surface. Throws std::invalid_argument for surfaces that do not close.
TriMesh tessellate(const NurbsSurface& surface, double target_edge);

/// The same with the (u, v) of every vertex (the poles' u is 0).
struct Tessellation {
  TriMesh mesh;
  std::vector<std::array<double, 2>> parameters;
};
Tessellation tessellate_with_parameters(const NurbsSurface& surface, double target_edge);

}  // namespace trocar::geometry
