// Small pieces that the files of a thread's step share: turns along the chain, and nearest places of two elements.
#pragma once

#include <trocar/numerics/vec3.hpp>

namespace trocar::suture {

inline constexpr int kGroup = 8;  ///< elements whose boxes are looked at together

/// The smallest rotation that takes the unit vector a to the unit vector b, applied to r. Fades out where b is nearly
/// -a, where no smallest rotation is.
inline Vec3d turned(Vec3d a, Vec3d b, Vec3d r) {
  const Vec3d w = cross(a, b);
  const double c = 1 + dot(a, b);
  return r + cross(w, r) + (1 / (c > 0.02 ? c : 0.02)) * cross(w, cross(w, r));
}
/// A director across a, carried without twist to one across b; unit.
inline Vec3d carried(Vec3d a, Vec3d b, Vec3d director) {
  const Vec3d d = turned(a, b, director), flat = d - dot(d, b) * b;
  const double size = length(flat);
  return size > 1e-30 ? flat / size : any_perpendicular(b);
}

/// Nearest places of the segments p + s d and q + t e, 0 <= s, t <= 1. Where the segments are nearly parallel, the
/// places nearest to their middles: `softness` (a share of the squared length) draws there, so that places move
/// smoothly while the segments turn.
struct NearestPlaces {
  double s = 0, t = 0;
};
inline double within_one(double a) { return a > 0 ? (a < 1 ? a : 1) : 0; }
inline NearestPlaces nearest_places(Vec3d p, Vec3d d, Vec3d q, Vec3d e, double softness) {
  const Vec3d r = p - q;
  const double dd = dot(d, d), ee = dot(e, e), de = dot(d, e), soft = softness * (dd < ee ? dd : ee);
  // least |r + s d - t e|^2 + soft ((s - 1/2)^2 + (t - 1/2)^2)
  const double a = dd + soft, b = ee + soft, f = 0.5 * soft - dot(d, r), g = 0.5 * soft + dot(e, r);
  const double det = a * b - de * de;
  NearestPlaces place;
  place.s = det > 0 ? within_one((f * b + g * de) / det) : 0.5;
  const double t = b > 0 ? (g + de * place.s) / b : 0.5;
  place.t = within_one(t);
  if (place.t != t) place.s = a > 0 ? within_one((f + de * place.t) / a) : 0.5;
  return place;
}

}  // namespace trocar::suture
