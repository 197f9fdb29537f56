#include <algorithm>
#include <array>

#include <trocar/core/tick.hpp>
#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/contact/body_friction.hpp>
#include <trocar/interactions/contact/nearest_skin.hpp>
#include <trocar/interactions/instrument/tool_contact.hpp>

namespace trocar::interactions {
namespace {

constexpr double kSurfaceStiffness = 1500;  // [N/m] per skin vertex, implicit: decides how firm, never how stable
constexpr double kStrandStiffness = 1500;   // [N/m] per strand element
constexpr double kQuickestStrand = 0.003;   // [m] kQuickestPush of a strand, which is light
constexpr double kNormalDamping = 0.3;      // [N s/m] along the contact normal
constexpr double kBehindSkin = 0.006;       // [m] how deep behind the surface an instrument is looked for
constexpr double kDeepestTool = 0.025;      // [m] ... and still pushed out, if it is known to have come from outside
constexpr double kNoted = 0.0025;           // [m] from the instrument: noted

bool meets(const tissue::Box& box, const Capsule& rod) noexcept {
  return meets_box(box, rod.a, rod.b, rod.radius + kBehindSkin);
}

}  // namespace

namespace {

/// A skin vertex is pushed by `depth` along n, and held back across it.
void push_vertex(const Touching& c, std::int32_t number, const Surface& surface, int v, double depth, Vec3d n,
                 double share, NetworkLoads& loads) noexcept {
  SkinLoad load;
  load.k = share * kSurfaceStiffness;
  load.shift = depth * n;
  load.dir = n;
  load.d = share * kNormalDamping;
  add_skin_load(surface.nodes, *surface.skin, v, load, {Owner::tool_contact, c.tool, number}, loads);
}

/// Friction on a skin vertex, or on its share of a point between vertices.
void rub_skin(const Touching& c, std::int32_t number, const Rub& rub, const Surface& surface, int v, double share,
              Vec3d push, NetworkLoads& loads) noexcept {
  if (rub.kind == Rub::free) return;
  SkinLoad load;
  if (rub.kind == Rub::sticks) {
    load.k = share * rub.stiffness;
    load.shift = rub.to + push;
  } else {
    load.d = share * rub.damping;
    load.dir = rub.dir;
    load.f0 = (load.d * rub.speed) * rub.dir;
  }
  add_skin_load(surface.nodes, *surface.skin, v, load, {Owner::tool_contact, c.tool, number}, loads, kLeastRubbed);
}

void rub_vertex(Touching& c, std::int32_t number, const Surface& surface, int v, double depth, Vec3d n,
                NetworkLoads& loads) noexcept {
  const Vec3d p = surface.position(v);
  const Rub rub = c.rub(number, {n, p, tissue::skin_velocity(surface.nodes, *surface.skin, v)}, p);
  rub_skin(c, number, rub, surface, v, 1, depth * n, loads);
}

/// Was the instrument near this patch of the skin in the last tick?
bool was_near(const Touching& c, BodyId body, const Surface& surface, int v) noexcept {
  if (c.last.near(body, v)) return true;
  const tissue::Skin& skin = *surface.skin;
  for (int k = skin.neighbour_first[size_t(v)]; k < skin.neighbour_first[size_t(v) + 1]; ++k)
    if (c.last.near(body, skin.neighbour[size_t(k)])) return true;
  return false;
}

/// Was the part's axis outside the skin at that vertex?
bool was_outside(const Touching& c, int part, const Surface& surface, int v, Vec3d p, Vec3d n) noexcept {
  const Vec3d p0 = p - core::kTick * tissue::skin_velocity(surface.nodes, *surface.skin, v);
  return dot(p0 - collision::nearest_on_axis(c.before.rod(part), p0), n) <= 0;
}

/// Do jaws hold a vertex or one of its neighbours?
bool holds_at(const HeldVertices& held, const tissue::Skin& skin, int v) noexcept {
  if (held.count == 0) return false;
  if (held.has(v)) return true;
  for (int k = skin.neighbour_first[size_t(v)]; k < skin.neighbour_first[size_t(v) + 1]; ++k)
    if (held.has(skin.neighbour[size_t(k)])) return true;
  return false;
}

/// One vertex against one part.
void touch_vertex(Touching& c, BodyId body, const Surface& surface, int v, int part, NetworkLoads& loads) noexcept {
  const Capsule& rod = c.shape.rod(part);
  const Vec3d p = surface.position(v), from = p - collision::nearest_on_axis(rod, p);
  const double distance = length(from);
  if (distance > rod.radius + kDeepestTool) return;
  const Vec3d n = surface.normal(v);
  if (dot(from, n) <= 0) {
    if (distance > rod.radius + kNoted) return;
  } else if (!was_near(c, body, surface, v) && !was_outside(c, part, surface, v, p, n)) {
    return;
  }
  const collision::Push push = collision::push_out(rod, p, n, kDeepestTool);
  if (push.depth <= 0 && dot(from, n) > 0 && distance > rod.radius + kNoted) return;
  const std::int32_t number = c.note(body, v, part);
  if (push.depth <= 0) {
    if (dot(from, n) <= 0 && distance < rod.radius + kGrazes)
      rub_vertex(c, number, surface, v, 0, from / distance, loads);
    return;
  }
  const double depth = std::min(push.depth, kQuickestPush + c.way(part));
  rub_vertex(c, number, surface, v, depth, push.direction, loads);
  push_vertex(c, number, surface, v, depth, push.direction, 1, loads);
}

/// An edge so long that the shaft fits between its vertices. Edges are numbered after the vertices.
void shaft_on_edge(Touching& c, BodyId body, const Surface& surface, int v, int k, NetworkLoads& loads) noexcept {
  const tissue::Skin& skin = *surface.skin;
  const Capsule& rod = c.shape.part[kShaft];
  const int u = skin.neighbour[size_t(k)];
  const Vec3d a = surface.position(v), b = surface.position(u);
  const auto near = geometry::closest_segments(rod.a, rod.b, a, b);
  if (near.t < 0.1 || near.t > 0.9) return;  // that is the vertices' business
  const Vec3d n = normalised((1 - near.t) * surface.normal(v) + near.t * surface.normal(u));
  const bool behind = dot(near.on_second - near.on_first, n) > 0;
  if (behind && !was_near(c, body, surface, v) && !was_outside(c, kShaft, surface, v, near.on_second, n)) return;
  const collision::Push push = collision::push_out(rod, near.on_second, n, kDeepestTool);
  if (push.depth <= 0) return;
  const std::int32_t element = skin.size() + k;
  const std::int32_t number = c.note(body, element, kShaft);
  const double depth = std::min(push.depth, kQuickestPush + c.way(kShaft));
  const Touch* was = c.anchored(body, element, kShaft);
  const Vec3d velocity = (1 - near.t) * tissue::skin_velocity(surface.nodes, skin, v) +
                         near.t * tissue::skin_velocity(surface.nodes, skin, u);
  const Rub rub = c.rub(number, {push.direction, near.on_second, velocity, {near.t, 0}},
                        a + (was ? double(was->weight[0]) : near.t) * (b - a));
  for (int end = 0; end < 2; ++end) {
    const int vertex = end ? u : v;
    push_vertex(c, number, surface, vertex, depth, push.direction, end ? near.t : 1 - near.t, loads);
    rub_skin(c, number, rub, surface, vertex, end ? rub.weight[0] : 1 - rub.weight[0], depth * push.direction, loads);
  }
}

void shaft_on_edges(Touching& c, BodyId body, const Surface& surface, int v, NetworkLoads& loads) noexcept {
  const tissue::Skin& skin = *surface.skin;
  const double r = c.shape.part[kShaft].radius, least2 = 1.6 * 1.6 * r * r;
  for (int k = skin.neighbour_first[size_t(v)]; k < skin.neighbour_first[size_t(v) + 1]; ++k) {
    const int u = skin.neighbour[size_t(k)];
    if (u > v && geometry::distance2(surface.position(u), surface.position(v)) > least2 && !surface.torn(v, u))
      shaft_on_edge(c, body, surface, v, k, loads);
  }
}

void part_on_surface(Touching& c, BodyId body, const Surface& surface, int part, const HeldVertices& held,
                     NetworkLoads& loads) noexcept {
  const tissue::SkinPose& pose = *surface.pose;
  const Capsule& rod = c.shape.rod(part);
  const double reach2 = (rod.radius + kBehindSkin) * (rod.radius + kBehindSkin);
  const auto within = [&](int v) {
    const Vec3d p = surface.position(v);
    return geometry::distance2(p, collision::nearest_on_axis(rod, p)) <= reach2;
  };
  if (meets(pose.bounds, rod))
    for (size_t b = 0; b < pose.block.size(); ++b) {
      if (!meets(pose.block[b], rod)) continue;
      const int last = std::min(int(b + 1) * tissue::kSkinBlock, surface.skin->size());
      for (int v = int(b) * tissue::kSkinBlock; v < last; ++v)
        if (surface.skin->at_surface(v) && within(v) && !surface.torn(v) &&
            (!is_jaw(part) || !holds_at(held, *surface.skin, v))) {
          touch_vertex(c, body, surface, v, part, loads);
          if (part == kShaft) shaft_on_edges(c, body, surface, v, loads);
        }
    }
  // What was near and has been left behind deeper than that.
  for (const Touch* t = c.last.touch; t != c.last.touch + c.last.count; ++t) {
    if (t->body != body || t->part != part || t->element < 0 || t->element >= surface.skin->size()) continue;
    if (surface.skin->at_surface(t->element) && !within(t->element) && !surface.torn(t->element) &&
        (!is_jaw(part) || !holds_at(held, *surface.skin, t->element)))
      touch_vertex(c, body, surface, t->element, part, loads);
  }
}

/// Number `ball` of the balls along a part presses the skin in, whatever lies between the skin's vertices.
/// @param out  only skin that lies that way of it; zero: any
void press(Touching& c, BodyId body, const Surface& surface, int part, int ball, Vec3d p, Vec3d before, double radius,
           NetworkLoads& loads, const HeldVertices& held = {}, Vec3d out = {}) noexcept {
  const std::int32_t element = -1 - ball;
  const Touch* was = c.last.find(body, element, part);
  const bool known =
      was && was->vertex >= 0 && was->vertex < surface.skin->size() && surface.skin->at_surface(was->vertex);
  int vertex = nearest_vertex_near(surface, p, radius + kBehindSkin);
  if (known && was->anchored && vertex != was->vertex) vertex = walk_to_nearest(surface, was->vertex, p);
  if (vertex < 0 || surface.torn(vertex) || holds_at(held, *surface.skin, vertex)) return;
  const SkinPoint at = nearest_skin_point(surface, vertex, p);
  if (dot(at.normal, out) > 0) return;
  const double above = dot(p - at.point, at.normal), far = length(p - at.point);
  if (above >= 0 ? far > radius + kNoted : far > kDeepestTool) return;
  if (above < 0 && !known && !was_near(c, body, surface, vertex) && dot(before - at.point, at.normal) < 0) return;
  const std::int32_t number = c.note(body, element, part, vertex);
  const double deep = radius - above;
  if (deep <= -kGrazes) return;
  const Vec3d n = -at.normal;
  const double depth = std::clamp(deep, 0.0, kQuickestPush + c.way(part));
  rub_vertex(c, number, surface, vertex, depth, n, loads);
  if (deep <= 0) return;
  for (size_t k = 0; k < 3; ++k) {
    const double share = at.weights[int(k)];
    if (share >= 0.02) push_vertex(c, number, surface, at.vertex[k], depth, n, share, loads);
  }
}

constexpr double kSpacing = 0.002;  // [m] of balls along jaws

bool closed_jaws(const ToolShape& shape) noexcept {
  const Capsule &a = shape.part[kJawA], &b = shape.part[kJawB];
  return length(a.b - b.b) <= 2.5 * (a.radius + b.radius);
}

/// Closed jaws are a blunt rod that is thinner than the skin's triangles: points along it are pressed against the skin.
/// Open jaws are not, so that a fold can rise between them.
void closed_jaws_on_surface(Touching& c, BodyId body, const Surface& surface, const HeldVertices& held,
                            NetworkLoads& loads) noexcept {
  const Capsule &a = c.shape.part[kJawA], &b = c.shape.part[kJawB];
  if (c.shape.has_foot || !closed_jaws(c.shape)) return;
  const double far = length(c.shape.frame.tip - c.shape.pivot);
  if (!meets_box(surface.pose->bounds, c.shape.pivot, c.shape.frame.tip, kDeepestTool)) return;
  int ball = 0;
  for (double back = 0; back < far; back += kSpacing, ++ball)
    press(c, body, surface, kJawA, ball, c.shape.frame.tip - back * c.shape.frame.axis(),
          c.before.frame.tip - back * c.before.frame.axis(), a.radius + b.radius, loads, held);
}

/// But for those of a dissector, which part what they are opened in: they press what lies on their outer sides.
void spread_jaws_on_surface(Touching& c, BodyId body, const Surface& surface, NetworkLoads& loads) noexcept {
  if (!c.shape.spreads || closed_jaws(c.shape)) return;
  for (const int part : {kJawA, kJawB}) {
    const Capsule &now = c.shape.part[part], &before = c.before.part[part];
    if (!meets_box(surface.pose->bounds, now.a, now.b, kDeepestTool)) continue;
    const Vec3d out = normalised(now.b - c.shape.part[part == kJawA ? kJawB : kJawA].b);
    const int balls = int(length(now.b - now.a) / kSpacing);
    for (int ball = 0; ball < balls; ++ball) {
      const double share = double(ball) / balls;
      press(c, body, surface, part, ball, now.b + share * (now.a - now.b), before.b + share * (before.a - before.b),
            now.radius, loads, {}, out);
    }
  }
}

/// A hook's wire, or its foot, is thinner still: the same from its end back, as close as it is thick.
void wire_on_surface(Touching& c, BodyId body, const Surface& surface, int part, NetworkLoads& loads) noexcept {
  const Capsule &now = c.shape.part[part], &before = c.before.part[part];
  if (!c.shape.has_foot || !meets_box(surface.pose->bounds, now.a, now.b, kDeepestTool)) return;
  const double share = 2 * now.radius / std::max(length(now.b - now.a), now.radius);
  for (int ball = 0; ball * share < 1; ++ball)
    press(c, body, surface, part, ball, now.b + ball * share * (now.a - now.b),
          before.b + ball * share * (before.a - before.b), now.radius, loads);
}

}  // namespace

bool comes_near(const ToolShape& shape, const tissue::Box& box, double margin) noexcept {
  if (meets_box(box, shape.part[kShaft].a, shape.frame.tip, margin)) return true;
  for (int i = 0; i < shape.links; ++i)
    if (meets_box(box, shape.link[i].a, shape.link[i].b, margin)) return true;
  return shape.links > 0 && (meets_box(box, shape.part[kShaft].a, shape.part[kShaft].b, margin) ||
                             meets_box(box, shape.pivot, shape.frame.tip, margin));
}

HeldVertices::HeldVertices(const Bodies& bodies, BodyId body, const ToolState& tool) noexcept {
  for (int i = 0; i < tool.holds; ++i)
    if (tool.hold[i].at.body == body) vertex[count++] = vertex_of(bodies, tool.hold[i].at);
}

void tool_on_surface(Touching& touching, BodyId body, const Surface& surface, NetworkLoads& loads,
                     const HeldVertices& held) noexcept {
  for (int part = kShaft; part < end_of(touching.shape); part = next(part))
    part_on_surface(touching, body, surface, part, held, loads);
  closed_jaws_on_surface(touching, body, surface, held, loads);
  spread_jaws_on_surface(touching, body, surface, loads);
  for (const int part : {kJawA, kJawB}) wire_on_surface(touching, body, surface, part, loads);
}

BetweenJaws between_jaws(const ToolModel& model, const ToolShape& shape, Vec3d from, Vec3d to, double radius) noexcept {
  BetweenJaws r;
  const Vec3d a = to_jaw(shape, from), b = to_jaw(shape, to);
  const double dy = b.y - a.y;
  r.w = std::fabs(dy) > 1e-9 ? std::clamp(-a.y / dy, 0.0, 1.0) : 0.5;
  r.local = a + r.w * (b - a);
  r.crosses = (a.y > 0) != (b.y > 0);
  if (std::fabs(r.local.y) > 0.5 * model.jaw_width + 0.001) return r;
  if (r.local.z < -radius || r.local.z > model.jaw_length + 0.5 * radius) return r;
  r.inside = std::fabs(r.local.x) <= shape.half_opening(std::max(r.local.z, 0.0)) + 0.3 * radius;
  return r;
}

BetweenJaws between_jaws(const ToolModel& model, const ToolShape& shape, const StrandBody& body,
                         const tissue::StrandState& state, int element) noexcept {
  const size_t e = size_t(element);
  return between_jaws(model, shape, state.x[e], state.x[e + 1], body.model.radius[e]);
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
  load.d = kNormalDamping;
  load.x0 = from_jaw(shape, where.local) + depth * inward;
  loads.add(load, tag);
}

constexpr int kBetween = kToolParts;  // where others note a part: it runs between the jaws

/// Nothing gets between jaws that are closed; what was there when they closed stays.
bool may_be_between(const Touching& c, const BetweenJaws& where, const StrandBody& body, BodyId strand,
                    int e) noexcept {
  constexpr double kSqueezed = 0.35;
  if (c.shape.half_opening(std::max(where.local.z, 0.0)) >= kSqueezed * body.model.radius[size_t(e)]) return true;
  for (int near = e - 1; near <= e + 1; ++near)
    if (c.last.find(strand, near, kBetween)) return true;
  return false;
}

/// How far a point of an element can give way: 1 in between, 0 at a node whose position is given.
double gives_way(const tissue::StrandModel& model, int element, double w) noexcept {
  const size_t e = size_t(element);
  return 1 - (model.prescribed[e] ? 1 - w : 0) - (model.prescribed[e + 1] ? w : 0);
}

/// A strand element is pushed off a part of the instrument and held back across that.
void push_strand(Touching& touching, BodyId strand, const tissue::StrandModel& model, const tissue::StrandState& state,
                 int element, int part, const collision::RodContact& c, StrandLoads& loads) noexcept {
  const Vec3d a = state.x[size_t(element)], b = state.x[size_t(element) + 1];
  const std::int32_t number = touching.note(strand, element, part);
  const Tag tag{Owner::tool_contact, touching.tool, number};
  const double depth = std::clamp(c.depth, 0.0, kQuickestStrand + touching.way(part));
  const Touch* was = touching.anchored(strand, element, part);
  const double held = was ? double(was->weight[0]) : c.t;
  const Vec3d velocity = (1 - c.t) * state.v[size_t(element)] + c.t * state.v[size_t(element) + 1];
  const Rub rub = touching.rub(number, {c.normal, c.on_second, velocity, {c.t, 0}}, a + held * (b - a));
  tissue::StrandLoad load;
  load.element = element;
  if (rub.kind != Rub::free) {
    load.w = rub.weight[0];
    if (rub.kind == Rub::sticks) {
      load.k = rub.stiffness;
      load.x0 = a + load.w * (b - a) + rub.to + gives_way(model, element, load.w) * depth * c.normal;
    } else {
      load.d = rub.damping;
      load.dir = rub.dir;
      load.f0 = (load.d * rub.speed) * rub.dir;
    }
    loads.add(load, tag);
  }
  if (c.depth <= 0) return;
  load.f0 = {0, 0, 0};
  load.w = c.t;
  load.k = kStrandStiffness;
  load.dir = c.normal;
  load.d = kNormalDamping;
  load.x0 = c.on_second + depth * c.normal;
  loads.add(load, tag);
}

}  // namespace

