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
constexpr std::uint64_t kTurnsOf = 8;  // [ticks] in which all blocks have looked
constexpr double kBeside = 0.0005;     // [m] from a membrane's border: a sample there has no side of it

/// Blocks of a skin; of more than there is room for the first.
struct BlocksNear {
  std::array<std::int32_t, 128> block;
  std::size_t count = 0;

  void find(const tissue::SkinPose& pose, const tissue::Box& box) noexcept {
    for (std::size_t b = 0; b < pose.block.size() && count < block.size(); ++b)
      if (pose.block[b].near_box(box, float(kFound))) block[count++] = std::int32_t(b);
  }
  bool any_near(const tissue::SkinPose& pose, const tissue::Box& box) const noexcept {
    for (const std::int32_t b : all())
      if (pose.block[std::size_t(b)].near_box(box, float(kFound))) return true;
    return false;
  }
  std::span<const std::int32_t> all() const noexcept { return {block.data(), count}; }
};

/// What a sample remembers: a vertex, and of an open membrane its side of it.
struct Known {
  int vertex = -1;
  bool behind = false;
};

/// The box around a ball.
tissue::Box ball(Vec3d p, double radius) noexcept {
  tissue::Box box;
  box.add(vec_cast<float>(p - Vec3d{radius, radius, radius}));
  box.add(vec_cast<float>(p + Vec3d{radius, radius, radius}));
  return box;
}

class Meeting {
 public:
  Meeting(const Bodies& bodies, BodyId on) noexcept
      : m_bodies(bodies),
        m_on(on),
        m_sides(has_two_sides(bodies.models, on)),
        m_half_thickness(on.is(BodyKind::organ) ? 0 : bodies.membrane(on.index()).half_thickness),
        surface(on.is(BodyKind::organ) ? bodies.organ(on.index()) : bodies.membrane(on.index()).surface) {}

  /// Where a sample that knows a place is next. @return does it know one?
  bool follow(Vec3d p, std::int32_t& nearest) const noexcept {
    Known known = read(nearest);
    known.vertex = walk_to_nearest(surface, known.vertex, p);
    if (!(geometry::distance2(surface.position(known.vertex), p) < kLetGo * kLetGo)) {
      nearest = -1;
      return false;
    }
    if (m_sides && beside(known.vertex, p)) known.behind = is_behind(known.vertex, p);
    nearest = written(known);
    return true;
  }
  bool find(Vec3d p, double radius, std::span<const std::int32_t> blocks, std::int32_t& nearest) const noexcept {
    const int vertex = nearest_vertex_near(surface, p, kFound + radius, blocks);
    nearest = vertex < 0 ? -1 : written({vertex, m_sides && is_behind(vertex, p)});
    return vertex >= 0;
  }
  /// How deep a ball about p is in it, and along which normal; 0: it does not touch.
  /// @param reach  of the sample: its radius less the overlap it was drawn with [m]
  double depth(Vec3d p, double reach, std::int32_t nearest, Vec3d& normal) const noexcept {
    const Known known = read(nearest);
    const Clearance c = clearance_at(surface, known.vertex, p);
    const double side = known.behind ? -1 : 1;
    const double deep = reach + m_half_thickness - side * c.distance;
    normal = side * c.normal;
    if (!(deep > 0) || deep > kDeepestContact || surface.torn(known.vertex)) return 0;
    if (geometry::distance2(surface.position(known.vertex), p) > kFarthestContact * kFarthestContact) return 0;
    if (m_sides && beside(known.vertex, p)) return 0;
    return std::min(deep, kQuickestApart);
  }
  Vec3d velocity(std::int32_t nearest) const noexcept { return surface.velocity(read(nearest).vertex); }
  /// Half of the way is the sample's, half its own.
  void push_back(std::int32_t nearest, double deep, Vec3d n, Press press) const noexcept {
    press_vertex(surface, read(nearest).vertex, -0.5 * deep, n, press, loads());
  }
  void rub_back(std::int32_t nearest, const BodyRub& rub, Vec3d ours) const noexcept {
    rub_skin(surface, read(nearest).vertex, rub, ours, loads());
  }

 private:
  Known read(std::int32_t nearest) const noexcept {
    return m_sides ? Known{nearest / 2, nearest % 2 != 0} : Known{nearest, false};
  }
  std::int32_t written(Known k) const noexcept { return m_sides ? 2 * k.vertex + (k.behind ? 1 : 0) : k.vertex; }
  bool is_behind(int vertex, Vec3d p) const noexcept { return clearance_at(surface, vertex, p).distance < 0; }
  /// Is there no membrane above or below p, as beyond a border or next to what was cut?
  bool beside(int vertex, Vec3d p) const noexcept {
    const tissue::Skin& skin = *surface.skin;
    const std::span<const std::uint8_t> parted = m_bodies.membrane(m_on.index()).parted;
    for (int k = skin.face_first[std::size_t(vertex)]; k < skin.face_first[std::size_t(vertex) + 1]; ++k)
      if (parted[std::size_t(skin.face[std::size_t(k)])]) return true;
    const Vec3d off = p - nearest_on_faces(surface, vertex, p).point, n = surface.normal(vertex);
    const double above = dot(off, n);
    return dot(off, off) - above * above > kBeside * kBeside + above * above;
  }
  NetworkLoads& loads() const noexcept { return loads_on(m_bodies, m_on); }

