#include <algorithm>

#include <trocar/collision/segments.hpp>
#include <trocar/interactions/body_contact.hpp>

namespace trocar::interactions {
namespace {

constexpr double kStiffness = 150;  // [N/m] per sample, implicit on both sides
constexpr double kDamping = 0.05;   // [N s/m]
constexpr double kDeepest = 0.010;  // [m] deeper than this is not contact but another side of the body

/// Pushes surface vertex `v` along -n by the share of the depth that its body takes.
void push_surface(const Surface& surface, int v, Vec3d n, double depth, NetworkLoads* loads) noexcept {
  if (!loads) return;
  SkinLoad back;
  back.k = kStiffness;
  back.shift = -0.5 * depth * n;
  back.dir = n;
  back.d = kDamping;
  add_skin_load(*surface.network, *surface.skin, *surface.state, v, back, {Owner::body, 0, 0}, *loads);
}

}  // namespace

void strand_on_surface(const SurfacePair& pair, const StrandBody& body, const tissue::StrandState& state,
                       const Surface& surface, std::span<std::int32_t> nearest, StrandLoads& strand_loads,
                       NetworkLoads* surface_loads) noexcept {
  const double share = surface_loads ? 0.5 : 1.0;
  for (size_t i = 0; i < pair.sample.size(); ++i) {
    const int node = pair.sample[i];
    const Vec3d p = state.x[size_t(node)];
    if (!surface.pose->bounds.reaches(p, 0.006)) continue;
    nearest[i] = walk_to_nearest(surface, nearest[i], p);
    const Clearance c = clearance_at(surface, nearest[i], p);
    const double depth = double(pair.radius[i]) - c.distance - double(pair.overlap[i]);
    if (depth <= 0 || depth > kDeepest) continue;
    const int e = std::min(node, body.nodes() - 2);
    tissue::StrandLoad load;
    load.element = e;
    load.w = node == e ? 0.0 : 1.0;
    load.k = kStiffness;
    load.dir = c.normal;
    load.d = kDamping;
    load.x0 = p + share * depth * c.normal;
    strand_loads.add(load, {Owner::body, 0, 0});
    push_surface(surface, nearest[i], c.normal, depth, surface_loads);
  }
}

void solid_on_surface(const SurfacePair& pair, const Surface& samples, const Surface& surface,
                      std::span<std::int32_t> nearest, NetworkLoads& sample_loads,
                      NetworkLoads* surface_loads) noexcept {
  if (!surface.pose->bounds.near_box(samples.pose->bounds, 0.002f)) return;
  const double share = surface_loads ? 0.5 : 1.0;
  for (size_t i = 0; i < pair.sample.size(); ++i) {
    const int v = pair.sample[i];
    const Vec3d p = samples.position(v);
    if (!surface.pose->bounds.reaches(p, 0.004)) continue;
    nearest[i] = walk_to_nearest(surface, nearest[i], p);
    const Clearance c = clearance_at(surface, nearest[i], p);
    const double depth = -c.distance - double(pair.overlap[i]);
    if (depth <= 0 || depth > kDeepest) continue;
    SkinLoad load;
    load.k = kStiffness;
    load.shift = share * depth * c.normal;
    load.dir = c.normal;
    load.d = kDamping;
    add_skin_load(*samples.network, *samples.skin, *samples.state, v, load, {Owner::body, 0, 0}, sample_loads);
    push_surface(surface, nearest[i], c.normal, depth, surface_loads);
  }
}

namespace {

collision::SegmentPair element_pair(const tissue::StrandState& a, int i, const tissue::StrandState& b, int j) noexcept {
  return collision::nearest_segments(a.x[size_t(i)], a.x[size_t(i) + 1], b.x[size_t(j)], b.x[size_t(j) + 1]);
}

}  // namespace

void strand_on_strand(const StrandPair& pair, const StrandBody& a, const tissue::StrandState& a_state,
                      const StrandBody& b, const tissue::StrandState& b_state, std::span<std::int32_t> nearest,
                      std::span<Vec3f> side, StrandLoads& a_loads, StrandLoads& b_loads) noexcept {
  const int last = b.nodes() - 2;
  for (int i = 0; i + 1 < a.nodes(); ++i) {
    if (!a_state.alive[size_t(i)]) continue;
    int j = std::clamp(nearest[size_t(i)], 0, last);
    collision::SegmentPair best = element_pair(a_state, i, b_state, j);
    for (int step = 0; step < 64; ++step) {
      const int down = std::max(j - 1, 0), up = std::min(j + 1, last);
      const collision::SegmentPair d = element_pair(a_state, i, b_state, down),
                                   u = element_pair(a_state, i, b_state, up);
      const int next = d.distance < best.distance && d.distance <= u.distance ? down
                       : u.distance < best.distance                           ? up
                                                                              : j;
      if (next == j) break;
      best = next == down ? d : u;
      j = next;
    }
    nearest[size_t(i)] = j;
    const double touch = a.model.radius[size_t(i)] + b.model.radius[size_t(j)];
    if (best.distance > touch + 0.002 || !b_state.alive[size_t(j)]) {
      side[size_t(i)] = {0, 0, 0};
      continue;
    }
    Vec3d n = best.distance > 1e-9 ? (best.on_first - best.on_second) / best.distance : Vec3d{0, 0, 1};
    double depth = touch - best.distance;
    if (dot(n, vec_cast<double>(side[size_t(i)])) < -0.2) {
      depth = touch + best.distance;
      n = -n;
    } else {
      side[size_t(i)] = vec_cast<float>(n);
    }
    depth -= double(pair.overlap[size_t(i)]);
    if (depth <= 0 || depth > kDeepest) continue;
    tissue::StrandLoad on_a, on_b;
    on_a.k = on_b.k = kStiffness;
    on_a.d = on_b.d = kDamping;
    on_a.dir = on_b.dir = n;
    on_a.element = i;
    on_a.w = best.s;
    on_a.x0 = best.on_first + 0.5 * depth * n;
    on_b.element = j;
    on_b.w = best.t;
    on_b.x0 = best.on_second - 0.5 * depth * n;
    a_loads.add(on_a, {Owner::body, 0, 0});
    b_loads.add(on_b, {Owner::body, 0, 0});
  }
}

}  // namespace trocar::interactions
