#include <algorithm>
#include <cmath>
#include <limits>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/contact/nearest_skin.hpp>
#include <trocar/interactions/wetting/fluid_contact.hpp>

namespace trocar::interactions {
namespace {

// Where drops are too many to look so closely, in flight and on a surface, and the plane there is that of the nearest
// vertex: on a ball of 15 mm it is up to 0.2 mm above the skin.                                          [m]  Our
// choice
constexpr double kCrowdFlies = 0.004, kCrowdRuns = 0.003;
constexpr double kDeepestDrop = 0.004;  // [m] a drop that is deeper inside did not come from outside
constexpr double kLeaves = 0.003;       // [m] above its surface a running drop is on it no more
constexpr double kStride = 0.0025;      // [m] of a way that is looked at at once
constexpr double kParts = 0.1;          // [m/s] what goes away from a surface faster does not land on it.  Our choice
constexpr float kSafe = 1e-5f;          // [m] more than boxes of floats lose by rounding
constexpr int kPiece = 4;               // elements of a strand that share a bounding box

/// A point beside a body: how far outside (negative: inside), and the plane there.
struct WetSide {
  double off = 1;
  Vec3d point, normal, velocity;
  std::int32_t film = -1;
  bool there() const noexcept { return film >= 0; }
};

std::int32_t heaviest(const SkinPoint& p) noexcept {
  std::size_t most = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (p.weights[int(k)] > p.weights[int(most)]) most = k;
  return p.vertex[most];
}

/// Turns a fold's plane towards the side that `from` is on, and moves it to the fold's face there.
void take_side(const SheetView& sheet, Vec3d from, WetSide& b) noexcept {
  const double sign = dot(from - b.point, b.normal) < 0 ? -1 : 1;
  b.point += (sign * sheet.half_thickness) * b.normal;
  b.off = sign * b.off - sheet.half_thickness;
  b.normal = sign * b.normal;
  b.film = 2 * b.film + (sign < 0 ? 1 : 0);
}

WetSide beside_element(const StrandBody& body, const tissue::StrandState& s, int e, double share, Vec3d p) noexcept {
  const std::size_t n = std::size_t(e);
  const Vec3d axis = s.x[n] + share * (s.x[n + 1] - s.x[n]), from = p - axis;
  const double far = length(from), radius = body.model.radius[n];
  if (!(far > 1e-7) || far > radius + kWetReach) return {};
  const Vec3d normal = from / far;
  return {far - radius, axis + radius * normal, normal, s.v[n] + share * (s.v[n + 1] - s.v[n]), e + (share > 0.5)};
}

/// The nearest of the elements from `first` on, before `last`.
void beside_elements(const StrandBody& body, const tissue::StrandState& s, int first, int last, Vec3d p,
                     WetSide& best) noexcept {
  for (int e = first; e < last; ++e) {
    const std::size_t n = std::size_t(e);
    if (s.alive[n] == 0) continue;
    const Vec3d along = s.x[n + 1] - s.x[n];
    const double share = std::clamp(dot(p - s.x[n], along) / dot(along, along), 0.0, 1.0);
    const WetSide b = beside_element(body, s, e, share, p);
    if (b.there() && b.off < best.off) best = b;
  }
}

/// All bodies. With scratch it asks nothing twice; what it finds is the same without.
class Scene {
 public:
  const WetGround& ground;
  const WetOrder order;

  explicit Scene(const WetGround& on, WetWork* work = nullptr, bool crowd = false) noexcept
      : ground(on),
        order(on.order()),
        m_walls(int(on.surface_count()) - int(on.grids.size())),
        m_work(work),
        m_crowd(crowd) {
    if (!m_work) return;
    std::fill(m_work->normal_known.begin(), m_work->normal_known.end(), std::uint8_t(0));
    for (int body = 0; !order.is_strand(body); ++body) m_work->bounds[std::size_t(body)] = surface(body).pose->bounds;
    for (std::size_t k = 0; k < ground.bodies.strand_count(); ++k) bound_strand(k);
    lay_out_blocks(float(m_crowd ? kCrowdFlies : kWetReach) + kSafe);
  }

