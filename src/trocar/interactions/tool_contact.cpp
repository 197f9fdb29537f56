#include <algorithm>
#include <array>

#include <trocar/geometry/nearest.hpp>
#include <trocar/interactions/tool_contact.hpp>

namespace trocar::interactions {
namespace {

constexpr double kSurfaceStiffness = 1500;  // [N/m] per skin vertex, implicit: decides how firm, never how stable
constexpr double kStrandStiffness = 1500;   // [N/m] per strand element
constexpr double kQuickest = 0.0012;        // [m] a tick that a contact moves a skin: twice the fastest hand, no shots
constexpr double kQuickestStrand = 0.003;   // [m] the same for a strand, which is light and must not be overtaken
constexpr double kDamping = 0.3;            // [N s/m] along the contact normal
constexpr double kBehind = 0.006;           // [m] how deep behind the surface an instrument is still pushed out

bool meets(const tissue::Box& box, const Capsule& rod) noexcept {
  return box.near_segment(rod.a, rod.b, rod.radius + kBehind);
}

}  // namespace

namespace {

/// The nearest point of the skin to p: a triangle at the nearest vertex.
struct SkinPoint {
  std::array<int, 3> vertex{};
  Vec3d weights, point, normal;
};

int nearest_vertex_near(const Surface& surface, Vec3d p, double reach) noexcept {
  const tissue::SkinPose& pose = *surface.pose;
  int best = -1;
  double least = reach * reach;
  for (size_t b = 0; b < pose.block.size(); ++b) {
    if (!pose.block[b].reaches(p, reach)) continue;
    const int last = std::min(int(b + 1) * tissue::kSkinBlock, surface.skin->size());
    for (int v = int(b) * tissue::kSkinBlock; v < last; ++v) {
      const double d = geometry::distance2(surface.position(v), p);
      if (d >= least || !surface.skin->at_surface(v)) continue;
      least = d;
      best = v;
    }
  }
  return best;
}

SkinPoint nearest_skin_point(const Surface& surface, int vertex, Vec3d p) noexcept {
  const tissue::Skin& skin = *surface.skin;
  SkinPoint best;
  double least = 1e9;
  for (int k = skin.face_first[size_t(vertex)]; k < skin.face_first[size_t(vertex) + 1]; ++k) {
    const auto& t = skin.triangles[size_t(skin.face[size_t(k)])];
    const auto on =
        geometry::closest_on_triangle(p, surface.position(t[0]), surface.position(t[1]), surface.position(t[2]));
    if (on.distance2 >= least) continue;
    least = on.distance2;
    best.vertex = t;
    best.weights = on.weights;
    best.point = on.point;
  }
  for (size_t k = 0; k < 3; ++k) best.normal += best.weights[int(k)] * surface.normal(best.vertex[k]);
  best.normal = normalised(best.normal, surface.normal(vertex));
  return best;
}

/// A ball of the instrument presses the skin in, whatever lies between the skin's vertices.
void press(const Surface& surface, Vec3d p, double radius, Tag tag, NetworkLoads& loads) noexcept {
  const int vertex = nearest_vertex_near(surface, p, radius + kBehind);
  if (vertex < 0) return;
  const SkinPoint at = nearest_skin_point(surface, vertex, p);
  const double depth = radius - dot(p - at.point, at.normal);
  if (depth <= 0 || depth > radius + kBehind) return;
  for (size_t k = 0; k < 3; ++k) {
    const double share = at.weights[int(k)];
    if (share < 0.02) continue;
    SkinLoad load;
    load.k = share * kSurfaceStiffness;
    load.shift = -depth * at.normal;
    load.dir = -at.normal;
    load.d = share * kDamping;
    add_skin_load(surface.nodes, *surface.skin, at.vertex[k], load, tag, loads);
  }
}

/// Closed jaws are a blunt rod that is thinner than the skin's triangles: points along it are pressed against the skin.
/// Open jaws are not, so that a fold can rise between them.
void closed_jaws_on_surface(const ToolShape& shape, int tool, const Surface& surface, NetworkLoads& loads) noexcept {
  const Capsule &a = shape.part[kJawA], &b = shape.part[kJawB];
  if (length(a.b - b.b) > 2.5 * (a.radius + b.radius)) return;
  constexpr double kSpacing = 0.002;
  const double far = length(shape.frame.tip - shape.pivot);
  if (!surface.pose->bounds.near_segment(shape.pivot, shape.frame.tip, kBehind + a.radius)) return;
  for (double back = 0; back < far; back += kSpacing)
    press(surface, shape.frame.tip - back * shape.frame.axis(), a.radius + b.radius, {Owner::tool_contact, tool, kJawA},
          loads);
}

}  // namespace

void tool_on_surface(const ToolShape& shape, int tool, const Surface& surface, NetworkLoads& loads) noexcept {
  const tissue::SkinPose& pose = *surface.pose;
  for (int part = 0; part < kToolParts; ++part) {
    const Capsule& rod = shape.part[part];
    if (!meets(pose.bounds, rod)) continue;
    for (size_t b = 0; b < pose.block.size(); ++b) {
      if (!meets(pose.block[b], rod)) continue;
      const int last = std::min(int(b + 1) * tissue::kSkinBlock, surface.skin->size());
      for (int v = int(b) * tissue::kSkinBlock; v < last; ++v) {
        if (!surface.skin->at_surface(v)) continue;
        const Vec3d p = surface.position(v);
        if (length(p - collision::nearest_on_axis(rod, p)) > rod.radius + kBehind) continue;
        const collision::Push push = collision::push_out(rod, p, surface.normal(v), kBehind);
        if (push.depth <= 0) continue;
        SkinLoad load;
        load.k = kSurfaceStiffness;
        load.shift = std::min(push.depth, kQuickest) * push.direction;
        load.dir = push.direction;
        load.d = kDamping;
        add_skin_load(surface.nodes, *surface.skin, v, load, {Owner::tool_contact, tool, part}, loads);
      }
    }
  }
  closed_jaws_on_surface(shape, tool, surface, loads);
}

BetweenJaws between_jaws(const ToolModel& model, const ToolShape& shape, const StrandBody& body,
                         const tissue::StrandState& state, int element) noexcept {
  BetweenJaws r;
  const size_t e = size_t(element);
  const Vec3d a = to_jaw(shape, state.x[e]), b = to_jaw(shape, state.x[e + 1]);
  const double dy = b.y - a.y;
  r.w = std::fabs(dy) > 1e-9 ? std::clamp(-a.y / dy, 0.0, 1.0) : 0.5;
  r.local = a + r.w * (b - a);
  r.crosses = (a.y > 0) != (b.y > 0);
  const double radius = body.model.radius[e];
  if (std::fabs(r.local.y) > 0.5 * model.jaw_width + 0.001) return r;
  if (r.local.z < -radius || r.local.z > model.jaw_length + 0.5 * radius) return r;
  r.inside = std::fabs(r.local.x) <= shape.half_opening(std::max(r.local.z, 0.0)) + 0.3 * radius;
  return r;
}

namespace {

/// Keeps a strand element that lies between the jaws from passing through them sideways.
void channel(const ToolShape& shape, const BetweenJaws& where, double radius, int element, Tag tag,
             StrandLoads& loads) noexcept {
  const double half = shape.half_opening(std::max(where.local.z, 0.0));
  const double squeezed = std::min(radius, std::max(half, 0.35 * radius));
  const double over = std::fabs(where.local.x) + squeezed - half;
  if (over <= 0) return;
  const Vec3d inward = (where.local.x > 0 ? -1.0 : 1.0) * shape.frame.opening();
  const double depth = std::min({over, std::fabs(where.local.x), kQuickestStrand});
  if (depth <= 0) return;
  tissue::StrandLoad load;
  load.element = element;
  load.w = where.w;
  load.k = kStrandStiffness;
  load.dir = inward;
  load.d = kDamping;
  load.x0 = from_jaw(shape, where.local) + depth * inward;
  loads.add(load, tag);
}

}  // namespace

void tool_on_strand(const ToolModel& model, const ToolShape& shape, const ToolState& tool_state, int tool,
                    const StrandBody& body, int strand, const tissue::StrandState& state, std::span<Vec3f> side,
                    StrandLoads& loads) noexcept {
  const auto is_held = [&](int element) {
    for (int h = 0; h < tool_state.holds; ++h)
      if (tool_state.hold[h].body == strand && std::abs(tool_state.hold[h].element - element) <= 1) return true;
    return false;
  };
  // Next to where the strand runs between the jaws it touches their edges from within: that is the channel's business.
  constexpr int kEdge = 3;
  int first_inside = body.nodes(), last_inside = -1;
  for (int e = 0; e + 1 < body.nodes(); ++e) {
    if (!state.alive[size_t(e)]) continue;
    const BetweenJaws where = between_jaws(model, shape, body, state, e);
    if (!where.inside || !where.crosses) continue;
    first_inside = std::min(first_inside, e);
    last_inside = e;
  }
  const Capsule whole{shape.part[kShaft].a, shape.frame.tip, 0};
  for (int e = 0; e + 1 < body.nodes(); ++e) {
    if (!state.alive[size_t(e)]) continue;
    const Vec3d a = state.x[size_t(e)], b = state.x[size_t(e) + 1];
    const double radius = body.model.radius[size_t(e)];
    Vec3f* memory = side.data() + size_t(e) * kToolParts;
    const double reach = radius + model.shaft_radius + model.jaw_length + length(b - a);
    if (length(a - collision::nearest_on_axis(whole, a)) > reach) {
      for (int part = 0; part < kToolParts; ++part) memory[part] = {};
      continue;
    }
    const BetweenJaws where = between_jaws(model, shape, body, state, e);
    const bool held = is_held(e), between = e >= first_inside - kEdge && e <= last_inside + kEdge;
    for (int part = 0; part < kToolParts; ++part) {
      if (part != kShaft && (held || between)) {
        memory[part] = {};
        continue;
      }
      const collision::RodContact c = collision::touch(shape.part[part], {a, b, radius}, memory[part]);
      if (c.depth <= 0) continue;
      tissue::StrandLoad load;
      load.element = e;
      load.w = c.t;
      load.k = kStrandStiffness;
      load.dir = c.normal;
      load.d = kDamping;
      load.x0 = c.on_second + std::min(c.depth, kQuickestStrand) * c.normal;
      loads.add(load, {Owner::tool_contact, tool, part});
    }
    if (where.inside && between && !held) channel(shape, where, radius, e, {Owner::tool_contact, tool, kJawA}, loads);
  }
}

}  // namespace trocar::interactions
