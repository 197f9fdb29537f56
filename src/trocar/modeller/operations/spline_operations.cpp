// Bodies as NURBS: made of lofts and of meshes that somebody segmented, and their control nets made finer or plainer.
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/nurbs/spline_bridge.hpp>
#include <trocar/geometry/nurbs/surface_edit.hpp>
#include <trocar/geometry/nurbs_fit/fit.hpp>
#include <trocar/geometry/surfaces/loft.hpp>
#include <trocar/modeller/operations/file_mesh.hpp>
#include <trocar/modeller/operations/kinds.hpp>
#include <trocar/modeller/operations/places.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/scene/json/json_edit.hpp>

namespace trocar::modeller {
namespace {

namespace keys = scene::keys;
namespace nurbs = geometry::nurbs;
using scene::JsonObject;
using scene::JsonValue;

JsonValue numbers(const std::vector<double>& values) {
  std::vector<JsonValue> items;
  for (const double v : values) items.push_back(scene::json_number(v));
  return scene::json_array(std::move(items));
}

/// As files have it. Millimetres keep seven digits behind the point: shapes shall stay under knots put in.
JsonValue written(const scene::NurbsShape& shape) {
  const auto place = [](Vec3d p) {
    const auto mm = [](double v) { return scene::json_number(std::round(v * 1e10) / 1e7); };
    return scene::json_array({mm(p.x), mm(p.y), mm(p.z)});
  };
  std::vector<JsonValue> rows, weights;
  for (int r = 0; r < shape.rows; ++r) {
    std::vector<JsonValue> row, row_weights;
    for (int c = 0; c < shape.columns; ++c) {
      row.push_back(place(shape.net[std::size_t(r * shape.columns + c)]));
      if (!shape.weights.empty())
        row_weights.push_back(scene::json_number(shape.weights[std::size_t(r * shape.columns + c)]));
    }
    rows.push_back(scene::json_array(std::move(row)));
    if (!row_weights.empty()) weights.push_back(scene::json_array(std::move(row_weights)));
  }
  JsonValue out = scene::json_object();
  scene::put(out, "degree",
             scene::json_array({scene::json_number(shape.degree[0]), scene::json_number(shape.degree[1])}));
  scene::put(out, "net_mm", scene::json_array(std::move(rows)));
  if (!weights.empty()) scene::put(out, "weights", scene::json_array(std::move(weights)));
  if (!shape.knots_u.empty()) scene::put(out, "knots_u", numbers(shape.knots_u));
  if (!shape.knots_v.empty()) scene::put(out, "knots_v", numbers(shape.knots_v));
  if (shape.closing == scene::NurbsShape::ring) scene::put(out, "closed", scene::json_text("ring"));
  return out;
}

/// The solid or pouch as it is described now. @throws core::BadInput
template <class Body>
const Body* found(const std::vector<Body>& bodies, const std::string& name) {
  for (const Body& body : bodies)
    if (body.name == name) return &body;
  return nullptr;
}

struct Described {
  std::vector<scene::Section> sections;
  scene::ClosedShape shape;
};
Described described(const Draft& draft, const Thing& thing) {
  std::vector<core::Fault> faults;
  const std::optional<scene::Description> d = draft.document().description(faults);
  if (!d || !faults.empty()) throw core::BadInput(std::move(faults));
  if (const scene::Solid* solid = found(d->solids, thing.name)) return {solid->sections, solid->shape};
  if (const scene::Pouch* pouch = found(d->pouches, thing.name)) return {pouch->sections, pouch->shape};
  return {};
}

/// The NURBS of a body that has one; a body that has none is told through `o`.
std::optional<nurbs::Surface> spline_of_thing(const JsonObject& o, const Draft& draft, const Thing& thing) {
  const Described body = described(draft, thing);
  if (body.shape.nurbs) return scene::surface_of(*body.shape.nurbs);
  o.fault("of", "expected a body that is a NURBS, got another one: make it one with to_spline first");
  return std::nullopt;
}

/// What described it before goes.
void put_spline(Draft& draft, const Thing& thing, const nurbs::Surface& surface) {
  for (const char* key : {"sections", "surface", "tube", "revolved"})
    if (draft.value(thing.file, thing.path).find(key)) draft.remove(thing.file, thing.path + "/" + key);
  draft.set(thing.file, thing.path + "/nurbs", written(scene::shape_of(surface)));
}

Operation to_spline() {
  return {{"to_spline",
           "Describes a lofted body, a tube or a body of revolution by a NURBS, the same shape, so that its control "
           "points can be moved.",
           {scene::needed(keys::text("of", "its name"))}},
          [](const JsonObject& o, Draft& draft) {
            const Thing thing = draft.thing(o.text("of"));
            const Described body = described(draft, thing);
            if (const std::optional<nurbs::Surface> spline = scene::spline_of(body.shape))
              return put_spline(draft, thing, *spline);
            if (body.sections.size() < 2)
              return o.fault("of", "expected a body with sections, a tube or a profile, got another one");
            std::vector<geometry::Section> sections;
            for (const scene::Section& s : body.sections)
              sections.push_back({s.centre, s.across, s.deep, s.squareness});
            put_spline(draft, thing, nurbs::nurbs_of(geometry::loft(sections)));
          }};
}

scene::Key way_key() {
  return scene::needed(keys::choice("way", {"around", "along"}, "in which direction of the net"));
}
nurbs::Along way_of(const JsonObject& o) { return o.text("way") == "around" ? nurbs::Along::u : nurbs::Along::v; }

Operation insert_knot() {
  return {{"insert_knot",
           "One more row of control points; the shape stays.",
           {scene::needed(keys::text("of", "the body's name")), way_key(),
            scene::needed(keys::number("at", 0, 1, "where, from one end or side to the other"))}},
          [](const JsonObject& o, Draft& draft) {
            const Thing thing = draft.thing(o.text("of"));
            if (const auto surface = spline_of_thing(o, draft, thing))
              put_spline(draft, thing, nurbs::inserted(*surface, way_of(o), o.number("at")));
          }};
}

Operation remove_knot() {
  return {{"remove_knot",
           "One row of control points less, where the shape changes by no more than so much.",
           {scene::needed(keys::text("of", "the body's name")), way_key(),
            scene::needed(keys::number("at", 0, 1, "which knot: the nearest one")),
            keys::number("tolerance_mm", 0, 100, "by how much the shape may change, default 0.01")}},
          [](const JsonObject& o, Draft& draft) {
            const Thing thing = draft.thing(o.text("of"));
            const auto surface = spline_of_thing(o, draft, thing);
            if (!surface) return;
            const std::vector<double> all = nurbs::breaks(nurbs::knots_along(*surface, way_of(o)));
            double knot = all.front();
            for (std::size_t i = 1; i + 1 < all.size(); ++i)
              if (i == 1 || std::fabs(all[i] - o.number("at")) < std::fabs(knot - o.number("at"))) knot = all[i];
            const double tolerance = o.number("tolerance_mm", 0.01);
            const auto less = nurbs::without_knot(*surface, way_of(o), knot, tolerance * 1e-3);
            if (!less)
              return o.fault(
                  "at",
                  tr("expected a knot without which the shape changes by at most {:g} mm, got {:.3f}, which it needs",
                     tolerance, knot));
            put_spline(draft, thing, *less);
          }};
}

Operation raise_degree() {
  return {{"raise_degree",
           "Polynomials of a degree more; the shape stays.",
           {scene::needed(keys::text("of", "the body's name")), way_key()}},
          [](const JsonObject& o, Draft& draft) {
            const Thing thing = draft.thing(o.text("of"));
            if (const auto surface = spline_of_thing(o, draft, thing))
              put_spline(draft, thing, nurbs::elevated(*surface, way_of(o)));
          }};
}

/// The best of fits with less and with more smoothing: where the first one bulges between the mesh's vertices, which
/// only the way back from it to the mesh tells, another one does not.
nurbs::Fit best_fit(const geometry::TriMesh& mesh, nurbs::BodyFitOptions options) {
  const auto badness = [](const nurbs::FitReport& r) { return std::max(r.rms, r.back_rms); };
  nurbs::Fit best = nurbs::fit_body(mesh, options);
  const geometry::Bounds box = geometry::bounds(mesh.positions);
  const double between = length(box.high - box.low) / (options.along + options.around);
  for (const double smoothing : {0.5 * between, between, 2 * between}) {
    if (best.report.back_greatest < 4 * best.report.greatest) break;
    options.smoothing = smoothing;
    nurbs::Fit next = nurbs::fit_body(mesh, options);
    if (badness(next.report) < badness(best.report)) best = std::move(next);
  }
  return best;
}

Operation fit() {
  return {{"fit_spline",
           "Fits a NURBS body to a mesh from a file: OBJ, STL, PLY, glTF, VTK. Holes are closed first.",
           {scene::needed(keys::text("file", "the mesh, relative to the document")),
            scene::needed(keys::name("name", "what the body is called")),
            scene::needed(keys::name("tissue", "its material")),
            scene::needed(keys::number("cell_mm", 0.1, 100, "edge of its cells")),
            keys::text("part", "of several parts in the file, default: all"),
            keys::number("unit_mm", 1e-6, 1e6,
                         "unit of its coordinates, default: what its format says or its size suggests"),
            keys::integer("around", 4, 64, "control points around, default 16"),
            keys::integer("along", 5, 96, "control points from pole to pole, default 24"),
            keys::number("most_mm", 0.001, 100, "greatest rms distance that is taken, default 1"),
            keys::vec3("place_mm", -2000, 2000, "where the file's origin goes, default where it is")}},
          [](const JsonObject& o, Draft& draft) {
            const fs::path path = whole_path(draft.document().root().parent_path() / o.text("file"));
            std::optional<FileMesh> there = mesh_from_file(o, path);
            if (!there) return;
            geometry::TriMesh& mesh = there->mesh;
            for (Vec3d& p : mesh.positions) p = p + o.vec3("place_mm") * 1e-3;
            nurbs::BodyFitOptions options;
            options.around = o.integer("around", 16);
            options.along = o.integer("along", 24);
            const nurbs::Fit made = best_fit(mesh, options);
            const double off = 1e3 * std::max(made.report.rms, made.report.back_rms);
            if (off > o.number("most_mm", 1))
              return o.fault("most_mm", tr("expected a fit within {:g} mm rms both ways, got {:.3f} mm: more control "
                                           "points may help",
                                           o.number("most_mm", 1), off));
            JsonValue solid = scene::json_object();
            scene::put(solid, "name", scene::json_text(o.text("name")));
            scene::put(solid, "tissue", scene::json_text(o.text("tissue")));
            scene::put(solid, "nurbs", written(scene::shape_of(made.surface)));
            scene::put(solid, "cell_mm", number(o.number("cell_mm")));
            add_thing(draft, "solid", solid, "");
            draft.say(tr("fitted within {:.3f} mm rms, {:.2f} mm at most, back {:.3f} and {:.2f} mm, volume {:+.2f} %",
                         1e3 * made.report.rms, 1e3 * made.report.greatest, 1e3 * made.report.back_rms,
                         1e3 * made.report.back_greatest,
                         100 * (made.report.volume_of_fit / made.report.volume_of_mesh - 1)));
            draft.say(there->notes);
          }};
}

}  // namespace

std::vector<Operation> spline_operations() {
  return {to_spline(), insert_knot(), remove_knot(), raise_degree(), fit()};
}

}  // namespace trocar::modeller
