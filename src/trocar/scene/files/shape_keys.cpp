// Keys of closed shapes that are no lofts: triangles from a file, NURBS, tubes, profiles turned about an axis. Solids
// and pouches have them.
#include <cmath>
#include <stdexcept>

#include <trocar/core/text.hpp>
#include <trocar/geometry/nurbs/closure.hpp>
#include <trocar/scene/files/keys.hpp>
#include <trocar/scene/files/reader_parts.hpp>

namespace trocar::scene {
namespace {

constexpr double kMostKnot = 1e6;

const Table<SurfaceSource>& surface_source() {
  using R = Rows<SurfaceSource>;
  static const Table<SurfaceSource> table{
      "surface",
      "A closed surface of triangles from a file: OBJ, STL, PLY, glTF, legacy VTK.",
      {needed(R::text("file", &SurfaceSource::file, "its name, relative to this file")),
       R::text("part", &SurfaceSource::part, "the one of this name of several in the file, default: all together"),
       R::number("unit_mm", units::mm, &SurfaceSource::unit, 1e-6, 1e6,
                 "unit of its coordinates, default: what its format says (glTF: 1000), else 1"),
       R::flag("mend", &SurfaceSource::mend, "true: defects of an open surface are mended; default {}"),
       R::vec3("place_mm", units::mm, &SurfaceSource::place, -kFar, kFar,
               "where its origin goes, default: the origin")}};
  return table;
}

/// What is not closed is reported at `key`.
template <class Shaped>
void check_closed(const JsonObject& o, const char* key, const Shaped& shape) {
  try {
    surface_of(shape);
  } catch (const std::invalid_argument& e) {
    o.fault(key, tr("expected a closed surface, got: {}", e.what()));
  }
}

void check_nurbs(const JsonObject& o, NurbsShape& s, Context&) {
  for (const char* key : {"net_mm", "weights", "degree", "knots_u", "knots_v"})
    if (o.names(key) && !o.has(key)) return;
  if (!o.has("net_mm")) return;
  if (s.net.size() > std::size_t(kMostControlPoints))
    return o.fault("net_mm", tr("expected at most {} control points, got {}", kMostControlPoints, s.net.size()));
  check_closed(o, "net_mm", s);
}

const Table<NurbsShape>& nurbs_shape() {
  using R = Rows<NurbsShape>;
  static const Table<NurbsShape> table{
      "nurbs",
      "A closed NURBS surface: a row of its net goes around the body, rows follow each other along it.",
      {needed(R::own(
           keys::grid("net_mm", -kFar, kFar, 3, "rows of control points"),
           [](const JsonObject& o, NurbsShape& s, Context&) {
             const PointGrid grid = o.grid("net_mm");
             s.rows = int(grid.rows), s.columns = int(grid.columns);
             for (const Vec3d& p : grid.points) s.net.push_back(read_by(units::mm, p));
           },
           [](const NurbsShape& s, bool) { return std::optional(written_rows(s.net, s.columns)); })),
       weights_row<NurbsShape>(), degree_row<NurbsShape>("around and along, default [3, 3]"),
       R::numbers("knots_u", &NurbsShape::knots_u, -kMostKnot, kMostKnot, 2,
                  "those of one turn, from its start to its end: one more than columns; default: uniform"),
       R::numbers("knots_v", &NurbsShape::knots_v, -kMostKnot, kMostKnot, 2,
                  "those along it, from end to end: rows - degree + 1, of a ring rows + 1; default: uniform"),
       R::choice("closed", Choices<NurbsShape::Closing>{{"ends", NurbsShape::ends}, {"ring", NurbsShape::ring}},
                 &NurbsShape::closing,
                 "ends: the first and the last row are a point each; ring: behind the last row comes the first again; "
                 "default {}")},
      check_nurbs};
  return table;
}

const Table<TubeShape::Station>& tube_station() {
  using R = Rows<TubeShape::Station>;
  static const Table<TubeShape::Station> table{
      "tube station",
      "How thick a tube is at an arc length; linear in between.",
      {needed(R::number("s_mm", units::mm, &TubeShape::Station::s, 0, 20000, "arc length from the start")),
       needed(R::number("radius_mm", units::mm, &TubeShape::Station::radius, 0.1, 500, "outer")),
       R::number("wall_mm", units::mm, &TubeShape::Station::wall, 0.05, 500,
                 "thickness of its wall, default: it is solid")},
      [](const JsonObject& o, TubeShape::Station& s, Context&) {
        if (o.has("wall_mm") && o.has("radius_mm") && !(s.wall < s.radius))
          o.fault("wall_mm", tr("expected a wall below the radius of {} mm, got {}", 1000 * s.radius, 1000 * s.wall));
      }};
  return table;
}

void check_tube_station(const JsonObject& o, TubeShape& t, Context&) {
  const std::size_t n = t.stations.size();
  if (n > 1 && o.has("s_mm") && !(t.stations[n - 1].s > t.stations[n - 2].s))
    o.fault("s_mm", "expected stations by rising s_mm, got one that is not beyond the one before");
  if (n > 1 && (t.stations[n - 1].wall > 0) != (t.stations[n - 2].wall > 0))
    o.fault(o.at(), "expected a wall_mm at every station or at none, got it at some");
}

void check_tube(const JsonObject& o, TubeShape& t, Context&) {
  if (!o.has("line_mm") || t.stations.empty() || !check_apart(o, "line_mm", t.line)) return;
  for (const TubeShape::Station& s : t.stations)
    if ((s.wall > 0) != t.hollow() || !(s.wall < s.radius)) return;  // told already
  if (o.names("ends") && t.hollow()) o.fault("ends", "expected no ends of a hollow tube, which has rims, got some");
  check_closed(o, "line_mm", t);
}

const Table<TubeShape>& tube_shape() {
  using R = Rows<TubeShape>;
  static const Table<TubeShape> table{
      "tube",
      "A tube along a smooth line through points, solid or hollow.",
      {needed(R::points("line_mm", units::mm, &TubeShape::line, -kFar, kFar, 2, "points on its middle line")),
       needed(R::objects("stations", tube_station, &TubeShape::stations, 1, "how thick it is, by rising s_mm",
                         check_tube_station)),
       R::choice("ends", Choices<TubeShape::Ends>{{"round", TubeShape::round}, {"flat", TubeShape::flat}},
                 &TubeShape::ends,
                 "of a solid one: half an ellipsoid, which reaches beyond the line by its radius, or cut "
                 "off; default {}")},
      check_tube};
  return table;
}

void read_profile(const JsonObject& o, RevolvedShape& s, Context&) {
  const NumberTable table = o.table("profile_mm");
  if (!o.has("profile_mm")) return;
  if (table.columns != 2)
    return o.fault("profile_mm", tr("expected rows of 2 numbers, r and z, got rows of {}", table.columns));
  for (std::size_t i = 0; i < table.rows; ++i)
    s.profile.push_back({units::mm.read(table.values[2 * i]), units::mm.read(table.values[2 * i + 1])});
}

std::optional<JsonValue> written_profile(const RevolvedShape& s, bool) {
  return listed(s.profile, [](const RevolvedShape::ProfilePoint& p) {
    return json_array({json_number(in_file(units::mm, p.r)), json_number(in_file(units::mm, p.z))});
  });
}

void check_revolved(const JsonObject& o, RevolvedShape& s, Context&) {
  if (s.profile.empty()) return;
  const auto& p = s.profile;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const bool inside = i > 0 && i + 1 < p.size();
    if (p[i].r < 0 || (inside && !(p[i].r >= 1e-5)))
      return o.fault(o.at("profile_mm", i),
                     tr("expected r {}, got {}", inside ? "above 0 between the ends" : "of at least 0", 1000 * p[i].r));
    if (i > 0 && !(length(Vec3d{p[i].r - p[i - 1].r, 0, p[i].z - p[i - 1].z}) >= 1e-5))
      return o.fault(o.at("profile_mm", i),
                     "expected a point at least 0.01 mm from the one before, got the same place");
  }
  if (o.names("axis") && !(length(s.axis) > 1e-6)) return o.fault("axis", "expected a direction, got none");
  check_closed(o, "profile_mm", s);
}

const Table<RevolvedShape>& revolved_shape() {
  using R = Rows<RevolvedShape>;
  static const Table<RevolvedShape> table{
      "revolved",
      "A profile turned about an axis. Where its ends are not on the axis, flat lids close it; one that ends where it "
      "begins makes a ring.",
      {needed(R::own(keys::table("profile_mm", -kFar, kFar, 2, "points [r, z]: from the axis, along it"), read_profile,
                     written_profile)),
       R::vec3("from_mm", units::mm, &RevolvedShape::from, -kFar, kFar, "where z is 0 on the axis, default the origin"),
       R::vec3("axis", units::one, &RevolvedShape::axis, -1, 1, "its direction, default [0, 0, 1]"),
       R::flag("smooth", &RevolvedShape::smooth, "a smooth curve through the points, else straight lines; default {}")},
      check_revolved};
  return table;
}

template <class Body>
Row<Body> surface_row() {
  return Rows<Body>::own(
      keys::object(
          "surface", []() -> const Shape& { return surface_source(); }, "closed triangles from a file"),
      [](const JsonObject& o, Body& body, Context& c) {
        for (const JsonObject& part : o.objects("surface"))
          body.shape.surface = c.reading->surface_of(part, surface_source().made(part, c), c.folder);
      },
      [](const Body& body, bool) {
        return body.shape.surface ? std::optional<JsonValue>(surface_source().written(*body.shape.surface))
                                  : std::nullopt;
      });
}

}  // namespace

