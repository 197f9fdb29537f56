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

void pose_vessel(const VesselPath& path, const Bodies& bodies, std::span<Vec3d> points) noexcept {
  for (std::size_t i = 0; i < path.points.size(); ++i)
    if (!path.points[i].rides.in_space()) points[i] = place_of(bodies, path.points[i].rides);
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    const VesselPoint& p = path.points[i];
    if (!p.rides.in_space()) continue;
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
