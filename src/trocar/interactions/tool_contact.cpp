#include <algorithm>

#include <trocar/collision/segments.hpp>
#include <trocar/interactions/tool_contact.hpp>

namespace trocar::interactions {
namespace {

constexpr double kSurfaceStiffness = 1500;  // [N/m] per skin vertex, implicit: decides how firm, never how stable
constexpr double kStrandStiffness = 1500;   // [N/m] per strand element
constexpr double kDamping = 0.3;            // [N s/m] along the contact normal
constexpr double kBehind = 0.006;           // [m] how deep behind the surface an instrument is still pushed out

struct Push {
  double depth = 0;
  Vec3d direction;
};

/// How a vertex at p with outward normal n must give way to a rod.
Push push_of(const Capsule& rod, Vec3d p, Vec3d n) noexcept {
  const double s = collision::nearest_on_segment(rod.a, rod.b, p);
  const Vec3d from_axis = p - (rod.a + s * (rod.b - rod.a));
  const double out = dot(from_axis, n);
  if (out <= 0) {  // the axis is outside: push straight away from it
    const double distance = length(from_axis);
    if (distance >= rod.radius) return {};
    return {rod.radius - distance, distance > 1e-6 ? from_axis / distance : -n};
  }
  const Vec3d lateral = from_axis - out * n;  // the axis is below the surface: push the skin in until it is not
  if (out > kBehind || length(lateral) >= rod.radius) return {};
  return {rod.radius + out, -n};
}

bool meets(const tissue::Box& box, const Capsule& rod) noexcept {
  return box.near_segment(rod.a, rod.b, rod.radius + kBehind);
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
        const Vec3d p = surface.position(v);
        const double s = collision::nearest_on_segment(rod.a, rod.b, p);
        if (length(p - (rod.a + s * (rod.b - rod.a))) > rod.radius + kBehind) continue;
        const Push push = push_of(rod, p, surface.normal(v));
        if (push.depth <= 0) continue;
        SkinLoad load;
        load.k = kSurfaceStiffness;
        load.shift = push.depth * push.direction;
        load.dir = push.direction;
        load.d = kDamping;
        add_skin_load(*surface.network, *surface.skin, *surface.state, v, load, {Owner::tool_contact, tool, part},
                      loads);
      }
    }
  }
}

BetweenJaws between_jaws(const ToolModel& model, const ToolShape& shape, const StrandBody& body,
                         const tissue::StrandState& state, int element) noexcept {
  BetweenJaws r;
  const size_t e = size_t(element);
  const Vec3d a = to_jaw(shape, state.x[e]), b = to_jaw(shape, state.x[e + 1]);
  const double dy = b.y - a.y;
  r.w = std::fabs(dy) > 1e-9 ? std::clamp(-a.y / dy, 0.0, 1.0) : 0.5;
  r.local = a + r.w * (b - a);
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
  const double depth = std::min(over, std::fabs(where.local.x));
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
                    const StrandBody& body, int strand, const tissue::StrandState& state, std::span<Side> side,
                    StrandLoads& loads) noexcept {
  const auto is_held = [&](int element) {
    for (int h = 0; h < tool_state.holds; ++h)
      if (tool_state.hold[h].body == strand && std::abs(tool_state.hold[h].element - element) <= 1) return true;
    return false;
  };
  // Next to where the strand runs between the jaws it touches their edges from within: that is the channel's business.
  constexpr int kEdge = 3;
  int first_inside = body.nodes(), last_inside = -1;
  for (int e = 0; e + 1 < body.nodes(); ++e)
    if (state.alive[size_t(e)] && between_jaws(model, shape, body, state, e).inside) {
      first_inside = std::min(first_inside, e);
      last_inside = e;
    }
  bool near_part[kToolParts] = {false, false, false};
  for (int e = 0; e + 1 < body.nodes(); ++e) {
    if (!state.alive[size_t(e)]) continue;
    const Vec3d a = state.x[size_t(e)], b = state.x[size_t(e) + 1];
    const double radius = body.model.radius[size_t(e)];
    const double reach = radius + model.shaft_radius + model.jaw_length + length(b - a);
    const double to_axis =
        length(a - (shape.part[kShaft].a + collision::nearest_on_segment(shape.part[kShaft].a, shape.frame.tip, a) *
                                               (shape.frame.tip - shape.part[kShaft].a)));
    if (to_axis > reach) continue;
    const BetweenJaws where = between_jaws(model, shape, body, state, e);
    const bool held = is_held(e);
    for (int part = 0; part < kToolParts; ++part) {
      if (part != kShaft && (held || (e >= first_inside - kEdge && e <= last_inside + kEdge))) continue;
      const Capsule& rod = shape.part[part];
      const collision::SegmentPair pair = collision::nearest_segments(rod.a, rod.b, a, b);
      const double touch = rod.radius + radius;
      if (pair.distance > touch + 0.002) continue;
      near_part[part] = true;
      Vec3d n = pair.distance > 1e-9 ? (pair.on_second - pair.on_first) / pair.distance : Vec3d{0, 0, 1};
      const Vec3d remembered{side[size_t(part)].n[0], side[size_t(part)].n[1], side[size_t(part)].n[2]};
      double depth = touch - pair.distance;
      if (dot(n, remembered) < -0.2) {  // it has passed the axis: push it back to the side it came from
        depth = touch + pair.distance;
        n = -n;
      } else {
        side[size_t(part)] = {{n.x, n.y, n.z}};
      }
      if (depth <= 0) continue;
      tissue::StrandLoad load;
      load.element = e;
      load.w = pair.t;
      load.k = kStrandStiffness;
      load.dir = n;
      load.d = kDamping;
      load.x0 = pair.on_second + depth * n;
      loads.add(load, {Owner::tool_contact, tool, part});
    }
    if (where.inside && !held) channel(shape, where, radius, e, {Owner::tool_contact, tool, kJawA}, loads);
  }
  for (int part = 0; part < kToolParts; ++part)
    if (!near_part[part]) side[size_t(part)] = {};
}

}  // namespace trocar::interactions
