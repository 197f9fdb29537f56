#include <algorithm>
#include <cmath>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/contact/nearest_skin.hpp>
#include <trocar/interactions/verbs/electrode_contact.hpp>

namespace trocar::interactions {
namespace {

constexpr double kSearch = 0.009;  // [m] sparks, the wire's radius, and the way to a vertex of a skin's triangle
constexpr double kFirmly = 0.3;    // [N] a wire pressed with this is in contact all round.  Our choice
constexpr double kLightly = 0.3;   // share of the contact when it only just touches.        Our choice
constexpr double kFirmPinch = 5;   // [N] the same of jaws' pads.                             Our choice

Vec3d rest_of(const tissue::Skin& skin, const std::array<int, 3>& corner, Vec3d weights) noexcept {
  Vec3d p;
  for (std::size_t k = 0; k < 3; ++k) p += weights[int(k)] * vec_cast<double>(skin.rest[std::size_t(corner[k])]);
  return p;
}

Vec3d rest_normal(const tissue::Skin& skin, const std::array<int, 3>& corner, Vec3d weights) noexcept {
  Vec3d n;
  for (std::size_t k = 0; k < 3; ++k) n += weights[int(k)] * vec_cast<double>(skin.rest_normal[std::size_t(corner[k])]);
  return normalised(n, vec_cast<double>(skin.rest_normal[std::size_t(corner[0])]));
}

int nearest_corner(const std::array<int, 3>& corner, Vec3d weights) noexcept {
  std::size_t most = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (weights[int(k)] > weights[int(most)]) most = k;
  return corner[most];
}

/// Places along the bare metal to look from: the foot is all bare.
struct BarePlaces {
  Vec3d at[5];
  int count = 0;
};
BarePlaces bare_places(const ToolShape& s) noexcept {
  BarePlaces r;
  const Vec3d end = s.has_foot ? s.part[kJawA].b : s.frame.tip;
  for (const double back : {0.0, 0.5 * kBareWire, kBareWire}) r.at[r.count++] = end - back * s.frame.axis();
  if (!s.has_foot) return r;
  const Capsule& foot = s.part[kJawB];
  for (const double share : {0.5, 1.0}) r.at[r.count++] = foot.a + share * (foot.b - foot.a);
  return r;
}

/// Looks at bodies one after the other and keeps the nearest.
class WireSearch {
 public:
  WireSearch(const Bodies& bodies, const ToolShape& shape, Vec3d from) noexcept
      : m_bodies(bodies), m_shape(shape), m_from(from) {}

  ElectrodeTouch best;

  void organ(const Surface& surface, BodyId body) noexcept {
    if (!surface.pose->bounds.reaches(m_from, kSearch)) return;
    const int vertex = nearest_vertex_near(surface, m_from, kSearch);
    if (vertex < 0 || surface.torn(vertex)) return;
    const SkinPoint p = nearest_skin_point(surface, vertex, m_from);
    const bool inside = dot(m_from - p.point, p.normal) < 0;
    if (!take(body, p.point, inside)) return;
    keep(rest_of(*surface.skin, p.vertex, p.weights), p.normal);
    best.inwards = -1.0 * rest_normal(*surface.skin, p.vertex, p.weights);
    best.point = on_vertex(m_bodies, body.index(), nearest_corner(p.vertex, p.weights));
  }

  void sheet(const SheetView& view, BodyId body) noexcept {
    const Surface& surface = view.surface;
    if (!surface.pose->bounds.reaches(m_from, kSearch)) return;
    const int vertex = nearest_vertex_near(surface, m_from, kSearch);
    if (vertex < 0) return;
    const tissue::Skin& skin = *surface.skin;
    for (int k = skin.face_first[std::size_t(vertex)]; k < skin.face_first[std::size_t(vertex) + 1]; ++k) {
      const int face = skin.face[std::size_t(k)];
      if (view.parted[std::size_t(face)]) continue;
      const auto& t = skin.triangles[std::size_t(face)];
      const auto on =
          geometry::closest_on_triangle(m_from, surface.position(t[0]), surface.position(t[1]), surface.position(t[2]));
      const Vec3d off = m_from - on.point;
      const double apart = length(off), half = view.half_thickness;
      const Vec3d up = normalised(off, surface.normal(vertex));
      if (!take(body, on.point + std::min(half, apart) * up, apart < half)) continue;
      keep(rest_of(skin, t, on.weights), up);
      const double side = dot(up, surface.normal(vertex)) < 0 ? 1 : -1;
      best.inwards = side * rest_normal(skin, t, on.weights);
      best.point = at_node(m_bodies, body, nearest_corner(t, on.weights));
    }
  }

  void strand(const StrandBody& body, const tissue::StrandState& state, BodyId number) noexcept {
    int element = -1;
    double w = 0;
    for (int e = 0; e + 1 < body.nodes(); ++e) {
      if (!state.alive[std::size_t(e)]) continue;
      const Vec3d a = state.x[std::size_t(e)], b = state.x[std::size_t(e) + 1];
      const double radius = body.model.radius[std::size_t(e)], share = geometry::closest_on_segment(m_from, a, b);
      const Vec3d axis = a + share * (b - a), off = m_from - axis;
      const double apart = length(off);
      if (apart > radius + kSearch) continue;
      const Vec3d up = normalised(off, any_perpendicular(normalised(b - a, {1, 0, 0})));
      if (!take(number, axis + std::min(radius, apart) * up, apart < radius)) continue;
      element = e, w = share;
      keep({0, std::min(radius, apart), 0}, up);
    }
    if (element >= 0) on_strand(body, state, at_element(m_bodies, number.index(), element, w, {}));
  }

