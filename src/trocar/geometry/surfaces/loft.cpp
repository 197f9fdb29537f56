#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <trocar/geometry/surfaces/loft.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::geometry {
namespace {

constexpr int kCapRings = 4;  // steps of a quarter turn's angle from the pole to the end section

double power(double base, double exponent) { return base > 0.0 ? portable::exp(exponent * portable::log(base)) : 0.0; }

// A row of outline points, one per step around.
using Ring = std::vector<Vec3d>;

Ring ring_of(const Section& section, int around) {
  Ring ring;
  for (int i = 0; i < around; ++i) ring.push_back(outline(section, double(i) / around));
  return ring;
}

// The end section shrunk towards its pole as an ellipsoid does: angle 0 at the section, a quarter turn at the pole.
Ring cap_ring(const Section& end, Vec3d outwards, double depth, double angle, int around) {
  Section shrunk = end;
  const double scale = portable::cos(angle);
  shrunk.centre += (depth * portable::sin(angle)) * outwards;
  shrunk.across *= scale;
  shrunk.deep *= scale;
  return ring_of(shrunk, around);
}

Vec3d plane_normal(const Section& s, Vec3d towards) {
  const Vec3d n = normalised(cross(s.across, s.deep), Vec3d{});
  if (n == Vec3d{}) throw std::invalid_argument("loft: a section's half-axes are parallel or zero");
  return dot(n, towards) < 0.0 ? -n : n;
}

struct Rows {
  std::vector<Ring> rings;  // from pole to pole
  Ring start_slope, end_slope;
};

// Parameters along: the mean way between neighbouring rings, 0 .. 1.
std::vector<double> along_parameters(const std::vector<Ring>& rings) {
  std::vector<double> v(rings.size(), 0.0);
  for (std::size_t k = 1; k < rings.size(); ++k) {
    double way = 0.0;
    for (std::size_t i = 0; i < rings[k].size(); ++i) way += length(rings[k][i] - rings[k - 1][i]);
    v[k] = v[k - 1] + way / double(rings[k].size());
  }
  for (double& value : v) value /= v.back();
  return v;
}

// Slopes that leave the pole in its plane, towards each outline point, at the speed of the first step along: dv of
// parameter per quarter turn's share of angle.
std::vector<Vec3d> pole_slopes(const Section& end, double dv, int around, double sign) {
  std::vector<Vec3d> slopes;
  const double angle = 0.5 * portable::pi / kCapRings;
  for (const Vec3d& p : ring_of(end, around)) slopes.push_back((sign * angle / dv) * (p - end.centre));
  return slopes;
}

}  // namespace

Vec3d outline(const Section& section, double turn) {
  const double c = portable::cos(2.0 * portable::pi * turn), s = portable::sin(2.0 * portable::pi * turn);
  double r = 1.0;
  if (section.squareness != 2.0) {
    const double n = section.squareness;
    r = power(power(std::fabs(c), n) + power(std::fabs(s), n), -1.0 / n);
  }
  return section.centre + (r * c) * section.across + (r * s) * section.deep;
}

NurbsSurface loft(std::span<const Section> sections, const LoftOptions& options) {
  if (sections.size() < 2) throw std::invalid_argument("loft: at least 2 sections expected");
  if (options.around < 8) throw std::invalid_argument("loft: at least 8 points around expected");
  const int around = options.around;
  const Section& first = sections.front();
  const Section& last = sections.back();
  const auto cap_depth = [](const Section& s, double share) {
    return share * std::min(length(s.across), length(s.deep));
  };
  const Vec3d first_out = plane_normal(first, first.centre - sections[1].centre);
  const Vec3d last_out = plane_normal(last, last.centre - sections[sections.size() - 2].centre);
  const auto angle = [](int step) { return 0.5 * portable::pi * step / kCapRings; };

  std::vector<Ring> rings;
  for (int k = kCapRings; k > 0; --k)
    rings.push_back(cap_ring(first, first_out, cap_depth(first, options.first_cap), angle(k), around));
  for (const Section& section : sections) rings.push_back(ring_of(section, around));
  for (int k = 1; k <= kCapRings; ++k)
    rings.push_back(cap_ring(last, last_out, cap_depth(last, options.last_cap), angle(k), around));
  // The poles exactly: cos of a quarter turn is not exactly 0.
  rings.front().assign(around, first.centre + cap_depth(first, options.first_cap) * first_out);
  rings.back().assign(around, last.centre + cap_depth(last, options.last_cap) * last_out);

  const std::vector<double> v = along_parameters(rings);
  const auto start_slopes = pole_slopes(first, v[1] - v[0], around, 1.0);
  const auto end_slopes = pole_slopes(last, v[v.size() - 1] - v[v.size() - 2], around, -1.0);

  // Along first: one curve per point of the outline; then around: through each row of their control points.
  std::vector<NurbsCurve> meridians;
  for (int i = 0; i < around; ++i) {
    std::vector<Vec3d> points;
    for (const Ring& ring : rings) points.push_back(ring[i]);
    meridians.push_back(interpolated(points, v, {start_slopes[i], end_slopes[i]}));
  }
  std::vector<double> u(around);
  for (int i = 0; i < around; ++i) u[i] = double(i) / around;

  NurbsSurface surface;
  surface.periodic_u = true;
  surface.knots_v = meridians[0].knots;
  surface.count_v = static_cast<int>(meridians[0].control.size());
  for (int j = 0; j < surface.count_v; ++j) {
    Ring row;
    for (const NurbsCurve& meridian : meridians) row.push_back(meridian.control[j]);
    const NurbsCurve curve = interpolated_closed(row, u, 1.0);
    surface.knots_u = curve.knots;
    surface.count_u = static_cast<int>(curve.control.size());
    surface.control.insert(surface.control.end(), curve.control.begin(), curve.control.end());
  }
  return surface;
}

}  // namespace trocar::geometry
