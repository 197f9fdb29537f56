// The point of a curve or of a surface that is nearest to a point in space.
//
//   const CurveFoot foot = closest(curve, p);                       // foot.u, foot.point, foot.distance
//   const SurfaceFoot near = closest_from(surface, p, u, v);        // downhill from a guess: quick, not always the
//   nearest const ClosestOnSurface seeker(surface);                         // many points, one surface for (Vec3d q :
//   cloud) use(seeker.find(q));
//
// Newton's method on the distance, safeguarded [PT97 section 6.1]: along curves between places where the distance
// begins to fall and has begun to rise, on surfaces by going downhill only. Ends, edges, corners and poles are points
// like others: where the nearest is at an end, the parameter is that of the end exactly. The search begins in every
// piece of a span that may hold the nearest point, as far as samples of the pieces show how large they are.
#pragma once

#include <vector>

#include <trocar/geometry/nurbs/curve.hpp>
#include <trocar/geometry/nurbs/surface.hpp>

namespace trocar::geometry::nurbs {

struct CurveFoot {
  double u = 0.0;
  Vec3d point;
  double distance = 0.0;  ///< [m]
};
CurveFoot closest(const Curve& curve, Vec3d p);

struct SurfaceFoot {
  double u = 0.0, v = 0.0;
  Vec3d point;
  double distance = 0.0;  ///< [m]
};
SurfaceFoot closest(const Surface& surface, Vec3d p);
/// Downhill from (u, v): a nearest point among those around it.
SurfaceFoot closest_from(const Surface& surface, Vec3d p, double u, double v) noexcept;

/// Samples of one curve or surface, which must outlive it and not change, for many searches.
class ClosestOnCurve {
 public:
  explicit ClosestOnCurve(const Curve& curve);
  CurveFoot find(Vec3d p) const;

 private:
  // Between two neighbouring samples of a span; derivatives are those from inside of it.
  struct Piece {
    double from, to;
    Vec3d start, end, slope_start, slope_end;
    double length;  ///< [m]
  };
  const Curve& m_curve;
  std::vector<Piece> m_pieces;
};

class ClosestOnSurface {
 public:
  explicit ClosestOnSurface(const Surface& surface);
  SurfaceFoot find(Vec3d p) const;

 private:
  // A ball around a piece of surface.
  struct Cell {
    double u, v;
    Vec3d middle;
    double radius;  ///< [m]
  };
  const Surface& m_surface;
  std::vector<Cell> m_cells;
};

}  // namespace trocar::geometry::nurbs
