#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/curves/frames.hpp>
#include <trocar/geometry/nurbs/curve_edit.hpp>
#include <trocar/geometry/nurbs/surface_edit.hpp>
#include <trocar/geometry/nurbs_shapes/curve_makers.hpp>
#include <trocar/geometry/nurbs_shapes/skin.hpp>
#include <trocar/geometry/nurbs_shapes/tube.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::geometry::nurbs {
namespace {

struct Station {
  double u = 0.0, radius = 0.0, inside = 0.0;  // inside: the radius of what is hollow
  Vec3d point;
  Frame frame;
};

// Slopes between neighbours such that the cubic between two values stays between them.  [Fritsch & Butland 1984]
double monotone_slope(double before, double after) {
  return before * after > 0.0 ? 2.0 * before * after / (before + after) : 0.0;
}

// Radius at a place of a span, from those at the spans' ends.
class Radii {
 public:
  Radii(std::vector<double> ends, std::vector<double> values, bool closed)
      : m_ends(std::move(ends)), m_values(std::move(values)) {
    const std::size_t n = m_ends.size();
    if (m_values.size() == 1) m_values.resize(n, m_values[0]);
    if (closed && m_values.size() == n - 1) m_values.push_back(m_values[0]);
    if (m_values.size() != n)
      throw std::invalid_argument(
          tr("tube: one radius, or one at each of {} knots expected, got {}", closed ? n - 1 : n, m_values.size()));
    for (std::size_t i = 0; i < n; ++i)
      if (!(m_values[i] > 0.0) || !std::isfinite(m_values[i]))
        throw std::invalid_argument(tr("tube: radius {} above 0 expected, got {}", i, m_values[i]));
    for (std::size_t i = 0; i < n; ++i) {
      const bool inside = i > 0 && i + 1 < n;
      if (inside)
        m_slopes.push_back(monotone_slope(rise(i - 1), rise(i)));
      else if (closed)
        m_slopes.push_back(monotone_slope(rise(n - 2), rise(0)));
      else
        m_slopes.push_back(i == 0 ? rise(0) : rise(n - 2));
    }
  }
  double at(std::size_t span, double u) const {
    const double h = m_ends[span + 1] - m_ends[span], t = (u - m_ends[span]) / h, s = 1.0 - t;
    return s * s * (1.0 + 2.0 * t) * m_values[span] + t * t * (1.0 + 2.0 * s) * m_values[span + 1] +
           h * t * s * (s * m_slopes[span] - t * m_slopes[span + 1]);
  }

 private:
  double rise(std::size_t span) const {
    return (m_values[span + 1] - m_values[span]) / (m_ends[span + 1] - m_ends[span]);
  }
  std::vector<double> m_ends, m_values, m_slopes;
};

Station station_at(const Curve& spine, const Radii& radii, std::size_t span, double u) {
  Station station{u, radii.at(span, u), 0.0, point(spine, u), {}};
  station.frame.tangent = tangent(spine, u);
  if (station.frame.tangent == Vec3d{})
    throw std::invalid_argument(tr("tube: the spine has no direction at parameter {}", u));
  return station;
}

// The last station's frame carried once around a closed spine differs from the first by an angle; every station turns
// back by its share.
void untwist(const Curve& spine, std::vector<Station>& stations) {
  const Frame back =
      transported(stations.back().frame, stations.back().point, stations[0].point, stations[0].frame.tangent);
  const double angle =
      portable::atan2(dot(back.normal, stations[0].frame.binormal), dot(back.normal, stations[0].frame.normal));
  for (Station& s : stations) {
    const double a = -angle * (s.u - spine.knots.start()) / spine.knots.extent();
    const Vec3d n = s.frame.normal, b = s.frame.binormal;
    s.frame.normal = portable::cos(a) * n + portable::sin(a) * b;
    s.frame.binormal = portable::cos(a) * b - portable::sin(a) * n;
  }
}

std::vector<Station> stations_along(const Curve& spine, const std::vector<double>& radii, const TubeOptions& options) {
  require_valid(spine, "tube");
  if (options.stations < 1) throw std::invalid_argument("tube: at least one station to a span expected");
  const std::vector<double> ends = breaks(spine.knots);
  const Radii radius(ends, radii, spine.knots.periodic);
  std::vector<Station> stations;
  for (std::size_t s = 0; s + 1 < ends.size(); ++s)
    for (int k = 0; k < options.stations; ++k)
      stations.push_back(station_at(spine, radius, s, ends[s] + (ends[s + 1] - ends[s]) * k / options.stations));
  if (!spine.knots.periodic) stations.push_back(station_at(spine, radius, ends.size() - 2, ends.back()));
  stations[0].frame = frame_about(stations[0].frame.tangent, options.up);
  for (std::size_t i = 1; i < stations.size(); ++i)
    stations[i].frame =
        transported(stations[i - 1].frame, stations[i - 1].point, stations[i].point, stations[i].frame.tangent);
  if (spine.knots.periodic) untwist(spine, stations);
  return stations;
}

// Which span of the spine a station stands in: the last one at the spine's end.
std::size_t span_of_station(std::size_t station, std::size_t stations, const TubeOptions& options) {
  const auto to_a_span = static_cast<std::size_t>(options.stations);
  return std::min(station / to_a_span, (stations - 2) / to_a_span);
}

Surface wall_through(const Curve& spine, const std::vector<Station>& stations, double Station::*radius_of) {
  std::vector<Curve> sections;
  SkinOptions options;
  options.closed = spine.knots.periodic;
  for (const Station& s : stations) {
    const double radius = s.*radius_of;
    if (!(radius > 0.0)) throw std::invalid_argument("hollow_tube: a thickness below every radius expected");
    sections.push_back(ellipse(s.point, radius * s.frame.normal, radius * s.frame.binormal));
    options.parameters.push_back((s.u - spine.knots.start()) / spine.knots.extent());
  }
  return skinned(sections, options);
}

// Rows from one ring of weighted points to another, straight, as a surface along v.
Surface between(const Knots& around, const std::vector<Vec4d>& from, const std::vector<Vec4d>& to) {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < from.size(); ++i) rows.push_back({clamped_uniform(1, 2), {from[i], to[i]}});
  return surface_of(rows, Along::v, around);
}

