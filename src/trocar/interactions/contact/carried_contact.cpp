#include <algorithm>
#include <array>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/contact/body_friction.hpp>
#include <trocar/interactions/contact/body_push.hpp>
#include <trocar/interactions/contact/carried_contact.hpp>
#include <trocar/interactions/contact/nearest_skin.hpp>

namespace trocar::interactions {
namespace {

constexpr double kFound = 0.006;       // [m] to the nearest vertex: a sample begins to remember it
constexpr double kLetGo = 0.015;       // [m] ... and forgets it
constexpr std::uint64_t kTurnsOf = 4;  // [ticks] in which all blocks have looked

/// Blocks of a skin; of more than there is room for the first.
struct BlocksNear {
  std::array<std::int32_t, 128> block;
  std::size_t count = 0;

  void find(const tissue::SkinPose& pose, const tissue::Box& box) noexcept {
    for (std::size_t b = 0; b < pose.block.size() && count < block.size(); ++b)
      if (pose.block[b].near_box(box, float(kFound))) block[count++] = std::int32_t(b);
  }
  std::span<const std::int32_t> all() const noexcept { return {block.data(), count}; }
};

class Meeting {
 public:
  Meeting(const Bodies& bodies, BodyId on) noexcept
      : m_bodies(bodies),
        m_on(on),
        surface(on.is(BodyKind::organ) ? bodies.organ(on.index()) : bodies.membrane(on.index()).surface) {}

  /// Where a sample that knows a vertex is next. @return does it know one?
  bool follow(Vec3d p, std::int32_t& vertex) const noexcept {
    vertex = walk_to_nearest(surface, vertex, p);
    if (geometry::distance2(surface.position(vertex), p) < kLetGo * kLetGo) return true;
    vertex = -1;
    return false;
  }
  bool find(Vec3d p, std::span<const std::int32_t> blocks, std::int32_t& vertex) const noexcept {
    vertex = nearest_vertex_near(surface, p, kFound, blocks);
    return vertex >= 0;
  }
  /// How deep a ball about p is in it, and along which normal; 0: it does not touch.
  double depth(Vec3d p, double radius, int vertex, Vec3d& normal) const noexcept {
    const Clearance c = clearance_at(surface, vertex, p);
    const double deep = radius - c.distance;
    normal = c.normal;
    if (!(deep > 0) || deep > kDeepestContact || surface.torn(vertex)) return 0;
    if (geometry::distance2(surface.position(vertex), p) > kFarthestContact * kFarthestContact) return 0;
    return std::min(deep, kQuickestApart);
  }
  /// Half of the way is the sample's, half its own.
  void push_back(int vertex, double deep, Vec3d n) const noexcept {
    push_skin(surface, vertex, -0.5 * deep * n, n, kBodyStiffness, kBodyDamping, loads_on(m_bodies, m_on));
  }
  void rub_back(int vertex, const BodyRub& rub, Vec3d ours) const noexcept {
    rub_skin(surface, vertex, rub, ours, loads_on(m_bodies, m_on));
  }

 private:
  const Bodies& m_bodies;
  const BodyId m_on;

