#include <algorithm>
#include <queue>
#include <utility>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/contact/body_friction.hpp>
#include <trocar/interactions/contact/body_push.hpp>
#include <trocar/interactions/contact/self_contact.hpp>

namespace trocar::interactions {
namespace {

constexpr double kLimbStiffness = 600;  // [N/m] per sample, implicit on both sides: few samples bear a whole limb
constexpr double kLimbDamping = 0.2;    // [N s/m]
constexpr double kLook = 0.012;         // [m] how far ahead a sample looks
constexpr double kAround = 0.0075;      // [m] of the middle of what it sees: vertices there are looked at
constexpr double kForget = 0.015;       // [m]
constexpr double kUntouched = 0.003;    // [m] above a vertex' plane: no triangle there can be touched
constexpr double kFacing = -0.25;       // of the two normals' product, to be found
constexpr std::uint64_t kTurns = 32;    // [ticks] in which all samples have looked
constexpr std::uint64_t kSoon = 8;      // [ticks] the same where some part is near already
constexpr double kDrawnGap = 0.0002;    // [m] parts drawn nearer than this may come nearer by as much

/// The nearest vertex of another part that the sample faces from outside, or -1.
int look_ahead(const SelfPair& pair, const Surface& surface, std::size_t i) noexcept {
  const int v = pair.sample[i];
  const Vec3d p = surface.position(v), n = surface.normal(v), middle = p + 0.5 * kLook * n;
  double least = 1e30;
  int best = -1;
  for (std::size_t b = 0; b < surface.pose->block.size(); ++b) {
    if (!surface.pose->block[b].reaches(middle, kAround)) continue;
    const int last = std::min(int(b + 1) * tissue::kSkinBlock, surface.skin->size());
    for (int u = int(b) * tissue::kSkinBlock; u < last; ++u) {
      const Vec3d x = surface.position(u);
      if (!(geometry::distance2(x, middle) < kAround * kAround) || !pair.other(i, u)) continue;
      const double d = geometry::distance2(x, p);
      if (d >= least || !(dot(x - p, n) > 0)) continue;
      const Vec3d facing = surface.normal(u);
      if (!(dot(facing, n) < kFacing) || !(dot(p - x, facing) > 0)) continue;
      least = d;
      best = u;
    }
  }
  return best;
}

/// As walk_to_nearest, but only over what is another part of the skin for that sample.
int walk_beside(const SelfPair& pair, const Surface& surface, std::size_t i, int start, Vec3d p) noexcept {
  const tissue::Skin& skin = *surface.skin;
  int here = start;
  double best = geometry::distance2(surface.position(here), p);
  for (int step = 0; step < 64; ++step) {
    int next = here;
    for (int k = skin.neighbour_first[std::size_t(here)]; k < skin.neighbour_first[std::size_t(here) + 1]; ++k) {
      const int u = skin.neighbour[std::size_t(k)];
      if (!pair.other(i, u)) continue;
      const double d = geometry::distance2(surface.position(u), p);
      if (!(d < best)) continue;
      best = d;
      next = u;
    }
    if (next == here) break;
    here = next;
  }
  return here;
}

/// Is one of the vertex' carriers among `rows`?
bool is_carried(const tissue::Skin& skin, int vertex, std::span<const std::uint8_t> rows) noexcept {
  if (rows.empty()) return false;
  bool carried = false;
  skin.each_carrier(vertex,
                    [&](int, int row, float weight) { carried = carried || (weight != 0 && rows[std::size_t(row)]); });
  return carried;
}

/// A sample that knows its vertex. @return that vertex as of now, -1 to forget it
int keep_apart(const SelfPair& pair, const Surface& surface, std::size_t i, int known, NetworkLoads& loads) noexcept {
  const int v = pair.sample[i];
  const Vec3d p = surface.position(v);
  const int u = walk_beside(pair, surface, i, known, p);
  const double far2 = geometry::distance2(surface.position(u), p);
  if (!(far2 < kForget * kForget)) return -1;
  if (clearance_at(surface, u, p).distance > kUntouched) return u;
  const Vec3d n = surface.normal(v);
  if (!(dot(n, surface.normal(u)) < 0)) return -1;
  const Clearance c = facing_clearance(surface, u, p, n);
  const double deep = -c.distance - double(pair.overlap[i]);
  if (!(deep > 0) || deep > kDeepestContact || far2 > kFarthestContact * kFarthestContact) return u;
  const double half = 0.5 * std::min(deep, kQuickestApart);
  push_skin(surface, v, half * c.normal, c.normal, kLimbStiffness, kLimbDamping, loads);
  push_skin(surface, u, -half * c.normal, c.normal, kLimbStiffness, kLimbDamping, loads);
  const Vec3d ours = tissue::skin_velocity(surface.nodes, *surface.skin, v);
  const Vec3d theirs = tissue::skin_velocity(surface.nodes, *surface.skin, u);
  const BodyRub rub = body_rub(kLimbStiffness * half, c.normal, ours, theirs);
  rub_skin(surface, v, rub, theirs, loads);
  rub_skin(surface, u, rub, ours, loads);
  return u;
}

/// Ways along the edges of the drawn skin from one vertex, up to `most` [m]; what is further has more.
std::vector<double> ways_from(const tissue::Skin& skin, int vertex, double most) {
  using Step = std::pair<double, int>;
  std::vector<double> way(std::size_t(skin.size()), 1e30);
  std::priority_queue<Step, std::vector<Step>, std::greater<>> next;
  way[std::size_t(vertex)] = 0;
  next.push({0, vertex});
  while (!next.empty()) {
    const auto [so_far, here] = next.top();
    next.pop();
    if (so_far > way[std::size_t(here)]) continue;
    for (int k = skin.neighbour_first[std::size_t(here)]; k < skin.neighbour_first[std::size_t(here) + 1]; ++k) {
      const int u = skin.neighbour[std::size_t(k)];
      const double d = so_far + double(length(skin.rest[std::size_t(u)] - skin.rest[std::size_t(here)]));
      if (!(d < way[std::size_t(u)]) || d > most) continue;
      way[std::size_t(u)] = d;
      next.push({d, u});
    }
  }
  return way;
}

}  // namespace

SelfPair make_self_pair(int organ, const Surface& drawn, std::span<const int> samples, double apart) {
  const tissue::Skin& skin = *drawn.skin;
  SelfPair pair;
  pair.organ = organ;
  pair.words = (skin.size() + 63) / 64;
  pair.sample.assign(samples.begin(), samples.end());
  pair.overlap.resize(samples.size());
  pair.others.resize(samples.size() * std::size_t(pair.words));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::vector<double> way = ways_from(skin, samples[i], apart);
    for (int v = 0; v < skin.size(); ++v)
      if (skin.at_surface(v) && way[std::size_t(v)] > apart)
        pair.others[i * std::size_t(pair.words) + std::size_t(v / 64)] |= std::uint64_t(1) << (v % 64);
    const int seen = look_ahead(pair, drawn, i);
    if (seen < 0) continue;
    const Vec3d p = drawn.position(samples[i]);
    const int beside = walk_beside(pair, drawn, i, seen, p);
    const Clearance c = facing_clearance(drawn, beside, p, drawn.normal(samples[i]));
    pair.overlap[i] = float(std::max(0.0, kDrawnGap - c.distance));
  }
  return pair;
}

