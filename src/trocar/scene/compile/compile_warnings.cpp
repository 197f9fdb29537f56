#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/compile/compile_warnings.hpp>
#include <trocar/scene/compile/mesh_cost.hpp>
#include <trocar/sim/model/bodies.hpp>

namespace trocar::scene {
namespace {

Vec3d corner(const tissue::Skin& skin, int vertex) { return vec_cast<double>(skin.rest[size_t(vertex)]); }

/// Is p within a closed skin in the drawn shape? By the solid angle that it sees of it: a full sphere, or nothing
/// [van Oosterom & Strackee 1983].
bool encloses(const tissue::Skin& skin, Vec3d p) {
  double angle = 0;
  for (const auto& t : skin.triangles) {
    const Vec3d a = corner(skin, t[0]) - p, b = corner(skin, t[1]) - p, c = corner(skin, t[2]) - p;
    const double la = length(a), lb = length(b), lc = length(c);
    const double whole = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    angle += 2 * portable::atan2(dot(a, cross(b, c)), whole);
  }
  return std::fabs(angle) > 2 * portable::pi;
}

/// How far below the drawn surface of a closed skin p is [m]; 0 outside.
double depth_in(const tissue::Skin& skin, Vec3d p) {
  tissue::Box box;
  for (const Vec3f& v : skin.rest) box.add(v);
  if (!box.reaches(p, 0) || !encloses(skin, p)) return 0;
  double least2 = 1e30;
  for (const auto& t : skin.triangles)
    least2 = std::min(
        least2, geometry::closest_on_triangle(p, corner(skin, t[0]), corner(skin, t[1]), corner(skin, t[2])).distance2);
  return std::sqrt(least2);
}

/// The closed surface that holds a point deepest, if one does.
struct Inside {
  std::string name;
  double depth = kTouchDepth;  ///< [m]
  Vec3d at;
};
void look_inside(const sim::Model& model, Vec3d p, Inside& found) {
  const auto look = [&](const std::string& name, const tissue::Skin& skin) {
    const double depth = depth_in(skin, p);
    if (depth > found.depth) found = {name, depth, p};
  };
  for (int organ = 0; organ < model.organs(); ++organ) look(model.organ_name(organ), model.skin(organ));
  for (const sim::MembraneBody& m : model.membranes)
    if (m.sheet.closed()) look(m.name, m.skin);
}

void warn_inside(const Inside& found, const core::Location& at, const std::string& what,
                 std::vector<core::Fault>& warnings) {
  if (found.name.empty()) return;
  warnings.push_back(
      {at, tr("expected the tip of '{}' outside of tissue, got one that begins {:.1f} mm inside "
              "'{}', at ({:.1f}, {:.1f}, {:.1f}) mm",
              what, 1e3 * found.depth, found.name, 1e3 * found.at.x, 1e3 * found.at.y, 1e3 * found.at.z)});
}

/// Sub-steps of a solid organ as it was built; 0: there is none of this name.
int substeps_of(const sim::Model& model, const std::string& name) {
  return sim::visit(
      model, sim::body_of(model, name), 0,
      sim::Overloaded{[&](sim::SolidRef r) { return model_of(model, r).network.substeps; },
                      [&](sim::CuttableRef r) { return model_of(model, r).body.substeps; }, [](auto) { return 0; }});
}

void find_slivers(const Description& d, const Solid& solid, const sim::Model& model,
                  std::vector<core::Fault>& warnings) {
  if (solid.tets->label > 0 || solid.tets->refill > 0) return;
  const int substeps = substeps_of(model, solid.name);
  if (substeps < kManySubsteps) return;
  for (const Tissue& tissue : d.tissues) {
    if (tissue.name != solid.tissue) continue;
    MeshCost now = cost_of(solid.tets->mesh, tissue);
    now.substeps = substeps;  // with its anchors and fibres
    now.tick = tick_of(now.springs, substeps);
    if (const std::optional<Refill> refill = refill_of(solid.tets->mesh, tissue, now))
      warnings.push_back({solid.at, tr("the mesh '{}' of '{}' has {}", solid.tets->file, solid.name,
                                       in_words(solid.tets->mesh, now, *refill))});
  }
}

void warn_mended(const ClosedShape& shape, const std::string& body, const core::Location& at,
                 std::vector<core::Fault>& warnings) {
  if (!shape.surface) return;
  for (const std::string& warning : shape.surface->warnings)
    warnings.push_back({at, tr("the surface '{}' of '{}': {}", shape.surface->file, body, warning)});
}

void find_tips(const Description& d, const sim::Model& model, std::vector<core::Fault>& warnings) {
  size_t hand = 0;
  for (const Placement& p : d.placements) {
    if (hand == model.hands.size()) break;
    if (model.hands[hand].name != p.port) continue;
    const sim::ToolInput& in = model.start.tools[hand];
    const interactions::ToolShape shape = interactions::shape_of(
        model.placed(hand), {double(in.yaw), double(in.pitch), double(in.roll), double(in.depth)}, 1);
    ++hand;
    Inside found;
    for (const Vec3d& tip : {shape.part[interactions::kJawA].b, shape.part[interactions::kJawB].b, shape.pivot})
      look_inside(model, tip, found);
    warn_inside(found, p.at, p.instrument, warnings);
  }
  Inside found;
  look_inside(model, d.scope_placement.tip, found);
  warn_inside(found, d.scope_placement.at, "scope", warnings);
}

}  // namespace

void find_warnings(const Description& d, const sim::Model& model, std::vector<core::Fault>& warnings) {
  for (const Solid& solid : d.solids) {
    warn_mended(solid.shape, solid.name, solid.at, warnings);
    if (!solid.tets) continue;
    for (const std::string& warning : solid.tets->warnings)
      warnings.push_back({solid.at, tr("the mesh '{}' of '{}': {}", solid.tets->file, solid.name, warning)});
    find_slivers(d, solid, model, warnings);
  }
  for (const Pouch& pouch : d.pouches) warn_mended(pouch.shape, pouch.name, pouch.at, warnings);
  find_tips(d, model, warnings);
}

}  // namespace trocar::scene