 public:
  const Surface& surface;
};

void skin_meets(const Meeting& on, const Surface& samples, double radius, int v, std::int32_t vertex,
                NetworkLoads& loads) noexcept {
  const Vec3d p = samples.position(v);
  Vec3d n;
  const double deep = on.depth(p, radius, vertex, n);
  if (!(deep > 0) || samples.torn(v)) return;
  push_skin(samples, v, 0.5 * deep * n, n, kBodyStiffness, kBodyDamping, loads);
  on.push_back(vertex, deep, n);
  const Vec3d ours = samples.velocity(v), theirs = on.surface.velocity(vertex);
  const BodyRub rub = body_rub(kBodyStiffness * 0.5 * deep, n, ours, theirs);
  rub_skin(samples, v, rub, theirs, loads);
  on.rub_back(vertex, rub, ours);
}

void skin_on_skin(const Meeting& on, const CarriedPair& pair, const Surface& samples, double radius, std::uint64_t tick,
                  std::span<std::int32_t> nearest, NetworkLoads& loads) noexcept {
  const tissue::SkinPose& pose = *samples.pose;
  if (!on.surface.pose->bounds.near_box(pose.bounds, float(kLetGo))) return;
  for (std::size_t b = 0; b < pose.block.size(); ++b) {
    const std::size_t first = b * std::size_t(tissue::kSkinBlock);
    const std::size_t last = std::min(first + std::size_t(tissue::kSkinBlock), nearest.size());
    if (first >= last) break;  // cuts have made more than there is room for
    const bool known =
        *std::max_element(nearest.begin() + std::ptrdiff_t(first), nearest.begin() + std::ptrdiff_t(last)) >= 0;
    BlocksNear blocks;
    if ((tick + b) % kTurnsOf == 0 && on.surface.pose->bounds.near_box(pose.block[b], float(kFound)))
      blocks.find(*on.surface.pose, pose.block[b]);
    if (!known && blocks.count == 0) continue;
    for (std::size_t v = first; v < last; ++v) {
      const Vec3d p = samples.position(int(v));
      if (nearest[v] >= 0 ? !on.follow(p, nearest[v])
                          : pair.never[v] || blocks.count == 0 || !samples.skin->at_surface(int(v)) ||
                                !on.find(p, blocks.all(), nearest[v]))
        continue;
      skin_meets(on, samples, radius, int(v), nearest[v], loads);
    }
  }
}

void rod_on_skin(const Meeting& on, const CarriedPair& pair, const StrandBody& body, const tissue::StrandState& s,
                 std::uint64_t tick, std::span<std::int32_t> nearest, StrandLoads& loads) noexcept {
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const Vec3d p = s.x[i];
    const int e = std::min(int(i), body.nodes() - 2);
    const double radius = body.model.radius[std::size_t(e)];
    if (nearest[i] >= 0) {
      if (!on.follow(p, nearest[i])) continue;
    } else {
      if (pair.never[i] || (tick + i) % kTurnsOf != 0 || !on.surface.pose->bounds.reaches(p, kFound + radius)) continue;
      nearest[i] = nearest_vertex_near(on.surface, p, kFound + radius);
      if (nearest[i] < 0) continue;
    }
    Vec3d n;
    const double deep = on.depth(p, radius, nearest[i], n);
    if (!(deep > 0)) continue;
    tissue::StrandLoad load;
    load.element = e;
    load.w = int(i) == e ? 0.0 : 1.0;
    load.k = kBodyStiffness;
    load.dir = n;
    load.d = kBodyDamping;
    load.x0 = p + 0.5 * deep * n;
    loads.add(load, {Owner::body, 0, 0});
    on.push_back(nearest[i], deep, n);
    const Vec3d ours = s.v[i], theirs = on.surface.velocity(nearest[i]);
    const BodyRub rub = body_rub(kBodyStiffness * 0.5 * deep, n, ours, theirs);
    rub_strand(e, load.w, rub, theirs, loads);
    on.rub_back(nearest[i], rub, ours);
  }
}

}  // namespace

void carried_contact(const Bodies& bodies, const CarriedPair& pair, std::uint64_t tick,
                     std::span<std::int32_t> nearest) noexcept {
  const Meeting on(bodies, pair.on);
  const std::size_t i = pair.body.index();
  if (pair.body.is(BodyKind::strand))
    return rod_on_skin(on, pair, bodies.strand(i), bodies.strand_state(i), tick, nearest,
                       bodies.work->strands[i].loads);
  const bool organ = pair.body.is(BodyKind::organ);
  const Surface& samples = organ ? bodies.organ(i) : bodies.membrane(i).surface;
  const double radius = organ ? 0 : bodies.membrane(i).half_thickness;
  skin_on_skin(on, pair, samples, radius, tick, nearest, loads_on(bodies, pair.body));
}

}  // namespace trocar::interactions