double slenderness(const tissue::Skin& skin) {
  double volume6 = 0, area2 = 0;
  int first = -1;
  for (const auto& t : skin.triangles) {
    const Vec3d o = vec_cast<double>(skin.rest[std::size_t(skin.triangles[0][0])]);
    const Vec3d a = vec_cast<double>(skin.rest[std::size_t(t[0])]) - o,
                b = vec_cast<double>(skin.rest[std::size_t(t[1])]) - o,
                c = vec_cast<double>(skin.rest[std::size_t(t[2])]) - o;
    volume6 += dot(a, cross(b, c));
    area2 += length(cross(b - a, c - a));
    first = t[0];
  }
  if (first < 0 || !(volume6 > 0)) return 0;
  double longest = 0;
  for (int sweep = 0; sweep < 2; ++sweep) {  // from anywhere to an end, from there to the other
    const std::vector<double> way = ways_from(skin, first, 1e3);
    longest = 0;
    for (int v = 0; v < skin.size(); ++v)
      if (way[std::size_t(v)] < 1e3 && way[std::size_t(v)] > longest) longest = way[std::size_t(v)], first = v;
  }
  return longest * 3 * area2 / volume6;
}

void self_contact(const SelfPair& pair, const Surface& surface, std::span<const std::int32_t> part,
                  std::span<const std::uint8_t> folded, std::uint64_t tick, std::span<std::int32_t> nearest,
                  NetworkLoads& loads) noexcept {
  std::int32_t known = -1;
  for (const std::int32_t vertex : nearest) known = std::max(known, vertex);
  const std::uint64_t turns = known < 0 ? kTurns : kSoon;
  for (std::size_t i = 0; i < pair.sample.size(); ++i) {
    if (nearest[i] < 0) {
      if ((tick + i) % turns != 0) continue;
      nearest[i] = look_ahead(pair, surface, i);
      if (nearest[i] < 0) continue;
    }
    const int own = pair.sample[i], other = nearest[i];
    const bool parted = !part.empty() && part[std::size_t(own)] != part[std::size_t(other)];
    const bool lost = parted || is_carried(*surface.skin, own, folded) || is_carried(*surface.skin, other, folded);
    nearest[i] = lost ? -1 : keep_apart(pair, surface, i, other, loads);
  }
}

}  // namespace trocar::interactions