  const Bodies& m_bodies;
  const BodyId m_on;
  const bool m_sides;
  const double m_half_thickness;

 public:
  const Surface& surface;
};

void skin_meets(const Meeting& on, const Surface& samples, double reach, int v, std::int32_t nearest,
                NetworkLoads& loads) noexcept {
  const Vec3d p = samples.position(v);
  Vec3d n;
  const double deep = on.depth(p, reach, nearest, n);
  if (!(deep > 0) || samples.torn(v)) return;
  const Vec3d ours = samples.velocity(v), theirs = on.velocity(nearest);
  const Press press = press_on(on.surface, samples.swings, deep, ours, theirs, n);
  press_vertex(samples, v, 0.5 * deep, n, press, loads);
  on.push_back(nearest, deep, n, press);
  const BodyRub rub = body_rub(press.k * 0.5 * deep, n, ours, theirs);
  rub_skin(samples, v, rub, theirs, loads);
  on.rub_back(nearest, rub, ours);
}

/// Does one of them know a place? All others have -1.
bool any_known(std::span<const std::int32_t> nearest) noexcept {
  std::int32_t all = -1;
  for (const std::int32_t n : nearest) all &= n;
  return all >= 0;
}

/// Nothing is near: what has come to another side meanwhile shall not be sent back.
void forget(std::uint64_t tick, std::span<std::int32_t> nearest) noexcept {
  if (tick % kTurnsOf == 0 && any_known(nearest)) std::fill(nearest.begin(), nearest.end(), -1);
}

void skin_on_skin(const Meeting& on, const CarriedPair& pair, const Surface& samples, double radius, std::uint64_t tick,
                  std::span<std::int32_t> nearest, NetworkLoads& loads) noexcept {
  constexpr std::size_t kBlock = std::size_t(tissue::kSkinBlock), kPatch = std::size_t(tissue::kSkinPatch);
  const tissue::SkinPose &pose = *samples.pose, &theirs = *on.surface.pose;
  if (!theirs.bounds.near_box(pose.bounds, float(kLetGo))) return forget(tick, nearest);
  const std::size_t room = nearest.size();  // cuts have made more than that
  for (std::size_t first = 0; first < room; first += kBlock) {
    const std::size_t b = first / kBlock, end = std::min(first + kBlock, room);
    BlocksNear blocks;
    if ((tick + b) % kTurnsOf == 0 && theirs.bounds.near_box(pose.block[b], float(kFound)))
      blocks.find(theirs, pose.block[b]);
    if (blocks.count == 0 && !any_known(nearest.subspan(first, end - first))) continue;
    for (std::size_t from = first; from < end; from += kPatch) {
      const std::size_t to = std::min(from + kPatch, end);
      const bool looks = blocks.any_near(theirs, pose.patch[from / kPatch]);
      if (!looks && !any_known(nearest.subspan(from, to - from))) continue;
      for (std::size_t v = from; v < to; ++v) {
        const Vec3d p = samples.position(int(v));
        if (nearest[v] >= 0 ? on.follow(p, nearest[v])
                            : looks && pair.overlap[v] < CarriedPair::kNever && samples.skin->at_surface(int(v)) &&
                                  on.find(p, radius, blocks.all(), nearest[v]))
          skin_meets(on, samples, radius - double(pair.overlap[v]), int(v), nearest[v], loads);
      }
    }
  }
}

void rod_on_skin(const Meeting& on, const CarriedPair& pair, const StrandBody& body, const tissue::StrandState& s,
                 std::uint64_t tick, std::span<std::int32_t> nearest, StrandLoads& loads) noexcept {
  tissue::Box box;
  for (const Vec3d& p : s.x) box.add(vec_cast<float>(p));
  if (!on.surface.pose->bounds.near_box(box, float(kLetGo))) return forget(tick, nearest);
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const Vec3d p = s.x[i];
    const int e = std::min(int(i), body.nodes() - 2);
    const double radius = body.model.radius[std::size_t(e)];
    if (nearest[i] >= 0) {
      if (!on.follow(p, nearest[i])) continue;
    } else {
      if (pair.overlap[i] == CarriedPair::kNever || (tick + i) % kTurnsOf != 0 ||
          !on.surface.pose->bounds.reaches(p, kFound + radius))
        continue;
      BlocksNear blocks;
      blocks.find(*on.surface.pose, ball(p, radius));
      if (!on.find(p, radius, blocks.all(), nearest[i])) continue;
    }
    Vec3d n;
    const double deep = on.depth(p, radius - double(pair.overlap[i]), nearest[i], n);
    if (!(deep > 0)) continue;
    const Vec3d ours = s.v[i], theirs = on.velocity(nearest[i]);
    const Press press = press_on(on.surface, false, deep, ours, theirs, n);
    const double w = int(i) == e ? 0.0 : 1.0;
    loads.add(press_strand(e, w, p + 0.5 * deep * n, n, press), {Owner::body, 0, 0});
    on.push_back(nearest[i], deep, n, press);
    const BodyRub rub = body_rub(press.k * 0.5 * deep, n, ours, theirs);
    rub_strand(e, w, rub, theirs, loads);
    on.rub_back(nearest[i], rub, ours);
  }
}

}  // namespace

bool has_two_sides(const BodyModels& models, BodyId body) noexcept {
  return body.is(BodyKind::membrane) && !models.membranes[body.index()].sheet.closed();
}

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
