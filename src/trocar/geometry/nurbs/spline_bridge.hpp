// The splines of curves/spline.hpp, of which organs' files are lofted, as NURBS that can be changed, and back.
//
//   const Surface organ = nurbs_of(loft(sections));                 // closed, with poles: fit to be edited and fitted
#pragma once

#include <trocar/geometry/curves/spline.hpp>
#include <trocar/geometry/nurbs/curve.hpp>
#include <trocar/geometry/nurbs/surface.hpp>

namespace trocar::geometry::nurbs {

/// @throws std::invalid_argument where the spline is not valid as NURBS: unclamped, or its repeated control points
/// differ
Curve nurbs_of(const NurbsCurve& spline);
Surface nurbs_of(const NurbsSurface& spline);

/// Degrees up to geometry::kMaxDegree. @throws std::invalid_argument beyond
NurbsCurve spline_of(const Curve& curve);
NurbsSurface spline_of(const Surface& surface);

}  // namespace trocar::geometry::nurbs
