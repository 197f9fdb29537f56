#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/curves/frames.hpp>
#include <trocar/geometry/nurbs/closure.hpp>
#include <trocar/geometry/nurbs/curve_edit.hpp>
#include <trocar/geometry/nurbs/curve_length.hpp>
#include <trocar/geometry/nurbs/mesh.hpp>
#include <trocar/geometry/nurbs/surface_edit.hpp>
#include <trocar/geometry/nurbs_shapes/curve_makers.hpp>
#include <trocar/geometry/nurbs_shapes/interpolate.hpp>
#include <trocar/geometry/nurbs_shapes/surface_makers.hpp>
#include <trocar/geometry/nurbs_shapes/tube.hpp>
#include <trocar/scene/description/body_shape.hpp>

namespace trocar::scene {

namespace nurbs = geometry::nurbs;

namespace {

using Doubles = std::vector<double>;

void require_count(const char* what, std::size_t expected, std::size_t got) {
  if (expected != got) throw std::invalid_argument(fmt::format("{} {}, {} expected", got, what, expected));
}

void require_few(const char* what, std::size_t got) {
  if (got > kMostCurvePoints)
    throw std::invalid_argument(tr("{} {}, at most {} expected", got, what, kMostCurvePoints));
}

/// Closed around, `points` control points.
nurbs::Knots turn_knots(const char* name, int degree, int points, const Doubles& knots) {
  if (points <= degree)
    throw std::invalid_argument(
        tr("{} control points around, at least {} expected for the degree {}", points, degree + 1, degree));
  if (knots.empty()) return nurbs::periodic_uniform(degree, points);
  require_count(name, std::size_t(points) + 1, knots.size());
  if (!(knots.back() > knots.front())) throw std::invalid_argument(tr("{} that do not ascend", name));
  return nurbs::periodic(degree, {knots.begin(), knots.end() - 1}, knots.back() - knots.front());
}

nurbs::Surface closed_outwards(nurbs::Surface surface, const char* who) {
  nurbs::require_valid(surface, who);
  nurbs::require_closed(surface, who);
  surface = nurbs::on_domain(nurbs::on_domain(surface, nurbs::Along::u, 0, 1), nurbs::Along::v, 0, 1);
  return nurbs::outwards(surface);
}

/// The tube's line with knots at its stations, so that radii are given at its knots.
nurbs::Curve with_stations(const TubeShape& tube) {
  nurbs::Curve line = line_of(tube);
  constexpr double kApart = 1e-6;  // of the domain
  for (const TubeShape::Station& s : tube.stations) {
    const double u = nurbs::parameter_after(line, s.s);
    const Doubles ends = nurbs::breaks(line.knots);
    const bool there = std::any_of(ends.begin(), ends.end(), [&](double e) { return std::fabs(e - u) < kApart; });
    if (!there) line = nurbs::inserted(line, u);
  }
  return line;
}

/// Sections to a span of the line: two radii apart at most, as what bends and widens between them is a cubic.
int sections_to_a_span(const nurbs::Curve& line, const Doubles& ends, const Doubles& radii) {
  double most = 1;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    most = std::max(most, nurbs::length(line, ends[i], ends[i + 1]) / (radii[i] + radii[i + 1]));
  constexpr int kMostSections = 800;  // each of them is a row of a dense system
  return std::clamp(int(std::ceil(most)), 2, std::clamp(kMostSections / int(ends.size()), 2, 8));
}

}  // namespace

nurbs::Knots clamped_by(int degree, int points, const std::vector<double>& knots, const char* name) {
  if (points <= degree)
    throw std::invalid_argument(
        tr("{} control points, at least {} expected for the degree {}", points, degree + 1, degree));
  if (knots.empty()) return nurbs::clamped_uniform(degree, points);
  require_count(name, std::size_t(points - degree) + 1, knots.size());
  const nurbs::Knots all = nurbs::clamped(degree, knots.front(), {knots.begin() + 1, knots.end() - 1}, knots.back());
  nurbs::require_valid(all, name);
  return nurbs::on_domain(all, 0, 1);
}

bool TubeShape::hollow() const {
  return std::any_of(stations.begin(), stations.end(), [](const Station& s) { return s.wall > 0; });
}

nurbs::Curve line_of(const TubeShape& shape) { return nurbs::curve_through(shape.line); }

TubeShape::Station station_at(const TubeShape& shape, double s) {
  const std::vector<TubeShape::Station>& all = shape.stations;
  if (s <= all.front().s) return {s, all.front().radius, all.front().wall};
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (s > all[i].s) continue;
    const double f = (s - all[i - 1].s) / std::max(all[i].s - all[i - 1].s, 1e-12);
    return {s, all[i - 1].radius + f * (all[i].radius - all[i - 1].radius),
            all[i - 1].wall + f * (all[i].wall - all[i - 1].wall)};
  }
  return {s, all.back().radius, all.back().wall};
}

nurbs::Surface surface_of(const NurbsShape& shape) {
  nurbs::Surface s;
  const bool ring = shape.closing == NurbsShape::ring;
  s.u = turn_knots("knots_u", shape.degree[0], shape.columns, shape.knots_u);
  s.v = ring ? turn_knots("knots_v", shape.degree[1], shape.rows, shape.knots_v)
             : clamped_by(shape.degree[1], shape.rows, shape.knots_v, "knots_v");
  require_count("control points", std::size_t(shape.rows) * std::size_t(shape.columns), shape.net.size());
  if (!shape.weights.empty()) require_count("weights", shape.net.size(), shape.weights.size());
  s.points = shape.net;
  s.weights = shape.weights;
  return closed_outwards(std::move(s), "nurbs");
}

