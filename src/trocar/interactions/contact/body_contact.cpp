#include <algorithm>

#include <trocar/collision/rods.hpp>
#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/contact/body_contact.hpp>
#include <trocar/interactions/contact/body_friction.hpp>
#include <trocar/interactions/contact/body_push.hpp>
#include <trocar/interactions/contact/nearest_skin.hpp>

namespace trocar::interactions {
namespace {

constexpr double kAbove = 0.001;   // [m] by which the plane of the nearest vertex may be wrong
constexpr double kJoined = 0.030;  // [m] drawn no further apart than this, strands are joined by a fold

bool touches(const Surface& surface, int vertex, Vec3d p, double depth) noexcept {
  return depth > 0 && depth <= kDeepestContact && length(p - surface.position(vertex)) <= kFarthestContact;
}

/// Far from the last vertex that was nearest, and not yet its turn to be looked for again?
bool waits(const Surface& surface, Vec3d p, std::uint64_t turn, int vertex) noexcept {
  constexpr double kFar = 0.025;          // [m]
  constexpr std::uint64_t kTurnsFar = 8;  // in which nothing comes from there to here
  return geometry::distance2(surface.position(vertex), p) > kFar * kFar && turn % kTurnsFar != 0;
}

/// Looks for the vertex nearest to p from the last one on.
/// @return is it near enough for contact?
bool beside(const Surface& surface, Vec3d p, std::int32_t& vertex) noexcept {
  constexpr double kFarthest2 = kFarthestContact * kFarthestContact * 1.000001;
  vertex = walk_to_nearest(surface, vertex, p);
  return geometry::distance2(surface.position(vertex), p) <= kFarthest2;
}

/// The place under a rod's node, between its corners: were it the nearest corner alone, what slides over a dimpled
/// surface would hop from one to the next.
struct UnderRod {
  const Surface& surface;
  SkinPoint at;

  Vec3d velocity() const noexcept {
    Vec3d v{0, 0, 0};
    each_corner([&](int corner, double w) { v += w * surface.velocity(corner); });
    return v;
  }
  void push_back(double depth, const Press& press, NetworkLoads& loads) const noexcept {
    each_corner([&](int corner, double w) {
      press_vertex(surface, corner, -0.5 * std::min(depth, kQuickestApart), at.normal, press.part(w), loads);
    });
  }
  void rub_back(const BodyRub& rub, Vec3d ours, NetworkLoads& loads) const noexcept {
    each_corner([&](int corner, double w) { rub_skin(surface, corner, rub.part(w), ours, loads); });
  }

