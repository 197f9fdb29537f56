#include <algorithm>

#include <trocar/core/field_hash.hpp>
#include <trocar/interactions/couplings/vessel_path.hpp>

namespace trocar::interactions {
namespace {

/// Turns v as the smallest rotation from direction a to direction b does.
Vec3d turned(Vec3d v, Vec3d a, Vec3d b) noexcept {
  const Vec3d axis = cross(a, b);
  const double c = dot(a, b);
  if (c < -0.999) return v;
  return v * c + cross(axis, v) + axis * (dot(axis, v) / (1.0 + c));
}

Vec3d drawn_direction(const StrandBody& body, int e) noexcept {
  return normalised(body.model.rest[std::size_t(e) + 1] - body.model.rest[std::size_t(e)]);
}

/// Edge, across, normal of a triangle.
struct TriangleFrame {
  Vec3d edge, across, normal;
};
TriangleFrame frame_of(Vec3d a, Vec3d b, Vec3d c) noexcept {
  const Vec3d edge = normalised(b - a), normal = normalised(cross(b - a, c - a));
  return {edge, cross(normal, edge), normal};
}

/// Bodies as they are now, and vertices that have been worked out.
struct Carriers {
  const Bodies& bodies;
  VertexPlaces corners;
};

Vec3d corner(const VesselHold& hold, const Carriers& now, std::size_t k) noexcept {
  const std::size_t i = std::size_t(hold.index);
  if (hold.kind == VesselHold::membrane) return membrane_nodes(now.bodies, i).position(hold.vertex[k]);
  if (!now.corners.empty()) return now.corners[i][std::size_t(hold.vertex[k])];
  return skin_point(organ_nodes(now.bodies, i), now.bodies.models.skin(hold.index), hold.vertex[k]);
}

int heaviest(const VesselHold& hold) noexcept {
  int most = 0;
  for (int k = 1; k < 3; ++k)
    if (hold.share[std::size_t(k)] > hold.share[std::size_t(most)]) most = k;
  return most;
}

/// On a triangle. Where that has been cut open, its corners go different ways: the nearest one has the point.
Vec3d on_triangle(const VesselHold& hold, const Carriers& now) noexcept {
  if (hold.kind == VesselHold::membrane && now.bodies.states.torn[std::size_t(hold.index)][std::size_t(hold.element)])
    return corner(hold, now, std::size_t(heaviest(hold)));
  const Vec3d a = corner(hold, now, 0), b = corner(hold, now, 1), c = corner(hold, now, 2);
  const TriangleFrame f = frame_of(a, b, c);
  return hold.share[0] * a + hold.share[1] * b + hold.share[2] * c + hold.offset.x * f.edge + hold.offset.y * f.across +
         hold.offset.z * f.normal;
}

Vec3d in_cell(const VesselHold& hold, const Bodies& bodies) noexcept {
  const std::size_t organ = std::size_t(hold.index);
  const tissue::CuttableState& body = bodies.states.cuttables[organ - bodies.models.solids.size()];
  const geometry::Tet& cell = body.tets.cells[std::size_t(hold.element)];
  const tissue::NodeView nodes = organ_nodes(bodies, organ);
  Vec3d at;
  for (std::size_t k = 0; k < 4; ++k) at += hold.share[k] * nodes.position(cell[k]);
  return at;
}

Vec3d on_strand(const VesselHold& hold, const Bodies& bodies) noexcept {
  const std::size_t i = std::size_t(hold.index);
  const StrandBody& body = bodies.strand(i);
  const StrandPlace place{hold.element, hold.w};
  const Vec3d now = tangent_at(body, bodies.strand_state(i), place);
  return point_at(body, bodies.strand_state(i), place) + turned(hold.offset, drawn_direction(body, hold.element), now);
}

/// The last point that is not beyond s, but not the last of all.
int point_before(const VesselPath& path, double s) noexcept {
  const auto beyond = std::upper_bound(path.points.begin(), path.points.end(), s,
                                       [](double v, const VesselPoint& p) { return v < p.s; });
  return std::clamp(int(beyond - path.points.begin()) - 1, 0, int(path.points.size()) - 2);
}

/// A cut from here on counts as behind a point: the point is on its near side.
bool between(const VesselPath& path, int i, double s) noexcept {
  const double from = path.points[std::size_t(i)].s, to = path.points[std::size_t(i) + 1].s;
  return s >= from && (s < to || (s == to && to == 1));
}

/// From point i on along the line as it comes from before (side 0), or from point i + 1 back (side 1).
Vec3d straight_on(const VesselPath& path, std::span<const Vec3d> points, std::span<const double> cuts, int i, double s,
                  int side) noexcept {
  const int n = int(points.size()), base = side == 0 ? i : i + 1, back = side == 0 ? i - 1 : i + 2;
  const int interval = side == 0 ? i - 1 : i + 1;  // the one before, or after
  bool whole = back >= 0 && back < n;
  for (const double c : cuts) whole = whole && !between(path, interval, c);
  // Alone between two cuts, or at the line's end, it knows no direction but the drawn one.
  const Vec3d there = whole ? points[std::size_t(back)] : Vec3d{};
  const Vec3d drawn = path.points[std::size_t(base)].drawn - path.points[std::size_t(side == 0 ? i + 1 : i)].drawn;
  const Vec3d towards =
      whole ? normalised(points[std::size_t(base)] - there, normalised(drawn)) : -1.0 * normalised(drawn, {1, 0, 0});
  const double way = std::fabs(s - path.points[std::size_t(base)].s) * path.length;
  return points[std::size_t(base)] + way * towards;
}

}  // namespace

Vec3d held_point(const VesselHold& hold, const Bodies& bodies, VertexPlaces corners) noexcept {
  switch (hold.kind) {
    case VesselHold::strand:
      return on_strand(hold, bodies);
    case VesselHold::organ:
    case VesselHold::membrane:
      return on_triangle(hold, {bodies, corners});
    case VesselHold::cell:
      return in_cell(hold, bodies);
    case VesselHold::space:
      break;
  }
  return hold.offset;
}

void anchor_point(VesselHold& hold, Vec3d drawn, const Bodies& bodies) noexcept {
  hold.offset = {0, 0, 0};
  if (hold.kind == VesselHold::cell) return;
  const Vec3d away = drawn - held_point(hold, bodies);
  hold.offset = away;
  if (hold.kind != VesselHold::organ && hold.kind != VesselHold::membrane) return;
  const Carriers now{bodies, {}};
  const TriangleFrame f = frame_of(corner(hold, now, 0), corner(hold, now, 1), corner(hold, now, 2));
  hold.offset = {dot(away, f.edge), dot(away, f.across), dot(away, f.normal)};
}

void pose_vessel(const VesselPath& path, const Bodies& bodies, std::span<Vec3d> points, VertexPlaces corners) noexcept {
  for (std::size_t i = 0; i < path.points.size(); ++i)
    if (path.points[i].hold.kind != VesselHold::space) points[i] = held_point(path.points[i].hold, bodies, corners);
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    const VesselPoint& p = path.points[i];
    if (p.hold.kind != VesselHold::space) continue;
    points[i] = p.drawn;
    for (std::size_t k = 0; k < 2; ++k)
      if (p.near[k] >= 0)
        points[i] += p.share[k] * (points[std::size_t(p.near[k])] - path.points[std::size_t(p.near[k])].drawn);
  }
}

