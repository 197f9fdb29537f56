#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/geometry/nurbs/basis.hpp>
#include <trocar/geometry/nurbs/curve.hpp>
#include <trocar/geometry/nurbs/net.hpp>

namespace trocar::geometry::nurbs {
namespace {

// The d-th derivatives of w x, and of w.
Vec4d weighted_sum(const Curve& curve, int first, const BasisRow& basis) noexcept {
  Vec4d sum;
  for (int k = 0; k <= curve.knots.degree; ++k) {
    const int i = curve.knots.point_of(first + k);
    sum = sum + basis[k] * weighted(curve.points[i], curve.weight(i));
  }
  return sum;
}

}  // namespace

std::string fault_in(const Curve& curve) {
  if (std::string fault = fault_in(curve.knots); !fault.empty()) return fault;
  return fault_in_net(curve.points, curve.weights, curve.knots.points());
}

void require_valid(const Curve& curve, const char* who) {
  if (const std::string fault = fault_in(curve); !fault.empty()) throw std::invalid_argument(who + (": " + fault));
}

Vec3d point(const Curve& curve, double u) noexcept {
  const Basis2 basis = basis_at(curve.knots, u, 0);
  return weighted_sum(curve, basis.first, basis.value[0]).place();
}

CurveJet jet(const Curve& curve, double u) noexcept {
  const double inside = into_domain(curve.knots, u);
  return jet_in_span(curve, span_of(curve.knots, inside), inside);
}

CurveJet jet_in_span(const Curve& curve, int span, double u) noexcept {
  BasisRow basis[3];
  basis_derivatives(curve.knots, span, u, 2, basis);
  Vec4d a[3];
  for (int d = 0; d < 3; ++d) a[d] = weighted_sum(curve, span - curve.knots.degree, basis[d]);
  const auto top = [&a](int d) { return Vec3d{a[d].x, a[d].y, a[d].z}; };
  CurveJet result;  // derivatives of the quotient  [PT97 eq.4.8]
  result.point = a[0].place();
  result.first = (top(1) - a[1].w * result.point) / a[0].w;
  result.second = (top(2) - 2.0 * a[1].w * result.first - a[2].w * result.point) / a[0].w;
  return result;
}

std::vector<Vec3d> derivatives(const Curve& curve, double u, int order) {
  const double inside = into_domain(curve.knots, u);
  const int span = span_of(curve.knots, inside);
  std::vector<BasisRow> basis(static_cast<std::size_t>(order + 1));
  basis_derivatives(curve.knots, span, inside, order, basis.data());
  std::vector<Vec4d> a;
  for (int d = 0; d <= order; ++d) a.push_back(weighted_sum(curve, span - curve.knots.degree, basis[d]));
  std::vector<Vec3d> result;
  for (int d = 0; d <= order; ++d) {
    Vec3d v{a[d].x, a[d].y, a[d].z};
    for (int i = 1; i <= d; ++i) v -= binomial(d, i) * a[i].w * result[d - i];
    result.push_back(v / a[0].w);
  }
  return result;
}

Vec3d tangent(const Curve& curve, double u) {
  double size = 0.0;
  for (const Vec3d& p : curve.points) size = std::max(size, length(p - curve.points[0]));
  const auto d = derivatives(curve, u, curve.knots.degree);
  // Behind the start the curve goes along its first derivative that is not 0; before its end, against it if it is even.
  const bool at_end = !curve.knots.periodic && !(u < curve.knots.end());
  double scale = size;
  for (std::size_t k = 1; k < d.size(); ++k) {
    scale /= curve.knots.extent();
    if (length(d[k]) > 1e-10 * scale) return (at_end && k % 2 == 0 ? -1.0 : 1.0) * normalised(d[k]);
  }
  return {};
}

Vec3d curvature(const Curve& curve, double u) noexcept {
  const CurveJet at = jet(curve, u);
  const double speed2 = dot(at.first, at.first);
  if (!(speed2 > 0.0)) return {};
  return (at.second - (dot(at.second, at.first) / speed2) * at.first) / speed2;
}

Row row_of(const Curve& curve) {
  Row row{curve.knots, {}};
  for (std::size_t i = 0; i < curve.points.size(); ++i)
    row.points.push_back(weighted(curve.points[i], curve.weight(static_cast<int>(i))));
  return row;
}

Curve curve_of(const Row& row) {
  Curve curve{row.knots, {}, {}};
  for (const Vec4d& p : row.points) {
    curve.points.push_back(p.place());
    curve.weights.push_back(p.w);
  }
  drop_plain_weights(curve.weights);
  return curve;
}

}  // namespace trocar::geometry::nurbs
