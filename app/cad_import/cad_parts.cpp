#include "cad_parts.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepGProp.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <GeomConvert.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>

#include <trocar/geometry/nurbs/surface.hpp>

namespace trocar::cad {
namespace {

constexpr double kMetre = 1e-3, kTurn = 0.2;  // of a millimetre; [rad] between neighbouring triangles
constexpr double kSame = 1e-7;                // [m] how far the surface made may be from the file's
constexpr double kTooLarge = 3;               // [m] diagonal of a part

Vec3d metres(const gp_Pnt& p) { return {p.X() * kMetre, p.Y() * kMetre, p.Z() * kMetre}; }

/// The face's surface as a spline of its own patch, in its own place.
Handle(Geom_BSplineSurface) spline_of(const TopoDS_Face& face) {
  double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
  BRepTools::UVBounds(face, u0, u1, v0, v1);
  const Handle(Geom_Surface) whole = BRep_Tool::Surface(face);
  double a0 = 0, a1 = 0, b0 = 0, b1 = 0;
  whole->Bounds(a0, a1, b0, b1);
  const auto near = [](double a, double b) { return std::fabs(a - b) < 1e-9 * (1 + std::fabs(b)); };
  if (near(u0, a0) && near(u1, a1) && near(v0, b0) && near(v1, b1)) return GeomConvert::SurfaceToBSplineSurface(whole);
  return GeomConvert::SurfaceToBSplineSurface(new Geom_RectangularTrimmedSurface(whole, u0, u1, v0, v1));
}

/// A face that is cut out of its surface by other edges than the surface's own ends has less area than it.
bool is_trimmed(const TopoDS_Face& face, const Handle(Geom_BSplineSurface) & spline) {
  GProp_GProps of_face;
  BRepGProp::SurfaceProperties(face, of_face);
  constexpr int kSteps = 64;
  double u0 = 0, u1 = 0, v0 = 0, v1 = 0, area = 0;
  spline->Bounds(u0, u1, v0, v1);
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      gp_Pnt p;
      gp_Vec du, dv;
      spline->D1(u0 + (u1 - u0) * (i + 0.5) / kSteps, v0 + (v1 - v0) * (j + 0.5) / kSteps, p, du, dv);
      area += du.Crossed(dv).Magnitude() * (u1 - u0) * (v1 - v0) / (kSteps * kSteps);
    }
  return std::fabs(of_face.Mass() - area) > 0.01 * area;
}

bool is_pole(const Handle(Geom_BSplineSurface) & s, int row) {
  for (int i = 1; i <= s->NbUPoles(); ++i)
    if (s->Pole(i, row).Distance(s->Pole(1, row)) > 1e-6) return false;
  return true;
}

/// The knots of the domain from its start to its end, each as often as it counts there.
std::vector<double> knots(const TColStd_Array1OfReal& values, const TColStd_Array1OfInteger& counts, bool turn,
                          int degree) {
  std::vector<double> out;
  for (int i = values.Lower(); i <= values.Upper(); ++i) {
    const bool first = i == values.Lower(), last = i == values.Upper();
    const int count = turn ? (last ? 1 : counts(i)) : (first || last ? counts(i) - degree : counts(i));
    out.insert(out.end(), std::size_t(std::max(count, 1)), values(i));
  }
  return out;
}

scene::NurbsShape as_shape(const Handle(Geom_BSplineSurface) & s, int shift_u, int shift_v) {
  scene::NurbsShape out;
  out.columns = s->NbUPoles();
  out.rows = s->NbVPoles();
  out.degree = {s->UDegree(), s->VDegree()};
  out.closing = s->IsVPeriodic() ? scene::NurbsShape::ring : scene::NurbsShape::ends;
  out.knots_u = knots(s->UKnots(), s->UMultiplicities(), true, s->UDegree());
  out.knots_v = knots(s->VKnots(), s->VMultiplicities(), s->IsVPeriodic(), s->VDegree());
  for (int r = 0; r < out.rows; ++r)
    for (int c = 0; c < out.columns; ++c) {
      const int i = 1 + (c + shift_u) % out.columns, j = 1 + (r + shift_v) % out.rows;
      out.net.push_back(metres(s->Pole(i, j)));
      if (s->IsURational() || s->IsVRational()) out.weights.push_back(s->Weight(i, j));
    }
  return out;
}

/// Whether it is the file's surface: both are asked for points of the same shares of their domains, one of them read
/// backwards where it had to be turned outwards.
bool is_same(const geometry::nurbs::Surface& made, const Handle(Geom_BSplineSurface) & s) {
  double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
  s->Bounds(u0, u1, v0, v1);
  for (const bool backwards : {false, true}) {
    double off = 0;
    for (int i = 0; i < 12; ++i)
      for (int j = 0; j < 12; ++j) {
        const double u = (i + 0.37) / 12, v = (j + 0.41) / 12;
        const Vec3d there = metres(s->Value(u0 + u * (u1 - u0), v0 + v * (v1 - v0)));
        off = std::max(off, length(geometry::nurbs::point(made, backwards ? 1 - u : u, v) - there));
      }
    if (off < kSame) return true;
  }
  return false;
}

/// [m]
double diagonal(const TopoDS_Shape& part) {
  Bnd_Box box;
  BRepBndLib::Add(part, box);
  return box.IsVoid() ? 0 : std::sqrt(box.SquareExtent()) * kMetre;
}

}  // namespace

