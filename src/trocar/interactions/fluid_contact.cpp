#include <algorithm>
#include <cmath>

#include <trocar/geometry/nearest.hpp>
#include <trocar/interactions/fluid_contact.hpp>
#include <trocar/interactions/nearest_skin.hpp>

namespace trocar::interactions {
namespace {

using fluids::Contact;

constexpr double kReach = 0.006;    // [m] between a point and the vertex next to it: more than skins' edges are long
constexpr double kDeepest = 0.004;  // [m] a drop that is deeper inside did not come from outside
constexpr double kLeaves = 0.003;   // [m] above its surface a running drop is on it no more
constexpr double kStride = 0.0025;  // [m] of a way that is looked at at once
constexpr double kParts = 0.1;      // [m/s] what goes away from a surface faster does not land on it.  Our choice

/// A point beside a body: how far outside (negative: inside), and the plane there.
struct Beside {
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

Vec3d velocity_of(const Surface& s, int vertex) noexcept {
  return s.moves() ? tissue::skin_velocity(s.nodes, *s.skin, vertex) : Vec3d{};
}

Beside beside_vertex(const Surface& surface, int vertex, Vec3d p) noexcept {
  const SkinPoint near = nearest_skin_point(surface, vertex, p);
  const int v = heaviest(near);
  return {dot(p - near.point, near.normal), near.point, near.normal, velocity_of(surface, v), v};
}

bool in_reach(const Surface& surface, Vec3d p) noexcept { return surface.pose->bounds.reaches(p, kReach); }

Beside beside_surface(const Surface& surface, Vec3d p) noexcept {
  if (!in_reach(surface, p)) return {};
  const int v = nearest_vertex_near(surface, p, kReach);
  return v < 0 ? Beside{} : beside_vertex(surface, v, p);
}

/// Turns a fold's plane towards the side that `from` is on, and moves it to the fold's face there.
void take_side(const SheetView& sheet, Vec3d from, Beside& b) noexcept {
  const double sign = dot(from - b.point, b.normal) < 0 ? -1 : 1;
  b.point += (sign * sheet.half_thickness) * b.normal;
  b.off = sign * b.off - sheet.half_thickness;
  b.normal = sign * b.normal;
  b.film = 2 * b.film + (sign < 0 ? 1 : 0);
}

/// @param from  where it came from: tells the side
Beside beside_sheet(const SheetView& sheet, Vec3d from, Vec3d p) noexcept {
  Beside b = beside_surface(sheet.surface, p);
  if (!b.there()) return b;
  const Vec3d flat = (p - b.point) - dot(p - b.point, b.normal) * b.normal;
  if (dot(flat, flat) > 1e-6) return {};  // past its border
  take_side(sheet, from, b);
  return b;
}

Beside beside_element(const StrandBody& body, const tissue::StrandState& s, int e, double share, Vec3d p) noexcept {
  const std::size_t n = std::size_t(e);
  const Vec3d axis = s.x[n] + share * (s.x[n + 1] - s.x[n]), from = p - axis;
  const double far = length(from), radius = body.model.radius[n];
  if (!(far > 1e-7) || far > radius + kReach) return {};
  const Vec3d normal = from / far;
  return {far - radius, axis + radius * normal, normal, s.v[n] + share * (s.v[n + 1] - s.v[n]), e + (share > 0.5)};
}

Beside beside_strand(const StrandBody& body, const tissue::StrandState& s, Vec3d p) noexcept {
  Beside best;
  for (int e = 0; e + 1 < body.nodes(); ++e) {
    const std::size_t n = std::size_t(e);
    if (s.alive[n] == 0) continue;
    const Vec3d along = s.x[n + 1] - s.x[n];
    const double share = std::clamp(dot(p - s.x[n], along) / dot(along, along), 0.0, 1.0);
    const Beside b = beside_element(body, s, e, share, p);
    if (b.there() && b.off < best.off) best = b;
  }
  return best;
}

struct Scene {
  const WetBodies& b;
  int sheets, strands;  // the first body of that kind
  explicit Scene(const WetBodies& bodies) noexcept
      : b(bodies), sheets(int(bodies.surfaces.size())), strands(sheets + int(bodies.sheets.size())) {}