std::vector<Vec4d> end_ring(const Surface& s, bool end) {
  std::vector<Vec4d> ring;
  for (int i = 0; i < s.u.points(); ++i) {
    const int index = s.index(i, end ? s.v.points() - 1 : 0);
    ring.push_back(weighted(s.points[index], s.weight(index)));
  }
  return ring;
}

// The middle of the rim, its mean radius, and the direction out of the wall there.
struct Rim {
  Vec3d middle, out;
  double radius = 0.0;
};
Rim rim_of(const Surface& wall, bool end) {
  constexpr int kAround = 64;
  const double v = end ? wall.v.end() : wall.v.start();
  Rim rim;
  std::vector<Vec3d> points;
  for (int k = 0; k < kAround; ++k) {
    const double u = wall.u.start() + wall.u.extent() * k / kAround;
    points.push_back(point(wall, u, v));
    rim.middle += points.back() / double(kAround);
  }
  for (int k = 0; k < kAround; ++k) {
    const Vec3d a = points[k] - rim.middle, b = points[(k + 1) % kAround] - rim.middle;
    rim.radius += length(a) / kAround;
    rim.out += (end ? 0.5 : -0.5) * cross(a, b);
  }
  rim.out = normalised(rim.out, Vec3d{});
  if (!(rim.radius > 0.0) || rim.out == Vec3d{})
    throw std::invalid_argument("capped: an end that is a ring with a middle expected");
  return rim;
}

// The lid as a surface of its own, from the rim to its pole, its extent in v as long as that of the wall for its way.
Surface lid(const Surface& wall, bool end, CapShape shape) {
  const Rim rim = rim_of(wall, end);
  const std::vector<Vec4d> ring = end_ring(wall, end);
  std::vector<Vec4d> pole;
  std::vector<Row> rows;
  constexpr double kCorner = 0.70710678118654752440;
  for (const Vec4d& p : ring) {
    const Vec3d top = rim.middle + (shape == CapShape::round ? rim.radius : 0.0) * rim.out;
    pole.push_back(weighted(top, p.w));
    rows.push_back(
        {clamped_uniform(2, 3), {p, weighted(p.place() + rim.radius * rim.out, kCorner * p.w), pole.back()}});
  }
  if (shape == CapShape::flat) return between(wall.u, ring, pole);
  return surface_of(rows, Along::v, wall.u);
}

double wall_length(const Surface& wall) {
  double sum = 0.0;
  for (int j = 1; j < wall.v.points(); ++j)
    for (int i = 0; i < wall.u.points(); ++i)
      sum += length(wall.points[wall.index(i, j)] - wall.points[wall.index(i, j - 1)]) / wall.u.points();
  return sum;
}

}  // namespace

Surface tube(const Curve& spine, const std::vector<double>& radii, const TubeOptions& options) {
  return wall_through(spine, stations_along(spine, radii, options), &Station::radius);
}

Surface capped(const Surface& wall, CapShape start, CapShape end) {
  require_valid(wall, "capped");
  if (!wall.u.periodic || wall.v.periodic)
    throw std::invalid_argument("capped: a surface that is closed in u and open in v expected");
  const double pace = wall.v.extent() / wall_length(wall);
  Surface result = wall;
  if (end != CapShape::none) {
    const Surface top = lid(wall, true, end);
    result = joined(result, on_domain(top, Along::v, 0.0, pace * wall_length(top)), Along::v);
  }
  if (start != CapShape::none) {
    const Surface bottom = reversed(lid(wall, false, start), Along::v);
    result = joined(on_domain(bottom, Along::v, 0.0, pace * wall_length(bottom)), result, Along::v);
  }
  return on_domain(result, Along::v, 0.0, 1.0);
}

Surface hollow_tube(const Curve& spine, const std::vector<double>& radii, const std::vector<double>& thickness,
                    const TubeOptions& options) {
  require_valid(spine, "hollow_tube");
  if (spine.knots.periodic) throw std::invalid_argument("hollow_tube: an open spine expected");
  for (const double t : thickness)
    if (!(t > 0.0)) throw std::invalid_argument("hollow_tube: a thickness above 0 expected");
  std::vector<Station> stations = stations_along(spine, radii, options);
  const Radii walls(breaks(spine.knots), thickness, false);
  for (std::size_t i = 0; i < stations.size(); ++i)
    stations[i].inside = stations[i].radius - walls.at(span_of_station(i, stations.size(), options), stations[i].u);
  const Surface outer = wall_through(spine, stations, &Station::radius);
  const Surface inner = reversed(wall_through(spine, stations, &Station::inside), Along::v);
  const double pace = outer.v.extent() / wall_length(outer);
  const auto rim = [&](const Surface& from, const Surface& to, const Station& at) {
    return on_domain(between(outer.u, end_ring(from, true), end_ring(to, false)), Along::v, 0.0,
                     pace * (at.radius - at.inside));
  };
  const Surface top = rim(outer, inner, stations.back()), bottom = rim(inner, outer, stations.front());
  const Surface around = joined(joined(joined(outer, top, Along::v), inner, Along::v), bottom, Along::v);
  return on_domain(around, Along::v, 0.0, 1.0);
}

}  // namespace trocar::geometry::nurbs