int faces_of(const TopoDS_Shape& part) {
  int count = 0;
  for (TopExp_Explorer e(part, TopAbs_FACE); e.More(); e.Next()) ++count;
  return count;
}

double within_of_size(const TopoDS_Shape& part, double within) {
  constexpr double kShare = 1e-3;
  const double size = diagonal(part);
  return size > kTooLarge ? std::max(within, kShare * size) : within;
}

geometry::TriMesh triangles_of(const TopoDS_Shape& part, double within) {
  // Of parts of tens of metres the mesher makes flat sheets: they are made small first.
  const double size = diagonal(part), scale = size > kTooLarge ? 1 / size : 1;
  gp_Trsf smaller;
  smaller.SetScaleFactor(scale);
  const TopoDS_Shape shape = scale < 1 ? BRepBuilderAPI_Transform(part, smaller, true).Shape() : part;
  const BRepMesh_IncrementalMesh mesher(shape, scale * within / kMetre, false, kTurn);
  geometry::TriMesh out;
  for (TopExp_Explorer e(shape, TopAbs_FACE); e.More(); e.Next()) {
    const TopoDS_Face face = TopoDS::Face(e.Current());
    TopLoc_Location place;
    const Handle(Poly_Triangulation) t = BRep_Tool::Triangulation(face, place);
    if (t.IsNull()) continue;
    const int first = int(out.positions.size());
    for (int i = 1; i <= t->NbNodes(); ++i)
      out.positions.push_back(metres(t->Node(i).Transformed(place)) * (1 / scale));
    for (int i = 1; i <= t->NbTriangles(); ++i) {
      int a = 0, b = 0, c = 0;
      t->Triangle(i).Get(a, b, c);
      if (face.Orientation() == TopAbs_REVERSED) std::swap(b, c);
      out.triangles.push_back({first + a - 1, first + b - 1, first + c - 1});
    }
  }
  return out;
}

std::optional<scene::NurbsShape> nurbs_of(const TopoDS_Shape& part) {
  if (faces_of(part) != 1) return std::nullopt;
  const TopoDS_Face face = TopoDS::Face(TopExp_Explorer(part, TopAbs_FACE).Current());
  const Handle(Geom_BSplineSurface) s = spline_of(face);
  if (s.IsNull() || is_trimmed(face, s)) return std::nullopt;
  if (!s->IsUClosed()) s->ExchangeUV();
  if (!s->IsUClosed()) return std::nullopt;
  s->SetUPeriodic();
  if (s->IsVClosed())
    s->SetVPeriodic();
  else if (!is_pole(s, 1) || !is_pole(s, s->NbVPoles()))
    return std::nullopt;
  // Which control point belongs to the first knot of a turn is each library's own: the shape says which it is.
  for (int u = 0; u < s->NbUPoles(); ++u)
    for (int v = 0; v < (s->IsVPeriodic() ? s->NbVPoles() : 1); ++v) {
      if (u > s->UDegree() && u < s->NbUPoles() - s->UDegree()) continue;
      if (v > s->VDegree() && v < s->NbVPoles() - s->VDegree()) continue;
      const scene::NurbsShape shape = as_shape(s, u, v);
      try {
        if (is_same(scene::surface_of(shape), s)) return shape;
      } catch (const std::invalid_argument&) {
        return std::nullopt;  // of a kind that bodies here are not
      }
    }
  return std::nullopt;
}

}  // namespace trocar::cad