  Beside beside(int body, Vec3d from, Vec3d p) const noexcept {
    if (body < sheets) return beside_surface(b.surfaces[std::size_t(body)], p);
    if (body < strands) return beside_sheet(b.sheets[std::size_t(body - sheets)], from, p);
    const std::size_t k = std::size_t(body - strands);
    return beside_strand(b.strands[k], b.states[k], p);
  }
  const Surface& surface(int body) const noexcept {
    return body < sheets ? b.surfaces[std::size_t(body)] : b.sheets[std::size_t(body - sheets)].surface;
  }
  Contact contact(int body, const Beside& at) const noexcept {
    return {vec_cast<float>(at.point), vec_cast<float>(at.normal), vec_cast<float>(at.velocity), body,
            b.first[std::size_t(body)] + at.film};
  }
  int body_of(std::int32_t place) const noexcept {
    if (place < 0 || place >= b.first.back()) return -1;
    return int(std::upper_bound(b.first.begin(), b.first.end(), place) - b.first.begin()) - 1;
  }
};

/// The first body that a drop of this radius meets on its way. A jet out of a vessel begins within the tissue that
/// carries the vessel, and leaves it.
Contact meet(const Scene& scene, Vec3d from, Vec3d to, Vec3d velocity, double radius) noexcept {
  const Vec3d way = to - from;
  const int looks = 1 + std::min(int(length(way) / kStride), 15);
  for (int k = 1; k <= looks; ++k) {
    const Vec3d p = from + (double(k) / looks) * way;
    int found = -1;
    Beside most;
    for (int body = 0; body < scene.b.count(); ++body) {
      const Beside b = scene.beside(body, from, p);
      if (!b.there() || b.off > 0.5 * radius || b.off < -kDeepest || b.off > most.off) continue;
      if (dot(velocity - b.velocity, b.normal) > kParts) continue;
      most = b;
      found = body;
    }
    if (found >= 0) return scene.contact(found, most);
  }
  return {};
}

/// Where the surface is that a drop runs on, looked for from where it was.
Beside follow(const Scene& scene, int body, std::int32_t film, Vec3d p) noexcept {
  if (body >= scene.strands) return scene.beside(body, p, p);
  const Surface& surface = scene.surface(body);
  const bool sheet = body >= scene.sheets;
  const int start = sheet ? film / 2 : film;
  Beside b = beside_vertex(surface, walk_to_nearest(surface, start, p), p);
  if (sheet) take_side(scene.b.sheets[std::size_t(body - scene.sheets)], p, b);
  return b;
}

/// What a running drop is on now: its body, or another one that it has run into.
Contact stay(const Scene& scene, const fluids::DropletState& s, int drop, Vec3d p) noexcept {
  const int body = s.body[std::size_t(drop)];
  const std::int32_t film = s.ground[std::size_t(drop)].film;
  if (body >= scene.b.count() || film < 0) return {};
  const double radius = double(s.radius[std::size_t(drop)]);
  int found = -1;
  Beside best;
  const Beside own = follow(scene, body, film - scene.b.first[std::size_t(body)], p);
  if (own.there() && length(p - own.point) < kLeaves + radius) best = own, found = body;
  for (int other = 0; other < scene.b.count(); ++other) {
    if (other == body) continue;
    const Beside b = scene.beside(other, p, p);
    if (!b.there() || b.off > 0.25 * radius || b.off < -kDeepest || b.off > best.off) continue;
    best = b;
    found = other;
  }
  return found < 0 ? Contact{} : scene.contact(found, best);
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

WetPlace wet_place(const WetBodies& bodies, Vec3d down, std::int32_t place) noexcept {
  const Scene scene(bodies);
  const int body = scene.body_of(place);
  if (body < 0) return {};
  const int number = place - bodies.first[std::size_t(body)];
  if (body >= scene.strands) {
    const std::size_t k = std::size_t(body - scene.strands), node = std::size_t(number);
    const double radius = bodies.strands[k].model.radius[std::min(node, std::size_t(bodies.strands[k].nodes() - 2))];
    return {bodies.states[k].x[node] + radius * down, down, bodies.states[k].v[node], body};
  }
  const Surface& surface = scene.surface(body);
  const bool sheet = body >= scene.sheets;
  const int v = sheet ? number / 2 : number;
  WetPlace out{surface.position(v), surface.normal(v), velocity_of(surface, v), body};
  if (!sheet) return out;
  if (number % 2 == 1) out.normal = -out.normal;
  out.point += bodies.sheets[std::size_t(body - scene.sheets)].half_thickness * out.normal;
  return out;
}

bool covered(const WetBodies& bodies, Vec3d p, double reach) noexcept {
  const Scene scene(bodies);
  for (int body = 0; body < bodies.count(); ++body) {
    const Beside b = scene.beside(body, p, p);
    if (!b.there() || b.off > reach || b.off < -kDeepest) continue;
    const Vec3d off = p - b.point, flat = off - dot(off, b.normal) * b.normal;
    if (dot(flat, flat) < reach * reach) return true;  // not past its border
  }
  return false;
}

void answer_drops(const WetBodies& bodies, Vec3d down, const fluids::DropletState& s, fluids::DropletWork& w) noexcept {
  const Scene scene(bodies);
  for (int k = 0; k < w.questions; ++k) {
    const std::size_t i = std::size_t(w.asking[std::size_t(k)]);
    const Vec3d now = place_of(s.x, s.y, s.z, i);
    w.answers[std::size_t(k)] = s.body[i] < 0 ? meet(scene, now, place_of(w.to_x, w.to_y, w.to_z, i),
                                                     place_of(s.vx, s.vy, s.vz, i), double(s.radius[i]))
                                              : stay(scene, s, int(i), now);
  }
  for (int k = 0; k < w.film_questions; ++k) {
    const std::int32_t place = w.overfull[std::size_t(k)];
    const WetPlace at = wet_place(bodies, down, place);
    w.film_answers[std::size_t(k)] = {vec_cast<float>(at.point), vec_cast<float>(at.normal),
                                      vec_cast<float>(at.velocity), at.body, place};
  }
}

}  // namespace trocar::interactions