nurbs::Surface surface_of(const TubeShape& shape) {
  if (shape.stations.empty()) throw std::invalid_argument("at least one station expected");
  require_few("points of its line", shape.line.size()), require_few("stations", shape.stations.size());
  const nurbs::Curve line = with_stations(shape);
  const Doubles ends = nurbs::breaks(line.knots);
  Doubles radii, walls;
  for (const double u : ends) {
    const TubeShape::Station at = station_at(shape, nurbs::length(line, line.knots.start(), u));
    radii.push_back(at.radius), walls.push_back(at.wall);
  }
  const nurbs::TubeOptions options{sections_to_a_span(line, ends, radii), {0, 0, 1}};
  if (shape.hollow()) return closed_outwards(nurbs::hollow_tube(line, radii, walls, options), "tube");
  const nurbs::CapShape cap = shape.ends == TubeShape::flat ? nurbs::CapShape::flat : nurbs::CapShape::round;
  return closed_outwards(nurbs::capped(nurbs::tube(line, radii, options), cap, cap), "tube");
}

nurbs::Surface surface_of(const RevolvedShape& shape) {
  const Vec3d z = normalised(shape.axis, Vec3d{});
  if (z == Vec3d{}) throw std::invalid_argument("an axis expected, got none");
  require_few("points of its profile", shape.profile.size());
  if (shape.profile.size() < 2) throw std::invalid_argument("a profile of at least 2 points expected");
  const Vec3d x = geometry::frame_about(z, std::fabs(z.x) < 0.8 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0}).normal;
  std::vector<Vec3d> points;
  for (const RevolvedShape::ProfilePoint& p : shape.profile) points.push_back(shape.from + p.r * x + p.z * z);
  const double first = shape.profile.front().r, last = shape.profile.back().r;
  const bool ring = shape.profile.front() == shape.profile.back() && first > 0;
  if (ring && shape.smooth) {
    points.pop_back();
    return closed_outwards(nurbs::revolved(nurbs::closed_curve_through(points), shape.from, z), "revolved");
  }
  double way = 0;
  for (std::size_t i = 1; i < points.size(); ++i) way += length(points[i] - points[i - 1]);
  nurbs::Slopes slopes;  // round at the poles
  if (first == 0) slopes.start = way * x;
  if (last == 0) slopes.end = -way * x;
  const nurbs::Curve profile =
      shape.smooth ? nurbs::curve_through(points, 3, nurbs::Spacing::chord, slopes) : nurbs::polyline(points);
  nurbs::Surface s = nurbs::revolved(profile, shape.from, z);
  const auto lid = [&](double r) { return r > 0 && !ring ? nurbs::CapShape::flat : nurbs::CapShape::none; };
  if (lid(first) != nurbs::CapShape::none || lid(last) != nurbs::CapShape::none)
    s = nurbs::capped(s, lid(first), lid(last));
  return closed_outwards(std::move(s), "revolved");
}

std::optional<nurbs::Surface> spline_of(const ClosedShape& shape) {
  if (shape.nurbs) return surface_of(*shape.nurbs);
  if (shape.tube) return surface_of(*shape.tube);
  if (shape.revolved) return surface_of(*shape.revolved);
  return {};
}

NurbsShape shape_of(const nurbs::Surface& surface) {
  const nurbs::Closure closure = nurbs::closure_of(surface);
  if (!surface.u.periodic || !closure.closed())
    throw std::invalid_argument("shape_of: a closed surface that is periodic in u expected");
  NurbsShape shape;
  shape.columns = surface.u.points(), shape.rows = surface.v.points();
  shape.net = surface.points;
  shape.weights = surface.weights;
  shape.degree = {surface.u.degree, surface.v.degree};
  shape.closing = surface.v.periodic ? NurbsShape::ring : NurbsShape::ends;
  const auto domain = [](const nurbs::Knots& knots) {
    Doubles values(knots.values.begin() + knots.degree, knots.values.begin() + knots.functions() + 1);
    return values;
  };
  shape.knots_u = domain(surface.u);
  shape.knots_v = domain(surface.v);
  return shape;
}

ShapeSize size_of(const ClosedShape& shape) try {
  ShapeSize size;
  geometry::TriMesh mesh;
  if (shape.surface) {
    mesh = shape.surface->mesh;
  } else if (const std::optional<nurbs::Surface> spline = spline_of(shape)) {
    const auto steps = [](const nurbs::Knots& knots) {
      constexpr int kSamples = 32;  // around and along: one per cent of a circle's area
      return std::clamp(kSamples / int(nurbs::breaks(knots).size()), 2, kSamples / 2);
    };
    mesh = nurbs::tessellate(*spline, nurbs::Steps{steps(spline->u), steps(spline->v)}).mesh;
  }
  if (mesh.triangles.empty()) return size;
  size.volume = std::fabs(geometry::volume(mesh));
  size.area = geometry::area(mesh);
  size.box = geometry::bounds(mesh.positions);
  return size;
} catch (const std::invalid_argument&) {
  return {};
}

}  // namespace trocar::scene
