#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <trocar/geometry/nurbs/basis.hpp>
#include <trocar/geometry/nurbs/net.hpp>
#include <trocar/geometry/nurbs/row.hpp>
#include <trocar/geometry/nurbs/surface.hpp>

namespace trocar::geometry::nurbs {
namespace {

Vec3d top(Vec4d a) noexcept { return {a.x, a.y, a.z}; }

// Sum of products of two directions' functions (or derivatives) with the weighted control points.
Vec4d weighted_sum(const Surface& s, int first_u, const BasisRow& nu, int first_v, const BasisRow& nv) noexcept {
  Vec4d sum;
  for (int l = 0; l <= s.v.degree; ++l) {
    Vec4d row;
    for (int k = 0; k <= s.u.degree; ++k) {
      const int i = s.index(s.u.point_of(first_u + k), s.v.point_of(first_v + l));
      row = row + nu[k] * weighted(s.points[i], s.weight(i));
    }
    sum = sum + nv[l] * row;
  }
  return sum;
}

// Which way from u the domain continues.
double inwards(const Knots& knots, double u) noexcept { return !knots.periodic && !(u < knots.end()) ? -1.0 : 1.0; }

// du x dv in units of the domain, or, where that is nothing, how it begins to grow into the domain.
Vec3d normal_direction(const Surface& s, double u, double v) noexcept {
  constexpr double kNothing = 1e-10;  // of the square of the derivatives' size
  const SurfaceJet at = jet(s, u, v);
  const double a = s.u.extent(), b = s.v.extent();
  const Vec3d du = a * at.du, dv = b * at.dv;
  const double size = dot(du, du) + dot(dv, dv);
  const Vec3d n = cross(du, dv);
  if (length(n) > kNothing * size) return n;
  const Vec3d duu = a * a * at.duu, duv = a * b * at.duv, dvv = b * b * at.dvv;
  const Vec3d by_v = inwards(s.v, v) * (cross(duv, dv) + cross(du, dvv));
  const Vec3d by_u = inwards(s.u, u) * (cross(duu, dv) + cross(du, duv));
  const Vec3d grown = length(by_v) >= length(by_u) ? by_v : by_u;
  return length(grown) > kNothing * size ? grown : Vec3d{};
}

}  // namespace

std::string fault_in(const Surface& s) {
  if (const std::string fault = fault_in(s.u); !fault.empty()) return "in u: " + fault;
  if (const std::string fault = fault_in(s.v); !fault.empty()) return "in v: " + fault;
  return fault_in_net(s.points, s.weights, s.u.points() * s.v.points());
}

void require_valid(const Surface& surface, const char* who) {
  if (const std::string fault = fault_in(surface); !fault.empty()) throw std::invalid_argument(who + (": " + fault));
}

Vec3d point(const Surface& s, double u, double v) noexcept {
  const Basis2 bu = basis_at(s.u, u, 0), bv = basis_at(s.v, v, 0);
  return weighted_sum(s, bu.first, bu.value[0], bv.first, bv.value[0]).place();
}

SurfaceJet jet(const Surface& s, double u, double v) noexcept {
  const double in_u = into_domain(s.u, u), in_v = into_domain(s.v, v);
  return jet_in_spans(s, span_of(s.u, in_u), span_of(s.v, in_v), in_u, in_v);
}

SurfaceJet jet_in_spans(const Surface& s, int span_u, int span_v, double u, double v) noexcept {
  BasisRow nu[3], nv[3];
  basis_derivatives(s.u, span_u, u, 2, nu);
  basis_derivatives(s.v, span_v, v, 2, nv);
  const auto sum = [&](int k, int l) noexcept {
    return weighted_sum(s, span_u - s.u.degree, nu[k], span_v - s.v.degree, nv[l]);
  };
  const Vec4d a = sum(0, 0), au = sum(1, 0), av = sum(0, 1), auu = sum(2, 0), auv = sum(1, 1), avv = sum(0, 2);
  SurfaceJet at;  // derivatives of the quotient  [PT97 eq.4.20]
  at.point = a.place();
  at.du = (top(au) - au.w * at.point) / a.w;
  at.dv = (top(av) - av.w * at.point) / a.w;
  at.duu = (top(auu) - 2.0 * au.w * at.du - auu.w * at.point) / a.w;
  at.duv = (top(auv) - au.w * at.dv - av.w * at.du - auv.w * at.point) / a.w;
  at.dvv = (top(avv) - 2.0 * av.w * at.dv - avv.w * at.point) / a.w;
  return at;
}

std::vector<std::vector<Vec3d>> derivatives(const Surface& s, double u, double v, int order) {
  const double in_u = into_domain(s.u, u), in_v = into_domain(s.v, v);
  const int span_u = span_of(s.u, in_u), span_v = span_of(s.v, in_v);
  std::vector<BasisRow> nu(static_cast<std::size_t>(order + 1)), nv(nu.size());
  basis_derivatives(s.u, span_u, in_u, order, nu.data());
  basis_derivatives(s.v, span_v, in_v, order, nv.data());
  std::vector<std::vector<Vec4d>> a(nu.size());
  std::vector<std::vector<Vec3d>> d(nu.size());
  for (int k = 0; k <= order; ++k)
    for (int l = 0; l <= order - k; ++l)
      a[k].push_back(weighted_sum(s, span_u - s.u.degree, nu[k], span_v - s.v.degree, nv[l]));
  for (int k = 0; k <= order; ++k)
    for (int l = 0; l <= order - k; ++l) {
      Vec3d sum = top(a[k][l]);
      for (int i = 0; i <= k; ++i)
        for (int j = 0; j <= l; ++j)
          if (i + j > 0) sum -= binomial(k, i) * binomial(l, j) * a[i][j].w * d[k - i][l - j];
      d[k].push_back(sum / a[0][0].w);
    }
  return d;
}

Vec3d normal(const Surface& s, double u, double v) noexcept {
  constexpr double kBeside = 1e-4;  // of the domain
  u = into_domain(s.u, u), v = into_domain(s.v, v);
  const Vec3d n = normal_direction(s, u, v);
  if (!(n == Vec3d{})) return normalised(n);
  const double beside_u = u + inwards(s.u, u) * kBeside * s.u.extent();
  const double beside_v = v + inwards(s.v, v) * kBeside * s.v.extent();
  return normalised(normal_direction(s, beside_u, beside_v), Vec3d{});
}

Curvatures curvatures(const SurfaceJet& at) noexcept {
  const Vec3d n = cross(at.du, at.dv);
  const double e = dot(at.du, at.du), f = dot(at.du, at.dv), g = dot(at.dv, at.dv), area2 = dot(n, n);
  if (!(area2 > 0.0)) return {};
  const double size = std::sqrt(area2);
  const double l = dot(at.duu, n) / size, m = dot(at.duv, n) / size, k = dot(at.dvv, n) / size;
  return {(l * k - m * m) / area2, (e * k - 2.0 * f * m + g * l) / (2.0 * area2)};
}

}  // namespace trocar::geometry::nurbs