namespace {

/// What of an instrument can meet strands.
struct Reach {
  Capsule whole;       ///< from the shaft's far end to the tip; radius: holds all parts
  Capsule jaws;        ///< the same for the jaws
  double between = 0;  ///< from the jaws' axis, what runs between them lies within [m], but for its own radius
  double way = 0;      ///< the longest of all parts [m]
};
Reach reach_of(const ToolModel& model, const Touching& touching) noexcept {
  const ToolShape& shape = touching.shape;
  Reach r{{shape.part[kShaft].a, shape.frame.tip, 0}, {shape.pivot, shape.frame.tip, 0}, 0, 0};
  for (const int jaw : {kJawA, kJawB})
    for (const Vec3d p : {shape.part[jaw].a, shape.part[jaw].b}) {
      const double off = length(p - collision::nearest_on_axis(r.jaws, p)) + shape.part[jaw].radius;
      r.jaws.radius = std::max(r.jaws.radius, off);
    }
  r.whole.radius = std::max(shape.part[kShaft].radius, r.jaws.radius);
  r.between = shape.half_opening(model.jaw_length) + 0.5 * model.jaw_width + 0.001;
  for (int i = 0; i < shape.links; ++i)
    for (const Vec3d p : {shape.link[i].a, shape.link[i].b}) {
      const double off = length(p - collision::nearest_on_axis(r.whole, p)) + shape.link[i].radius;
      r.whole.radius = std::max(r.whole.radius, off);
    }
  for (int part = kShaft; part < end_of(shape); part = next(part)) r.way = std::max(r.way, touching.way(part));
  return r;
}

/// May an element of which a is one end and that is `length2` long be nearer to the axis than `reach`?
bool within(const Capsule& axis, Vec3d a, double length2, double reach) noexcept {
  return geometry::distance2(a, collision::nearest_on_axis(axis, a)) <= 2 * (length2 + reach * reach);
}

/// Can this element run between the jaws?
bool near_jaws(const Reach& r, Vec3d a, double length2, double radius) noexcept {
  return within(r.jaws, a, length2, r.between + 2.5 * radius);
}

}  // namespace

