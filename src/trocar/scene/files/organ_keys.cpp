// Keys of organ files: solids and walls, other organs that are part of them. Strands and what hangs on them:
// fold_keys.cpp.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include <trocar/core/text.hpp>
#include <trocar/scene/description/fibres.hpp>
#include <trocar/scene/files/keys.hpp>
#include <trocar/scene/files/reader_parts.hpp>

namespace trocar::scene {
namespace {

double area(const Section& s) {
  // of a super-ellipse: pi a b at exponent 2, towards 4 a b for a square (1 % good between)
  return (4 - 1.717 / s.squareness) * length(cross(s.across, s.deep));
}

void check_section(const JsonObject& o, Section& s, Context&) {
  for (const auto& [key, axis] : {std::pair{"across_mm", s.across}, std::pair{"deep_mm", s.deep}})
    if (o.has(key) && !(length(axis) >= 1e-5)) o.fault(key, "expected a half axis of at least 0.01 mm, got none");
  const double a = length(s.across), b = length(s.deep);
  if (a > 0 && b > 0 && !(length(cross(s.across, s.deep)) >= 0.5 * a * b))
    o.fault("deep_mm", "expected half axes at least 30 degrees apart, got nearly parallel ones");
}

const Table<Anchor>& anchor() {
  using R = Rows<Anchor>;
  static const Table<Anchor> table{
      "anchor",
      "The nodes within a ball are held where they are, rigidly or by springs.",
      {needed(R::vec3("centre_mm", units::mm, &Anchor::centre, -kFar, kFar, "centre of the ball")),
       needed(R::number("radius_mm", units::mm, &Anchor::radius, 0.1, 500, "radius of the ball")),
       R::number("stiffness_N_m", units::one, &Anchor::stiffness, 0, 1e6,
                 "of all springs together, default {}: rigid")}};
  return table;
}

Row<TetSource> file_row() {
  return needed(Rows<TetSource>::text("file", &TetSource::file, "its name, relative to this file"));
}
Row<TetSource> place_row() {
  return Rows<TetSource>::vec3("place_mm", units::mm, &TetSource::place, -kFar, kFar,
                               "where its origin goes, default: the origin");
}

const Table<TetSource>& tet_mesh() {
  using R = Rows<TetSource>;
  static const Table<TetSource> table{
      "mesh",
      "Tetrahedra from a file: Gmsh .msh or legacy VTK.",
      {file_row(), R::number("unit_mm", units::mm, &TetSource::unit, 1e-6, 1e6, "unit of its coordinates, default {}"),
       R::number("refill_mm", units::mm, &TetSource::refill, 0, 100,
                 "its surface is filled again with tetrahedra in cubes of this size, default {}: the file's cells"),
       place_row()}};
  return table;
}

const Table<TetSource>& voxel_body() {
  using R = Rows<TetSource>;
  static const Table<TetSource> table{
      "voxels",
      "The body of one label of a segmented volume: NRRD, as 3D Slicer saves it.",
      {file_row(), needed(R::integer("label", &TetSource::label, 1, 65535, "the value of the organ's voxels")),
       R::integer("smoothing", &TetSource::smoothing, 0, 16, "smoothing passes against the voxels' steps, default {}"),
       place_row()}};
  return table;
}

/// Bounds what compile would have to make of it, before it tries.
void check_size(const JsonObject& o, const Solid& s) {
  double volume = 0, skin = 0;
  for (std::size_t i = 0; i + 1 < s.sections.size(); ++i) {
    const Section &a = s.sections[i], &b = s.sections[i + 1];
    const double height = length(b.centre - a.centre), top = area(a), bottom = area(b);
    volume += height / 3 * (top + bottom + std::sqrt(top * bottom));
    skin += height * 3 * (length(a.across) + length(a.deep) + length(b.across) + length(b.deep)) / 2;
  }
  if (s.shape.any()) {
    const ShapeSize size = size_of(s.shape);
    volume = size.volume, skin = size.area;
  }
  const double nodes = 1.3 * volume / (s.cell * s.cell * s.cell);
  if (o.has("cell_mm") && nodes > kMaxSolidNodes)
    o.fault("cell_mm",
            tr("expected a cell that fills the body with at most {} nodes, got about {:.3g}", kMaxSolidNodes, nodes));
  for (const auto& [key, edge] : {std::pair{"skin_edge_mm", s.skin_edge}, std::pair{"fine_edge_mm", s.fine_edge}})
    if (o.has(key) && 2.3 * skin / (edge * edge) > kMaxTriangles)
      o.fault(key, tr("expected an edge that gives at most {} triangles, got about {:.3g}", kMaxTriangles,
                      2.3 * skin / (edge * edge)));
}

bool is_lattice(const JsonObject& o, const Solid& s) {
  return !o.names("mesh") && !o.names("voxels") && !s.cuttable && !s.at_control_points();
}

/// Strokes that a direction can be read off.
void check_strokes(const JsonObject& o, const Solid& s) {
  std::size_t points = 0;
  for (std::size_t i = 0; i < s.fibre_strokes.size(); ++i) {
    const Stroke& stroke = s.fibre_strokes[i];
    points += stroke.size();
    for (std::size_t k = 1; k < stroke.size(); ++k)
      if (!(length(stroke[k] - stroke[k - 1]) >= 1e-5))
        return o.fault(o.at("fibres_mm", i),
                       "expected points at least 0.01 mm from the one before, got the same place twice");
  }
  if (points > kMostStrokePoints)
    o.fault("fibres_mm", tr("expected at most {} points of all strokes together, got {}", kMostStrokePoints, points));
}

/// Which way its fibres run is said once.
void check_fibres(const JsonObject& o, const Solid& s) {
  for (const char* key : {"fibre", "fibres_mm", "fibres_along", "fibre_ratio"})
    if (o.names(key) && s.at_control_points())
      o.fault(key, "expected no fibres where masses are control points, got some");
  const char* said = nullptr;
  for (const char* key : {"fibre", "fibres_mm", "fibres_along"}) {
    if (!o.names(key)) continue;
    if (said) o.fault(key, tr("expected one of fibre, fibres_mm and fibres_along, got it beside {}", said));
    said = key;
  }
  if (o.names("fibre") && !(length(s.fibre) > 1e-6)) o.fault("fibre", "expected a direction, got none");
  if (s.fibres_along && !s.shape.tube && !o.names("tube") && !o.names("sections"))
    o.fault("fibres_along", "expected a body with a middle line (sections or a tube), got another shape");
  check_strokes(o, s);
}

/// What belongs to a solid's shape.
void check_shape(const JsonObject& o, const Solid& s) {
  check_one_shape(o, {"sections", "mesh", "voxels", "surface", "nurbs", "tube", "revolved"});
  const bool filled = !o.names("mesh") && !s.at_control_points();
  if (filled && !o.names("cell_mm")) o.fault(o.at(), "expected \"cell_mm\", got none");
  if (!filled && o.names("cell_mm"))
    o.fault("cell_mm", o.names("mesh") ? "expected no cell_mm beside a mesh, whose cells are as they are, got one"
                                       : "expected no cell_mm where masses are control points, got one");
  const bool lattice = is_lattice(o, s);
  check_fibres(o, s);
  for (const char* key : {"elasticity", "beyond_deg", "beyond"})
    if (o.names(key) && !s.is_quasi_static())
      o.fault(key, "expected \"solver\": \"static\" beside it, got an organ that is solved step by step");
  for (const char* key : {"skin_edge_mm", "fine_edge_mm"})
    if (o.names(key) && !lattice && !s.at_control_points())
      o.fault(key, "expected skin edges for a lattice only, got one for tetrahedra, whose faces are the skin");
}

/// What masses at control points ask for.
void check_masses(const JsonObject& o, const Solid& s) {
  if (!s.at_control_points()) return;
  if (!o.names("nurbs")) return o.fault("masses", "expected control points of \"nurbs\", got another shape");
  if (s.is_quasi_static() && s.elasticity == Elasticity::tetrahedra)
    o.fault("elasticity", "expected springs where masses are control points, got tetrahedra");
  if (s.cuttable) o.fault("cuttable", "expected an organ that is not cuttable where masses are control points");
  if (!s.shape.nurbs) return;
  if (s.shape.nurbs->closing == NurbsShape::ring)
    o.fault("masses", "expected \"closed\": \"ends\" where masses are control points, got a ring");
  if ((s.shape.nurbs->degree[0] + 1) * (s.shape.nurbs->degree[1] + 1) > kMostCarriers)
    o.fault("masses", tr("expected degrees with at most {} control points per surface point, got {} and {}",
                         kMostCarriers, s.shape.nurbs->degree[0], s.shape.nurbs->degree[1]));
}

constexpr double kUsualCell = 0.005;  // [m] to continue with where the file says none

/// What is written nowhere: of a mesh none, of control points as wide as their net.
double cell_where_none_is_said(const Solid& s) {
  if (!s.at_control_points() || !s.shape.nurbs || s.shape.nurbs->net.empty()) return kUsualCell;
  return std::sqrt(size_of(s.shape).area / double(s.shape.nurbs->net.size())) + 1e-6;
}

void check_solid(const JsonObject& o, Solid& s, Context& c) {
  if (!o.has("cell_mm")) s.cell = cell_where_none_is_said(s);
  if (o.has("mesh")) s.cell = 0;
  check_shape(o, s);
  check_masses(o, s);
  for (const JsonObject& mesh : o.objects("mesh")) c.reading->mesh_of(mesh, tet_mesh().made(mesh, c), c.folder, s);
  for (const JsonObject& part : o.objects("voxels")) {
    TetSource source;
    source.label = 1;
    voxel_body().read(part, source, c);
    c.reading->voxels_of(part, std::move(source), c.folder, s);
  }
  if (!o.has("skin_edge_mm")) s.skin_edge = s.at_control_points() ? 0.5 * s.cell : s.cell;
  if (!o.has("fine_edge_mm")) s.fine_edge = s.skin_edge / 2;
  if (!s.tets) check_size(o, s);
}

bool of_mesh(const Solid& s) { return s.tets && s.tets->label == 0; }
bool of_voxels(const Solid& s) { return s.tets && s.tets->label > 0; }
bool of_lattice(const Solid& s) { return !s.tets && !s.cuttable; }
bool of_cells(const Solid& s) { return !of_mesh(s) && !s.at_control_points(); }

/// Do degrees, knots and weights go with the net?
void check_patch(const JsonObject& o, const Wall& w) {
  for (const char* key : {"net_mm", "weights", "degree", "knots_u", "knots_v"})
    if (o.names(key) && !o.has(key)) return;
  if (!w.weights.empty() && w.weights.size() != w.net.size())
    o.fault("weights", tr("expected one for each of {} control points, got {}", w.net.size(), w.weights.size()));
  for (const auto& [key, way] : {std::pair{"knots_u", 0}, std::pair{"knots_v", 1}}) {
    try {
      if (o.has("net_mm")) knots_of(w, way);
    } catch (const std::invalid_argument& e) {
      o.fault(o.names(key) ? key : "degree", tr("expected knots that go with the net, got: {}", e.what()));
    }
  }
}

void check_wall(const JsonObject& o, Wall& w, Context&) {
  double surface = 0;
  for (int r = 0; r + 1 < w.rows; ++r)
    for (int c = 0; c + 1 < w.columns; ++c) {
      const Vec3d* p = w.net.data() + r * w.columns + c;
      surface += length(cross(p[w.columns + 1] - p[0], p[w.columns] - p[1])) / 2;
    }
  check_patch(o, w);
  if (o.has("edge_mm") && 2.3 * surface / (w.edge * w.edge) > kMaxTriangles)
    o.fault("edge_mm", tr("expected an edge that gives at most {} triangles, got about {:.3g}", kMaxTriangles,
                          2.3 * surface / (w.edge * w.edge)));
}

void read_net(const JsonObject& o, Wall& w, Context&) {
  PointGrid grid = o.grid("net_mm");
  w.rows = int(grid.rows);
  w.columns = int(grid.columns);
  for (const Vec3d& p : grid.points) w.net.push_back(p / 1000.0);
}

std::optional<JsonValue> written_net(const Wall& w, bool) { return written_rows(w.net, w.columns); }

/// Its shape's rows after the first three, the others behind them.
std::vector<Row<Solid>> with_shapes(std::vector<Row<Solid>> rows) {
  std::vector<Row<Solid>> shapes = shape_rows<Solid>();
  const auto behind =
      std::find_if(rows.begin(), rows.end(), [](const Row<Solid>& r) { return r.key.name == "cell_mm"; });
  rows.insert(behind, std::make_move_iterator(shapes.begin()), std::make_move_iterator(shapes.end()));
  return rows;
}

std::vector<Row<Description>> organ_rows() {
  using R = Rows<Description>;
  return {
      R::own(keys::name("name", "its name")),
      R::own(keys::includes(
                 "organs", []() -> const Shape& { return organ_keys(); }, "organs that belong to it: files or objects"),
             [](const JsonObject& o, Description&, Context& c) { c.reading->organs(o, c.folder); }),
      R::objects("solids", solid, &Description::solids, 0, "volumetric organs"),
      R::objects("strands", strand, &Description::strands, 0, "tubes and cords"),
      R::objects("walls", wall, &Description::walls, 0, "surfaces that do not move"),
      R::objects("sheets", sheet, &Description::sheets, 0, "folds for display only"),
      R::objects("membranes", membrane, &Description::membranes, 0, "folds with mechanics"),
      R::objects("pouches", pouch, &Description::pouches, 0, "closed membranes with contents")};
}

}  // namespace

const Table<StiffnessRegion>& stiffness_region() {
  using R = Rows<StiffnessRegion>;
  static const Table<StiffnessRegion> table{
      "stiffness region",
      "A local change of stiffness: full within half of its radius, fading out to the radius. A later one "
      "paints "
      "over those before; 1 restores the tissue.",
      {needed(R::vec3("centre_mm", units::mm, &StiffnessRegion::centre, -kFar, kFar, "centre of the ball")),
       needed(R::number("radius_mm", units::mm, &StiffnessRegion::radius, 0.1, 500, "nothing beyond it")),
       needed(R::number("stiffness", units::one, &StiffnessRegion::stiffness, 0.1, 10, "times the tissue's"))}};
  return table;
}

const Table<Section>& section() {
  using R = Rows<Section>;
  static const Table<Section> table{
      "section",
      "A cross-section of a lofted body: a super-ellipse with two half-axis vectors.",
      {needed(R::vec3("centre_mm", units::mm, &Section::centre, -kFar, kFar, "centre")),
       needed(R::vec3("across_mm", units::mm, &Section::across, -500, 500, "first half axis")),
       needed(R::vec3("deep_mm", units::mm, &Section::deep, -500, 500, "second half axis")),
       R::number("squareness", units::one, &Section::squareness, 1, 10,
                 "exponent of the super-ellipse, default {}: an ellipse")},
      check_section};
  return table;
}

const Table<Solid>& solid() {
  using R = Rows<Solid>;
  static const Table<Solid> table{
      "solid",
      "A volumetric organ. Its shape is one of: sections (a smooth loft), surface, nurbs, tube, revolved, mesh, "
      "voxels. "
      "Mesh and voxels are tetrahedra; the others are filled with an elastic lattice of cubic cells, or with "
      "tetrahedra "
      "where they are cuttable.",
      with_shapes(
          {needed(R::name("name", &Solid::name, "its name in scenes and exercises")),
           needed(R::ref("tissue", Reference::To::tissue, &Solid::tissue, "its material")),
           look_row<Solid>(),
           R::objects("sections", section, &Solid::sections, 2, "from one end to the other",
                      [](const JsonObject& o, Solid& s, Context&) { check_last_section(o, s); }),
           R::own(keys::object(
                      "mesh", []() -> const Shape& { return tet_mesh(); }, "tetrahedra from a file"),
                  nullptr,
                  [](const Solid& s, bool) {
                    return of_mesh(s) ? std::optional<JsonValue>(tet_mesh().written(*s.tets)) : std::nullopt;
                  }),
           R::own(keys::object(
                      "voxels", []() -> const Shape& { return voxel_body(); },
                      "a label of a volume, filled with tetrahedra"),
                  nullptr,
                  [](const Solid& s, bool) {
                    return of_voxels(s) ? std::optional<JsonValue>(voxel_body().written(*s.tets)) : std::nullopt;
                  }),
           R::number("cell_mm", units::mm, &Solid::cell, 0.1, 100,
                     "edge of the lattice's cubes; needed but for a mesh and for masses at control points")
               .placed(&Solid::cell_at)
               .only(of_cells),
           R::choice(
               "masses", Choices<Masses>{{"inside", Masses::inside}, {"control_points", Masses::control_points}},
               &Solid::masses,
               "inside: in the cells that fill it; control_points: at the control points of its nurbs and below them, "
               "so that its surface stays that NURBS; default {}"),
           R::flag("cuttable", &Solid::cuttable, "can it be cut anywhere, so that pieces detach? default {}"),
           R::vec3("fibre", units::one, &Solid::fibre, -1, 1, "direction of its fibres everywhere, default: none"),
           R::lines("fibres_mm", units::mm, &Solid::fibre_strokes, -kFar, kFar, 2,
                    "strokes along its fibres, instead of one direction: fibres follow the nearest stroke"),
           R::flag("fibres_along", &Solid::fibres_along,
                   "true: its fibres run along the middle line of its sections or its tube; default {}"),
           R::number("fibre_ratio", units::one, &Solid::fibre_ratio, 0.2, 5,
                     "stiffness along the fibres over across, default {}"),
           R::objects("regions", stiffness_region, &Solid::regions, 0, "local changes of stiffness"),
           R::number("skin_edge_mm", units::mm, &Solid::skin_edge, 0.2, 100,
                     "edge of the touched skin's triangles, default: cell_mm")
               .only(of_lattice),
           R::number("fine_edge_mm", units::mm, &Solid::fine_edge, 0.1, 100,
                     "edge of the drawn skin's triangles, default: half of skin_edge_mm")
               .only(of_lattice),
           R::objects("anchors", anchor, &Solid::anchors, 0, "what holds it"),
           R::choice("solver", Choices<Solver>{{"dynamic", Solver::dynamic_network}, {"static", Solver::elastostatic}},
                     &Solid::solver,
                     "dynamic: springs and masses, step by step; static: quasi-static linear elastostatics, "
                     "without inertia; default {}")
               .placed(&Solid::solver_at),
           R::choice(
               "elasticity",
               Choices<Elasticity>{{"springs", Elasticity::springs}, {"tetrahedra", Elasticity::tetrahedra}},
               &Solid::elasticity,
               "of a static solver: of the organ's springs, as the dynamic one has them, or of linear tetrahedra; "
               "default {}"),
           R::number(
               "beyond_deg", units::deg, &Solid::beyond_angle, 0.1, 180,
               "of a static solver: turn of the whole organ, or largest displacement beside that over the organ's size "
               "(57.3 degrees: as large as it), beyond which the solver is inaccurate, default {}"),
           R::choice(
               "beyond",
               Choices<BeyondLinear>{{"warn", BeyondLinear::warn}, {"hand_over", BeyondLinear::switch_to_dynamic}},
               &Solid::beyond, "then: warn, or switch to the dynamic solver permanently; default {}")}),
      check_solid};
  return table;
}

const Table<Wall>& wall() {
  using R = Rows<Wall>;
  static const Table<Wall> table{
      "wall",
      "A surface that does not move: a NURBS patch over a net of control points; d/drow x d/dcolumn points to the free "
      "side.",
      {needed(R::name("name", &Wall::name, "its name")), look_row<Wall>(),
       needed(R::own(keys::grid("net_mm", -kFar, kFar, 2, "rows of control points"), read_net, written_net)),
       weights_row<Wall>(),
       degree_row<Wall>("along a row and along a column, default: 3, or one less than there are points"),
       R::numbers("knots_u", &Wall::knots_u, -1e6, 1e6, 2,
                  "those along a row, from end to end: columns - degree + 1; default: uniform"),
       R::numbers("knots_v", &Wall::knots_v, -1e6, 1e6, 2,
                  "those along a column, from end to end: rows - degree + 1; default: uniform"),
       R::number("edge_mm", units::mm, &Wall::edge, 0.5, 200, "edge of its triangles, default {}")},
      check_wall};
  return table;
}

const Table<Description>& organ_keys() {
  static const Table<Description> table{"organ", "Bodies that belong together, in the scene's frame.", organ_rows()};
  return table;
}
const Table<Description>& organ_file_keys() {
  static const Table<Description> table{"organ file", "Bodies that belong together, in the scene's frame.",
                                        of_file(organ_rows())};
  return table;
}

bool check_apart(const JsonObject& o, const char* key, const std::vector<Vec3d>& points) {
  bool apart = true;
  for (std::size_t i = 1; i < points.size(); ++i)
    if (!(length(points[i] - points[i - 1]) >= 1e-5)) {
      o.fault(o.at(key, i), "expected a point at least 0.01 mm from the one before, got the same place");
      apart = false;
    }
  return apart;
}

}  // namespace trocar::scene