  using Candidate = WetWork::Candidate;
  /// Bodies that may be within reach of a way, ascending. Only with scratch.
  std::span<const Candidate> near(Vec3d from, Vec3d to) const noexcept {
    WetWork::Blocks& blocks = m_work->blocks;
    const int met = find_hits(vec_cast<float>(from), vec_cast<float>(to), blocks);
    std::size_t bodies = 0;
    std::int32_t hits = 0, last = -1;
    for (int k = 0; k < met; ++k) {
      const std::size_t i = std::size_t(blocks.hit[std::size_t(k)]);
      const std::int32_t body = blocks.body[i], block = blocks.block[i];
      if (body != last) m_work->near[bodies++] = {body, hits, hits};
      last = body;
      if (block >= 0) m_work->hits[std::size_t(hits++)] = block;
      m_work->near[bodies - 1].last = hits;
    }
    return {m_work->near.data(), bodies};
  }

  WetSide beside(int body, Vec3d from, Vec3d p) const noexcept { return beside({body, 0, 0}, from, p, kWetReach); }
  /// @param flies  to or from p: looks further
  WetSide beside(const Candidate& c, Vec3d from, Vec3d p, bool flies) const noexcept {
    return beside(c, from, p, !m_crowd ? kWetReach : flies ? kCrowdFlies : kCrowdRuns);
  }
  WetSide beside_vertex(int body, int vertex, Vec3d p) const noexcept {
    const Surface& on = surface(body);
    if (m_crowd && order.is_surface(body)) {
      const Vec3d n = normal(body, vertex);
      const double off = dot(p - on.position(vertex), n);
      return {off, p - off * n, n, on.velocity(vertex), vertex};
    }
    SkinPoint near = nearest_on_faces(on, vertex, p);
    for (std::size_t k = 0; k < 3; ++k) near.normal += near.weights[int(k)] * normal(body, near.vertex[k]);
    near.normal = normalised(near.normal, normal(body, vertex));
    const int v = heaviest(near);
    return {dot(p - near.point, near.normal), near.point, near.normal, on.velocity(v), v};
  }
  const Surface& surface(int body) const noexcept {
    return order.is_surface(body) ? ground.bodies.work->surfaces[order.index(body)]
                                  : ground.bodies.membrane(order.index(body)).surface;
  }
  fluids::Contact contact(int body, const WetSide& at) const noexcept {
    return {vec_cast<float>(at.point), vec_cast<float>(at.normal), vec_cast<float>(at.velocity), body,
            ground.first[std::size_t(body)] + at.film};
  }
  int body_of(std::int32_t place) const noexcept {
    if (place < 0 || place >= ground.first.back()) return -1;
    return int(std::upper_bound(ground.first.begin(), ground.first.end(), place) - ground.first.begin()) - 1;
  }

 private:
  const int m_walls;  // the first surface that has a grid
  WetWork* const m_work;
  const bool m_crowd;