 private:
  template <class F>
  void each_corner(F&& f) const noexcept {
    constexpr double kLeast = 0.02;  // what bears less is left out
    for (std::size_t k = 0; k < 3; ++k)
      if (at.weights[int(k)] > kLeast) f(at.vertex[k], at.weights[int(k)]);
  }
};

}  // namespace

void strand_on_surface(const SurfacePair& pair, const StrandBody& body, const tissue::StrandState& state,
                       const Surface& surface, std::uint64_t tick, std::span<std::int32_t> nearest,
                       StrandLoads& strand_loads, NetworkLoads* surface_loads) noexcept {
  const double share = surface_loads ? 0.5 : 1.0;
  for (size_t i = 0; i < pair.sample.size(); ++i) {
    const int node = pair.sample[i];
    const Vec3d p = state.x[size_t(node)];
    if (!surface.pose->bounds.reaches(p, 0.006) || waits(surface, p, tick + i, nearest[i])) continue;
    if (!beside(surface, p, nearest[i])) continue;
    const double radius = double(pair.radius[i]) - double(pair.overlap[i]);
    if (clearance_at(surface, nearest[i], p).distance > radius + kAbove) continue;
    const UnderRod under{surface, nearest_skin_point(surface, nearest[i], p)};
    const Vec3d n = under.at.normal;
    const double depth = radius - dot(p - under.at.point, n);
    if (!touches(surface, nearest[i], p, depth) || surface.torn(nearest[i])) continue;
    const int e = std::min(node, body.nodes() - 2);
    const Vec3d ours = state.v[size_t(node)], theirs = under.velocity();
    const double w = node == e ? 0.0 : 1.0, way = share * std::min(depth, kQuickestApart);
    const Press press = press_on(surface, false, depth, ours, theirs, n);
    strand_loads.add(press_strand(e, w, p + way * n, n, press), {Owner::body, 0, 0});
    const BodyRub rub = body_rub(press.k * way, n, ours, theirs);
    rub_strand(e, w, rub, theirs, strand_loads);
    if (!surface_loads) continue;
    under.push_back(depth, press, *surface_loads);
    under.rub_back(rub, ours, *surface_loads);
  }
}

void solid_on_surface(const SurfacePair& pair, const Surface& samples, const Surface& surface, std::uint64_t tick,
                      std::span<std::int32_t> nearest, NetworkLoads& sample_loads,
                      NetworkLoads* surface_loads) noexcept {
  if (!surface.pose->bounds.near_box(samples.pose->bounds, 0.002f)) return;
  const double share = surface_loads ? 0.5 : 1.0;
  for (size_t i = 0; i < pair.sample.size(); ++i) {
    const int v = pair.sample[i];
    if (!samples.skin->at_surface(v)) continue;
    const Vec3d p = samples.position(v);
    if (!surface.pose->bounds.reaches(p, 0.004) || waits(surface, p, tick + i, nearest[i])) continue;
    if (samples.torn(v) || !beside(surface, p, nearest[i])) continue;  // torn() reads eight nodes: it comes late
    const Clearance c = clearance_at(surface, nearest[i], p);
    const double depth = -c.distance - double(pair.overlap[i]);
    if (!touches(surface, nearest[i], p, depth) || surface.torn(nearest[i])) continue;
    const Vec3d ours = samples.velocity(v), theirs = surface.velocity(nearest[i]);
    const Press press = press_on(surface, samples.swings, depth, ours, theirs, c.normal);
    press_vertex(samples, v, share * std::min(depth, kQuickestApart), c.normal, press, sample_loads);
    if (surface_loads)
      press_vertex(surface, nearest[i], -0.5 * std::min(depth, kQuickestApart), c.normal, press, *surface_loads);
    const BodyRub rub = body_rub(press.k * share * std::min(depth, kQuickestApart), c.normal, ours, theirs);
    rub_skin(samples, v, rub, theirs, sample_loads);
    if (surface_loads) rub_skin(surface, nearest[i], rub, ours, *surface_loads);
  }
}

namespace {

collision::Capsule rod(const StrandBody& body, const tissue::StrandState& state, int element) noexcept {
  const size_t e = size_t(element);
  return {state.x[e], state.x[e + 1], body.model.radius[e]};
}

double middle_distance(const tissue::StrandState& a, int i, const tissue::StrandState& b, int j) noexcept {
  const Vec3d d = a.x[size_t(i)] + a.x[size_t(i) + 1] - b.x[size_t(j)] - b.x[size_t(j) + 1];
  return dot(d, d);
}

/// The element of b whose middle is nearest to that of a's element i, downhill from `start`.
int walk_along(const tissue::StrandState& a, int i, const tissue::StrandState& b, int start, int last,
               double& best) noexcept {
  int j = std::clamp(start, 0, last);
  best = middle_distance(a, i, b, j);
  for (int step = 0; step < 64; ++step) {
    const int from = j;
    for (int next : {from - 1, from + 1}) {
      if (next < 0 || next > last) continue;
      const double d = middle_distance(a, i, b, next);
      if (d >= best) continue;
      best = d;
      j = next;
    }
    if (j == from) break;
  }
  return j;
}

/// The same of all elements of b.
int nearest_along(const tissue::StrandState& a, int i, const tissue::StrandState& b, int last, double& best) noexcept {
  int nearest = 0;
  best = middle_distance(a, i, b, 0);
  for (int j = 1; j <= last; ++j) {
    const double d = middle_distance(a, i, b, j);
    if (d >= best) continue;
    best = d;
    nearest = j;
  }
  return nearest;
}

/// Are two elements too far apart for anything to be remembered?
/// @param apart2  square of twice the distance of their middles [m^2]
bool out_of_reach(const StrandBody& a, const tissue::StrandState& a_state, int i, const StrandBody& b,
                  const tissue::StrandState& b_state, int j, double apart2) noexcept {
  const size_t k = size_t(i), l = size_t(j);
  const double reach = a.model.radius[k] + b.model.radius[l] + collision::kLost;
  const double size2 =
      geometry::distance2(a_state.x[k], a_state.x[k + 1]) + geometry::distance2(b_state.x[l], b_state.x[l + 1]);
  return apart2 > 8 * reach * reach + 4 * size2;  // (r + s)^2 <= 2 (r^2 + s^2), with s half of both lengths
}

/// How much a contact counts that pushes element i of a along n from element j of b. Strands that were drawn side by
/// side are joined there by a fold of peritoneum that is not simulated: one that was dragged to the other side of its
/// neighbour has nothing to rest on, and must not be kept from going home.
double share_of(const StrandBody& a, int i, const StrandBody& b, int j, Vec3d n) noexcept {
  const Vec3d drawn =
      a.model.rest[size_t(i)] + a.model.rest[size_t(i) + 1] - b.model.rest[size_t(j)] - b.model.rest[size_t(j) + 1];
  const double apart = length(drawn);
  if (apart > 2 * kJoined || !(apart > 1e-6)) return 1;
  const double along = dot(drawn, n) / apart;
  return std::clamp((along + 0.6) / 0.3, 0.0, 1.0);
}

}  // namespace

void strand_on_strand(const StrandPair& pair, const StrandBody& a, const tissue::StrandState& a_state,
                      const StrandBody& b, const tissue::StrandState& b_state, std::uint64_t tick,
                      std::span<std::int32_t> nearest, std::span<Vec3f> side, StrandLoads& a_loads,
                      StrandLoads& b_loads) noexcept {
  constexpr std::uint64_t kTurnsApart = 4;  // in which all elements that are not near have looked
  const int last = b.nodes() - 2;
  for (int i = 0; i + 1 < a.nodes(); ++i) {
    const bool near = side[size_t(i)] != Vec3f{0, 0, 0};
    if (!a_state.alive[size_t(i)] || (!near && (tick + size_t(i)) % kTurnsApart != 0)) continue;
    double apart2 = 0;
    const int j = near ? walk_along(a_state, i, b_state, nearest[size_t(i)], last, apart2)
                       : nearest_along(a_state, i, b_state, last, apart2);
    nearest[size_t(i)] = j;
    if (!b_state.alive[size_t(j)] || out_of_reach(a, a_state, i, b, b_state, j, apart2)) {
      side[size_t(i)] = {0, 0, 0};
      continue;
    }
    const collision::RodContact c = collision::touch(rod(b, b_state, j), rod(a, a_state, i), side[size_t(i)]);
    const double deep = c.depth - double(pair.overlap[size_t(i)]);
    if (deep <= 0 || deep > kDeepestContact) continue;
    const double counts = share_of(a, i, b, j, c.normal);
    if (!(counts > 0)) {
      side[size_t(i)] = {0, 0, 0};
      continue;
    }
    const double depth = std::min(deep, kQuickestApart);
    const Vec3d ours = (1 - c.t) * a_state.v[size_t(i)] + c.t * a_state.v[size_t(i) + 1];
    const Vec3d theirs = (1 - c.s) * b_state.v[size_t(j)] + c.s * b_state.v[size_t(j) + 1];
    const Press press{.speed = 0.5 * dot(ours + theirs, c.normal)};
    tissue::StrandLoad on_a = press_strand(i, c.t, c.on_second + 0.5 * depth * c.normal, c.normal, press);
    tissue::StrandLoad on_b = press_strand(j, c.s, c.on_first - 0.5 * depth * c.normal, c.normal, press);
    for (tissue::StrandLoad* load : {&on_a, &on_b}) load->k *= counts, load->d *= counts, load->f0 = counts * load->f0;
    a_loads.add(on_a, {Owner::body, 0, 0});
    b_loads.add(on_b, {Owner::body, 0, 0});
    const BodyRub rub = body_rub(on_a.k * 0.5 * depth, c.normal, ours, theirs);
    rub_strand(i, c.t, rub, theirs, a_loads);
    rub_strand(j, c.s, rub, ours, b_loads);
  }
}

}  // namespace trocar::interactions