void tool_on_strand(const ToolModel& model, Touching& touching, const ToolState& tool_state, const StrandBody& body,
                    BodyId strand, const tissue::StrandState& state, std::span<Vec3f> side,
                    StrandLoads& loads) noexcept {
  const ToolShape& shape = touching.shape;
  const auto is_held = [&](int element) {
    for (int h = 0; h < tool_state.holds; ++h)
      if (tool_state.hold[h].at.body == strand && std::abs(tool_state.hold[h].at.element - element) <= 1) return true;
    return false;
  };
  // Next to where the strand runs between the jaws it touches their edges from within: that is the channel's business.
  constexpr int kEdge = 3;
  int first_inside = body.nodes(), last_inside = -1;
  const Reach far = reach_of(model, touching);
  const size_t stride = side.size() / size_t(std::max(1, body.nodes() - 1));
  for (int e = 0; e + 1 < body.nodes(); ++e) {
    if (!state.alive[size_t(e)]) continue;
    const Vec3d a = state.x[size_t(e)];
    if (!near_jaws(far, a, geometry::distance2(a, state.x[size_t(e) + 1]), body.model.radius[size_t(e)])) continue;
    const BetweenJaws where = between_jaws(model, shape, body, state, e);
    if (!where.inside || !where.crosses || !may_be_between(touching, where, body, strand, e)) continue;
    touching.note(strand, e, kBetween);
    first_inside = std::min(first_inside, e);
    last_inside = e;
  }
  for (int e = 0; e + 1 < body.nodes(); ++e) {
    if (!state.alive[size_t(e)]) continue;
    const Vec3d a = state.x[size_t(e)], b = state.x[size_t(e) + 1];
    const double radius = body.model.radius[size_t(e)], length2 = geometry::distance2(a, b);
    Vec3f* memory = side.data() + size_t(e) * stride;
    bool noted = false;
    for (size_t part = 0; part < stride; ++part) noted = noted || dot(memory[part], memory[part]) > 0;
    const double beyond = noted ? collision::kLost : collision::kRemember + far.way;
    if (!within(far.whole, a, length2, radius + far.whole.radius + beyond)) {
      for (size_t part = 0; part < stride; ++part) memory[part] = {};
      continue;
    }
    const Vec3d a0 = a - body.model.tick * state.v[size_t(e)], b0 = b - body.model.tick * state.v[size_t(e) + 1];
    const BetweenJaws where =
        near_jaws(far, a, length2, radius) ? between_jaws(model, shape, body, state, e) : BetweenJaws{};
    const bool held = is_held(e), between = e >= first_inside - kEdge && e <= last_inside + kEdge;
    for (int part = kShaft; part < end_of(shape); part = next(part)) {
      if (is_jaw(part) && (held || between)) {
        memory[part] = {};
        continue;
      }
      const Capsule& rod = shape.rod(part);
      if (!noted && !within(rod, a, length2, radius + rod.radius + collision::kRemember + touching.way(part))) continue;
      const collision::RodContact c =
          collision::touch(touching.before.rod(part), rod, {a0, b0, radius}, {a, b, radius}, memory[part]);
      if (c.depth > -kGrazes) push_strand(touching, strand, body.model, state, e, part, c, loads);
    }
    if (where.inside && between && !held)
      channel(shape, where, radius, e, {Owner::tool_contact, touching.tool, 0}, loads);
  }
}

double from_bend(const ToolModel& model, double along) noexcept {
  return along - (model.jaw_length - model.clip_length);
}

double leg_cover(double along, double radius, double length) noexcept {
  const double from = std::max(0.0, along - radius), to = std::min(length, along + radius);
  return std::clamp((to - from) / (2 * radius), 0.0, 1.0);
}

}  // namespace trocar::interactions