JsonValue written_rows(const std::vector<Vec3d>& net, int columns) {
  std::vector<JsonValue> rows;
  for (auto row = net.begin(); columns > 0 && net.end() - row >= columns; row += columns)
    rows.push_back(listed(std::vector<Vec3d>(row, row + columns), [](Vec3d p) { return written_by(units::mm, p); }));
  return json_array(std::move(rows));
}

template <class Body>
std::vector<Row<Body>> shape_rows() {
  using R = Rows<Body>;
  return {surface_row<Body>(),
          R::object(
              "nurbs", nurbs_shape, [](auto& body) -> auto& { return body.shape.nurbs; }, "a closed NURBS surface"),
          R::object(
              "tube", tube_shape, [](auto& body) -> auto& { return body.shape.tube; }, "a tube along a line"),
          R::object(
              "revolved", revolved_shape, [](auto& body) -> auto& { return body.shape.revolved; },
              "a profile turned about an axis")};
}
template std::vector<Row<Solid>> shape_rows();
template std::vector<Row<Pouch>> shape_rows();

int check_one_shape(const JsonObject& o, std::initializer_list<const char*> shapes) {
  int named = 0;
  std::string list;
  for (const char* key : shapes) {
    named += o.names(key);
    if (o.names(key) && named == 2) o.fault(key, "expected one shape, got a second one");
    list += list.empty() ? key : fmt::format("{}{}", key == *(shapes.end() - 1) ? " or " : ", ", key);
  }
  if (named == 0) o.fault(o.at(), tr("expected a shape ({}), got none", list));
  return named;
}

}  // namespace trocar::scene