VesselSpot vessel_spot(const VesselPath& path, std::span<const Vec3d> points, std::span<const double> cuts, double s,
                       int side) noexcept {
  VesselSpot spot;
  spot.after = point_before(path, s);
  const std::size_t i = std::size_t(spot.after);
  int before = 0, beyond = 0;  // cuts of this interval that s lies behind, or before
  for (const double c : cuts) {
    if (!between(path, spot.after, c)) continue;
    const bool behind = s > c || (s == c && side == 1);
    (behind ? before : beyond) += 1;
  }
  const Vec3d a = points[i], b = points[i + 1];
  const double from = path.points[i].s, to = path.points[i + 1].s;
  if (before + beyond == 0) {
    spot.place = a + ((s - from) / (to - from)) * (b - a);
    spot.along = normalised(b - a);
    return spot;
  }
  const int on = before == 0 ? 0 : 1;
  spot.place = straight_on(path, points, cuts, spot.after, s, on);
  const Vec3d base = points[i + std::size_t(on)];
  const Vec3d drawn = path.points[i + 1].drawn - path.points[i].drawn;
  spot.along = normalised((on == 0 ? 1.0 : -1.0) * (spot.place - base), normalised(drawn));
  return spot;
}

Vec3d turn_at(const VesselPath& path, std::span<const Vec3d> points, int i) noexcept {
  const std::size_t k = std::size_t(i);
  const VesselPoint& p = path.points[k];
  return turned(p.turn, p.along, normalised(points[k + 1] - points[k - 1], p.along));
}

double vessel_radius(const VesselPath& path, double s) noexcept {
  const std::size_t i = std::size_t(point_before(path, s));
  const VesselPoint &a = path.points[i], &b = path.points[i + 1];
  return a.radius + (s - a.s) / (b.s - a.s) * (b.radius - a.radius);
}

StrandFrame vessel_frame(const VesselPath& path, const VesselSpot& spot) noexcept {
  const std::size_t i = std::size_t(spot.after);
  const Vec3d drawn = normalised(path.points[i + 1].drawn - path.points[i].drawn);
  const Vec3d n = turned(any_perpendicular(drawn), drawn, spot.along);
  const Vec3d normal = normalised(n - dot(n, spot.along) * spot.along, any_perpendicular(spot.along));
  return {spot.along, normal, cross(spot.along, normal)};
}

int pieces_of(const VesselPath& path, std::span<const Vec3d> points, std::span<const double> cuts, int i,
              VesselPiece (&out)[2]) noexcept {
  const std::size_t k = std::size_t(i);
  const double from = path.points[k].s, to = path.points[k + 1].s;
  double first = 2, last = -1;
  for (const double c : cuts) {
    if (!between(path, i, c)) continue;
    first = std::min(first, c);
    last = std::max(last, c);
  }
  if (last < 0) {
    out[0] = {points[k], points[k + 1], from, to, i};
    return 1;
  }
  out[0] = {points[k], straight_on(path, points, cuts, i, first, 0), from, first, i};
  out[1] = {straight_on(path, points, cuts, i, last, 1), points[k + 1], last, to, i};
  return 2;
}

void add_to_hash(core::Hasher& hasher, const VesselPath& path) noexcept { core::add_fields(hasher, path); }

}  // namespace trocar::interactions
