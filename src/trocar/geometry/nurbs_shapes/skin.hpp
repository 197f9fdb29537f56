// Surfaces through section curves.
//
//   const Surface body = skinned(rings);                            // cubic along v, through each ring
//   const std::vector<Curve> alike = compatible(curves);            // of one degree and over the same knots
//
// [PT97 section 10.3]
#pragma once

#include <span>
#include <vector>

#include <trocar/geometry/nurbs/curve.hpp>
#include <trocar/geometry/nurbs/surface.hpp>

namespace trocar::geometry::nurbs {

/// The same curves with the highest degree of them, over all of their knots, on 0 .. 1. Closed curves stay periodic if
/// all of them are, else all are opened at their start.
std::vector<Curve> compatible(const std::vector<Curve>& curves);

struct SkinOptions {
  int degree = 3;                  ///< along v; less where there are too few sections
  bool closed = false;             ///< from the last section on to the first (more sections than the degree then)
  std::vector<double> parameters;  ///< v of each section, ascending; empty: by the mean way between sections, 0 .. 1
};
/// The surface that has each section as its curve along u, in order. @throws std::invalid_argument for fewer than 2
/// sections, faulty ones, and neighbours that coincide
Surface skinned(const std::vector<Curve>& sections, const SkinOptions& options = {});

/// Through a grid of points, (i, j) at i + count_u j: degree 3 or what the counts allow, parameters by the mean of the
/// rows' chords.  [PT97 A9.4]
Surface surface_through(std::span<const Vec3d> points, int count_u, int count_v, int degree = 3);

}  // namespace trocar::geometry::nurbs
