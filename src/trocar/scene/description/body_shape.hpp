// What the surface of a body can be beside a loft through sections: closed triangles from a file, a closed NURBS
// surface, a tube along a line, a profile turned about an axis. Code that fills a body, or makes a wall of it, asks for
// the one surface that they all are (compile/body_surface.hpp). Lengths in metres.
//
//   if (solid.shape.any()) ...                              // else its sections, or its tetrahedra
//   const nurbs::Surface wall = surface_of(*solid.shape.tube);    // closed, du x dv outwards
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <trocar/geometry/nurbs/curve.hpp>
#include <trocar/geometry/nurbs/surface.hpp>
#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::scene {

/// A surface of triangles from a file: OBJ, STL, PLY, glTF, legacy VTK.
struct SurfaceSource {
  std::string file;                   ///< as named, relative to the file that names it
  std::string part;                   ///< of several that the file has; empty: all of them together
  double unit = 0;                    ///< of coordinates [m]; 0: what the format says, else a millimetre
  bool mend = true;                   ///< what is no closed surface, where that can be done
  Vec3d place;                        ///< where the file's origin goes [m]
  geometry::TriMesh mesh;             ///< closed, outwards, in the scene's frame, as mended
  std::vector<std::string> warnings;  ///< what was mended
};

/// A closed NURBS surface. A row of the net goes around the body (u), rows follow each other along it (v).
struct NurbsShape {
  enum Closing {
    ends,  ///< the first and the last row are a point each, the poles
    ring   ///< behind the last row comes the first again, as of a torus
  };
  int rows = 0, columns = 0;
  std::vector<Vec3d> net;           ///< rows * columns control points [m]
  std::vector<double> weights;      ///< > 0, in the same order; empty: all 1
  std::array<int, 2> degree{3, 3};  ///< around, along
  std::vector<double> knots_u;      ///< one turn's, from its start to its end: columns + 1; empty: uniform
  std::vector<double> knots_v;      ///< the domain's: rows - degree + 1, of a ring rows + 1; empty: uniform
  Closing closing = ends;
};

/// A tube along a smooth line through points, solid or hollow.
struct TubeShape {
  struct Station {
    double s = 0;           ///< arc length from the start [m]
    double radius = 0.005;  ///< outer [m]
    double wall = 0;        ///< thickness of its wall [m]; 0 at all stations: solid
  };
  enum Ends { round, flat };
  std::vector<Vec3d> line;
  std::vector<Station> stations;  ///< radius and wall along it, linear in between
  Ends ends = round;              ///< of a solid one; a hollow one has rims

  bool hollow() const;  ///< has a wall at one station
};

/// A profile turned about an axis. Where its ends are not on the axis, flat lids close it; one that ends where it
/// begins makes a ring.
struct RevolvedShape {
  struct ProfilePoint {
    double r = 0, z = 0;  ///< from the axis, along it [m]
    friend bool operator==(const ProfilePoint&, const ProfilePoint&) = default;
  };
  std::vector<ProfilePoint> profile;
  Vec3d from;           ///< where z is 0 on the axis [m]
  Vec3d axis{0, 0, 1};  ///< any length
  bool smooth = true;   ///< a smooth curve through the points; else straight from one to the next
};

/// At most one of them.
struct ClosedShape {
  std::optional<SurfaceSource> surface;
  std::optional<NurbsShape> nurbs;
  std::optional<TubeShape> tube;
  std::optional<RevolvedShape> revolved;

  bool any() const { return surface || nurbs || tube || revolved; }
};

inline constexpr int kMostControlPoints = 10'000;     ///< of a shape's net
inline constexpr std::size_t kMostCurvePoints = 200;  ///< of a line or a profile, and stations along it

/// The closed surface, du x dv outwards, u around. @throws std::invalid_argument where there is none, with why
geometry::nurbs::Surface surface_of(const NurbsShape& shape);
geometry::nurbs::Surface surface_of(const TubeShape& shape);
geometry::nurbs::Surface surface_of(const RevolvedShape& shape);
/// Of whichever of these three there is; nothing for triangles from a file, and where there is no shape.
std::optional<geometry::nurbs::Surface> spline_of(const ClosedShape& shape);
/// A closed surface as a file has it. @throws std::invalid_argument for one that is open, or not around in u
NurbsShape shape_of(const geometry::nurbs::Surface& surface);

/// The smooth line through the points of a tube. @throws std::invalid_argument where neighbours coincide
geometry::nurbs::Curve line_of(const TubeShape& shape);
/// Radius and wall at an arc length, linear between stations.
TubeShape::Station station_at(const TubeShape& shape, double s);

/// Clamped ones over 0 .. 1, from the knots of the domain as files give them: points - degree + 1, or uniform ones
/// where there are none. @throws std::invalid_argument
geometry::nurbs::Knots clamped_by(int degree, int points, const std::vector<double>& knots, const char* name);

/// Control points that may move one place of a body with masses at them (tissue::Skin).
inline constexpr int kMostCarriers = 16;

/// Estimates, for bounds before anything is built; zeros where the shape is none.
struct ShapeSize {
  double volume = 0, area = 0;  ///< [m^3], [m^2]
  geometry::Bounds box{};       ///< [m]
};
ShapeSize size_of(const ClosedShape& shape);

}  // namespace trocar::scene