 private:
  bool take(BodyId body, Vec3d place, bool inside) noexcept {
    const double apart = off_wire(m_shape, place);
    const double gap = inside || apart <= kTouches ? 0.0 : apart;
    const double away = length(m_from - place);
    if (best.contact.body.exists() && (gap > best.contact.gap || (gap == best.contact.gap && away >= m_away)))
      return false;
    m_away = away;
    best.contact.body = body;
    best.contact.gap = gap;
    best.place = place;
    return true;
  }
  void keep(Vec3d rest, Vec3d normal) noexcept {
    best.contact.a = best.contact.b = rest;
    best.normal = normal;
  }
  void on_strand(const StrandBody& body, const tissue::StrandState& state, const MaterialPoint& point) noexcept {
    const StrandPlace at = place_on_rod(point);
    const StrandFrame frame = frame_at(body, state, at);
    const double out = best.contact.a.y, y = dot(best.normal, frame.normal), z = dot(best.normal, frame.binormal);
    best.point = point;
    keep({arc_at(body, at), out * y, out * z}, best.normal);
    best.inwards = normalised(Vec3d{0, -y, -z}, Vec3d{0, -1, 0});
  }

  const Bodies& m_bodies;
  const ToolShape& m_shape;
  Vec3d m_from;
  double m_away = 0;
};

ElectrodeTouch wire_touch(const ToolShape& shape, const ToolState& tool, const Bodies& bodies) noexcept {
  ElectrodeTouch best;
  const BarePlaces bare = bare_places(shape);
  for (int k = 0; k < bare.count; ++k) {
    WireSearch search(bodies, shape, bare.at[k]);
    for (std::size_t i = 0; i < bodies.organ_count(); ++i) search.organ(bodies.organ(i), BodyId::organ(i));
    for (std::size_t i = 0; i < bodies.strand_count(); ++i)
      search.strand(bodies.strand(i), bodies.strand_state(i), BodyId::strand(i));
    for (std::size_t i = 0; i < bodies.membrane_count(); ++i) search.sheet(bodies.membrane(i), BodyId::membrane(i));
    const tissue::ElectrodeContact& c = search.best.contact;
    if (c.body.exists() && (!best.contact.body.exists() || c.gap < best.contact.gap)) best = search.best;
  }
  const double force = length(Vec3d{tool.contact_force[0], tool.contact_force[1], tool.contact_force[2]});
  best.contact.pressed = kLightly + (1 - kLightly) * std::min(force / kFirmly, 1.0);
  return best;
}

ElectrodeTouch pads_touch(const ToolShape& shape, const ToolState& tool, const Bodies& bodies) noexcept {
  ElectrodeTouch out;
  if (tool.holds == 0) return out;
  out.contact.body = tool.hold[0].at.body;
  out.point = tool.hold[0].at;
  Vec3d sum[2];
  int count[2] = {0, 0};
  for (int i = 0; i < tool.holds; ++i) {
    const Hold& hold = tool.hold[i];
    if (hold.at.body != out.contact.body) continue;
    const std::size_t side = hold.local[0] > 0 ? 0 : 1;
    sum[side] += drawn_point(bodies, hold.at);
    ++count[side];
    out.place += held_point(bodies, hold.at);
  }
  out.place = out.place / double(count[0] + count[1]);
  out.normal = shape.frame.opening();
  const std::size_t one = count[0] > 0 ? 0 : 1, other = count[1] > 0 ? 1 : 0;
  out.contact.a = sum[one] / double(count[one]);
  out.contact.b = sum[other] / double(count[other]);
  out.contact.pressed = std::clamp(tool.pinch / kFirmPinch, 0.0, 1.0);
  if (!out.contact.body.is(BodyKind::strand)) return out;
  const std::size_t strand = out.contact.body.index();
  const StrandPlace at = place_on_rod(tool.hold[0].at);
  const StrandFrame frame = frame_at(bodies.strand(strand), bodies.strand_state(strand), at);
  const double radius = bodies.strand(strand).model.radius[std::size_t(at.element)];
  const double s = 0.5 * (out.contact.a.x + out.contact.b.x), y = dot(out.normal, frame.normal),
               z = dot(out.normal, frame.binormal);
  out.contact.a = {s, radius * y, radius * z};
  out.contact.b = {s, -radius * y, -radius * z};
  return out;
}

}  // namespace

double off_wire(const ToolShape& s, Vec3d place) noexcept {
  const Capsule &a = s.part[kJawA], &b = s.part[kJawB];
  const auto off = [place](const Capsule& rod) {
    return length(place - collision::nearest_on_axis(rod, place)) - rod.radius;
  };
  return s.has_foot ? std::min(off(a), off(b)) : off({s.pivot, s.frame.tip, a.radius + b.radius});
}

ElectrodeTouch electrode_touch(const ToolModel& model, const ToolShape& shape, const ToolState& tool,
                               const Bodies& bodies) noexcept {
  return model.electrode.current.bipolar ? pads_touch(shape, tool, bodies) : wire_touch(shape, tool, bodies);
}

}  // namespace trocar::interactions