  /// Blocks whose box the box of a way meets, in blocks.hit. Without a branch that depends on them.
  static int find_hits(Vec3f from, Vec3f to, WetWork::Blocks& blocks) noexcept {
    const Vec3f least{std::min(from.x, to.x), std::min(from.y, to.y), std::min(from.z, to.z)};
    const Vec3f most{std::max(from.x, to.x), std::max(from.y, to.y), std::max(from.z, to.z)};
    const float *x0 = blocks.low[0].data(), *y0 = blocks.low[1].data(), *z0 = blocks.low[2].data();
    const float *x1 = blocks.high[0].data(), *y1 = blocks.high[1].data(), *z1 = blocks.high[2].data();
    std::int32_t* __restrict inside = blocks.inside.data();
    const int count = blocks.count;
    for (int i = 0; i < count; ++i)
      inside[i] = int(most.x > x0[i]) & int(least.x < x1[i]) & int(most.y > y0[i]) & int(least.y < y1[i]) &
                  int(most.z > z0[i]) & int(least.z < z1[i]);
    std::int32_t* hit = blocks.hit.data();
    int n = 0;
    for (int i = 0; i < count; ++i) {
      hit[n] = i;
      n += inside[i];
    }
    return n;
  }
  /// @param block  -1: all of the body
  void add_block(int body, int block, const tissue::Box& box, float more) noexcept {
    WetWork::Blocks& blocks = m_work->blocks;
    const std::size_t i = std::size_t(blocks.count++);
    for (int k = 0; k < 3; ++k) blocks.low[k][i] = box.low[k] - more, blocks.high[k][i] = box.high[k] + more;
    blocks.body[i] = body, blocks.block[i] = block;
  }
  void lay_out_blocks(float more) noexcept {
    m_work->blocks.count = 0;
    const std::size_t room = m_work->blocks.body.size() - std::size_t(ground.count());  // besides one a body
    for (int body = 0; body < ground.count(); ++body) {
      const bool whole = order.is_strand(body) || is_still(body);
      const std::size_t n = whole ? 0 : surface(body).pose->block.size();
      if (whole || std::size_t(m_work->blocks.count) + n > room) {  // a cut may have made more than there is room for
        add_block(body, -1, m_work->bounds[std::size_t(body)], more);
        continue;
      }
      for (std::size_t k = 0; k < n; ++k) add_block(body, int(k), surface(body).pose->block[k], more);
    }
  }
  /// Of a moving skin: the same for all who ask in this tick.
  Vec3d normal(int body, int vertex) const noexcept {
    const Surface& on = surface(body);
    if (!m_work || !on.moves()) return on.normal(vertex);
    const std::size_t place =
        std::size_t(ground.first[std::size_t(body)] + (order.is_surface(body) ? vertex : 2 * vertex));
    if (place >= std::size_t(ground.first[std::size_t(body) + 1])) return on.normal(vertex);  // a cut has made it
    if (m_work->normal_known[place] == 0) {
      m_work->normal[place] = on.normal(vertex);
      m_work->normal_known[place] = 1;
    }
    return m_work->normal[place];
  }
  bool is_still(int body) const noexcept { return body >= m_walls && order.is_surface(body); }
  /// Of which blocks: those of the candidate, or all if it has none.
  WetSide beside(const Candidate& c, Vec3d from, Vec3d p, double reach) const noexcept {
    if (order.is_surface(c.body)) return beside_surface(c, p, reach);
    return order.is_sheet(c.body) ? beside_sheet(c, from, p, reach) : beside_strand(order.index(c.body), p);
  }
  int nearest_vertex(const Candidate& c, const Surface& on, Vec3d p, double reach) const noexcept {
    if (is_still(c.body)) return ground.grids[std::size_t(c.body - m_walls)].nearest(*on.skin, p);
    if (c.first == c.last) return nearest_vertex_near(on, p, reach);
    return nearest_vertex_near(on, p, reach, {m_work->hits.data() + c.first, std::size_t(c.last - c.first)});
  }
  WetSide beside_surface(const Candidate& c, Vec3d p, double reach) const noexcept {
    const Surface& on = surface(c.body);
    if (!on.pose->bounds.reaches(p, reach)) return {};
    const int v = nearest_vertex(c, on, p, reach);
    return v < 0 ? WetSide{} : beside_vertex(c.body, v, p);
  }
  /// @param from  where it came from: gives the side
  WetSide beside_sheet(const Candidate& c, Vec3d from, Vec3d p, double reach) const noexcept {
    const int body = c.body;
    WetSide found = beside_surface(c, p, reach);
    if (!found.there()) return found;
    const Vec3d flat = (p - found.point) - dot(p - found.point, found.normal) * found.normal;
    if (dot(flat, flat) > 1e-6) return {};  // past its border
    take_side(ground.bodies.membrane(order.index(body)), from, found);
    return found;
  }
  WetSide beside_strand(std::size_t k, Vec3d p) const noexcept {
    const int elements = ground.bodies.strand(k).nodes() - 1;
    WetSide best;
    if (!m_work) {
      beside_elements(ground.bodies.strand(k), ground.bodies.strand_state(k), 0, elements, p, best);
      return best;
    }
    for (int piece = m_work->first_piece[k]; piece < m_work->first_piece[k + 1]; ++piece) {
      if (!m_work->pieces[std::size_t(piece)].reaches(p, kWetReach)) continue;
      const int first = (piece - m_work->first_piece[k]) * kPiece;
      beside_elements(ground.bodies.strand(k), ground.bodies.strand_state(k), first, std::min(first + kPiece, elements),
                      p, best);
    }
    return best;
  }
  /// Boxes around a strand and its pieces, larger by its radius and what rounding may misplace.
  void bound_strand(std::size_t k) noexcept {
    const StrandBody& body = ground.bodies.strand(k);
    tissue::Box& whole = m_work->bounds[std::size_t(order.strand(k))] = {};
    for (int piece = m_work->first_piece[k]; piece < m_work->first_piece[k + 1]; ++piece) {
      tissue::Box& box = m_work->pieces[std::size_t(piece)] = {};
      const int first = (piece - m_work->first_piece[k]) * kPiece, last = std::min(first + kPiece, body.nodes() - 1);
      for (int e = first; e < last; ++e) {
        const float thick = float(body.model.radius[std::size_t(e)]) + kSafe;
        for (const Vec3d x :
             {ground.bodies.strand_state(k).x[std::size_t(e)], ground.bodies.strand_state(k).x[std::size_t(e) + 1]}) {
          box.add(vec_cast<float>(x) - Vec3f{thick, thick, thick});
          box.add(vec_cast<float>(x) + Vec3f{thick, thick, thick});
        }
      }
      whole.add(box.low), whole.add(box.high);
    }
  }
};

/// The first body that a drop of this radius meets on its way. A jet out of a vessel begins within the tissue that
/// carries the vessel, and leaves it.
fluids::Contact meet(const Scene& scene, Vec3d from, Vec3d to, Vec3d velocity, double radius) noexcept {
  const Vec3d way = to - from;
  const std::span<const WetWork::Candidate> near = scene.near(from, to);
  if (near.empty()) return {};
  const int looks = 1 + std::min(int(length(way) / kStride), 15);
  for (int k = 1; k <= looks; ++k) {
    const Vec3d p = from + (double(k) / looks) * way;
    int found = -1;
    WetSide most;
    for (const WetWork::Candidate& c : near) {
      const WetSide b = scene.beside(c, from, p, true);
      if (!b.there() || b.off > 0.5 * radius || b.off < -kDeepestDrop || b.off > most.off) continue;
      if (dot(velocity - b.velocity, b.normal) > kParts) continue;
      most = b;
      found = c.body;
    }
    if (found >= 0) return scene.contact(found, most);
  }
  return {};
}

/// Where the surface is that a drop runs on, looked for from where it was.
WetSide follow(const Scene& scene, int body, std::int32_t film, Vec3d p) noexcept {
  if (scene.order.is_strand(body)) return scene.beside(body, p, p);
  const Surface& surface = scene.surface(body);
  const bool sheet = scene.order.is_sheet(body);
  const int start = sheet ? film / 2 : film;
  WetSide b = scene.beside_vertex(body, walk_to_nearest(surface, start, p), p);
  if (sheet) take_side(scene.ground.bodies.membrane(scene.order.index(body)), p, b);
  return b;
}

/// What a running drop is on now: its body, or another one that it has run into.
fluids::Contact stay(const Scene& scene, const fluids::DropletState& s, int drop, Vec3d p) noexcept {
  const int body = s.body[std::size_t(drop)];
  const std::int32_t film = s.ground[std::size_t(drop)].film;
  if (body >= scene.ground.count() || film < 0) return {};
  const double radius = double(s.radius[std::size_t(drop)]);
  int found = -1;
  WetSide best;
  const WetSide own = follow(scene, body, film - scene.ground.first[std::size_t(body)], p);
  if (own.there() && length(p - own.point) < kLeaves + radius) best = own, found = body;
  for (const WetWork::Candidate& other : scene.near(p, p)) {
    if (other.body == body) continue;
    const WetSide b = scene.beside(other, p, p, false);
    if (!b.there() || b.off > 0.25 * radius || b.off < -kDeepestDrop || b.off > best.off) continue;
    best = b;
    found = other.body;
  }
  return found < 0 ? fluids::Contact{} : scene.contact(found, best);
}

Vec3d place_of(const std::vector<float>& x, const std::vector<float>& y, const std::vector<float>& z,
               std::size_t i) noexcept {
  return {double(x[i]), double(y[i]), double(z[i])};
}

}  // namespace

std::vector<std::int32_t> film_places(std::span<const tissue::Skin* const> skins,
                                      std::span<const tissue::Skin* const> sheets,
                                      std::span<const StrandBody> strands) {
  std::vector<std::int32_t> first{0};
  for (const tissue::Skin* skin : skins) first.push_back(first.back() + skin->size());
  for (const tissue::Skin* skin : sheets) first.push_back(first.back() + 2 * skin->size());
  for (const StrandBody& strand : strands) first.push_back(first.back() + strand.nodes());
  return first;
}

WetPlace wet_place(const WetGround& ground, Vec3d down, std::int32_t place) noexcept {
  const Scene scene(ground);
  const int body = scene.body_of(place);
  if (body < 0) return {};
  const int number = place - ground.first[std::size_t(body)];
  if (scene.order.is_strand(body)) {
    const std::size_t k = scene.order.index(body), node = std::size_t(number);
    const double radius =
        ground.bodies.strand(k).model.radius[std::min(node, std::size_t(ground.bodies.strand(k).nodes() - 2))];
    return {ground.bodies.strand_state(k).x[node] + radius * down, down, ground.bodies.strand_state(k).v[node], body};
  }
  const Surface& surface = scene.surface(body);
  const bool sheet = scene.order.is_sheet(body);
  const int v = sheet ? number / 2 : number;
  WetPlace out{surface.position(v), surface.normal(v), surface.velocity(v), body};
  if (!sheet) return out;
  if (number % 2 == 1) out.normal = -out.normal;
  out.point += ground.bodies.membrane(scene.order.index(body)).half_thickness * out.normal;
  return out;
}

bool covered(const WetGround& ground, Vec3d p, double reach) noexcept {
  const Scene scene(ground);
  for (int body = 0; body < ground.count(); ++body) {
    const WetSide b = scene.beside(body, p, p);
    if (!b.there() || b.off > reach || b.off < -kDeepestDrop) continue;
    const Vec3d off = p - b.point, flat = off - dot(off, b.normal) * b.normal;
    if (dot(flat, flat) < reach * reach) return true;  // not past its border
  }
  return false;
}

WetWork make_wet_work(std::span<const StrandBody> strands, std::span<const std::int32_t> first) {
  WetWork w;
  w.bounds.resize(first.size() - 1);
  w.near.resize(first.size());
  // A vertex has one place of film or two: so many blocks at most, and one that is not full a body.
  const std::size_t blocks = std::size_t(first.back()) / tissue::kSkinBlock + 2 * first.size();
  for (int k = 0; k < 3; ++k) w.blocks.low[k].resize(blocks), w.blocks.high[k].resize(blocks);
  w.blocks.body.resize(blocks), w.blocks.block.resize(blocks), w.blocks.inside.resize(blocks),
      w.blocks.hit.resize(blocks + 1), w.hits.resize(blocks);
  w.first_piece = {0};
  for (const StrandBody& strand : strands)
    w.first_piece.push_back(w.first_piece.back() + (strand.nodes() - 1 + kPiece - 1) / kPiece);
  w.pieces.resize(std::size_t(w.first_piece.back()));
  w.normal.resize(std::size_t(first.back()));
  w.normal_known.resize(w.normal.size());
  return w;
}

void answer_drops(const WetGround& ground, Vec3d down, const fluids::DropletState& s, fluids::DropletWork& w,
                  WetWork& wet) noexcept {
  if (w.questions == 0 && w.film_questions == 0) return;
  const Scene scene(ground, &wet, w.ways > 1);
  for (int k = 0; k < w.questions; ++k) {
    const std::size_t i = std::size_t(w.asking[std::size_t(k)]);
    const Vec3d now = place_of(s.x, s.y, s.z, i);
    if (s.body[i] >= 0) {
      w.answers[std::size_t(k)] = stay(scene, s, int(i), now);
      continue;
    }
    Vec3d to = place_of(w.to_x, w.to_y, w.to_z, i);
    const Vec3d velocity = place_of(s.vx, s.vy, s.vz, i);
    if (w.ways > 1) to = now + double(ways_of(w, vec_cast<float>(velocity))) * (to - now);
    w.answers[std::size_t(k)] = meet(scene, now, to, velocity, double(s.radius[i]));
  }
  for (int k = 0; k < w.film_questions; ++k) {
    const std::int32_t place = w.overfull[std::size_t(k)];
    const WetPlace at = wet_place(ground, down, place);
    w.film_answers[std::size_t(k)] = {vec_cast<float>(at.point), vec_cast<float>(at.normal),
                                      vec_cast<float>(at.velocity), at.body, place};
  }
}

}  // namespace trocar::interactions
