#include <algorithm>
#include <type_traits>

#include <trocar/geometry/nurbs/grid.hpp>

namespace trocar::geometry::nurbs {
namespace {

// du x dv, in units of the domain, is not trusted below this share of the derivatives' squares; normal() is asked
// instead.
constexpr double kFlat = 1e-10;

Vec3d top_of(Vec4d a) noexcept { return {a.x, a.y, a.z}; }

struct PointAndSlopes {
  Vec3d point, du, dv;
};
PointAndSlopes quotient(Vec3d a, Vec3d au, Vec3d av) noexcept { return {a, au, av}; }
PointAndSlopes quotient(Vec4d a, Vec4d au, Vec4d av) noexcept {
  const double s = 1.0 / a.w;
  const Vec3d p = s * top_of(a);
  return {p, s * (top_of(au) - au.w * p), s * (top_of(av) - av.w * p)};
}

}  // namespace

GridEvaluator::GridEvaluator(const Surface& surface, std::span<const double> us, std::span<const double> vs)
    : m_surface(surface) {
  require_valid(surface, "GridEvaluator");
  m_u = columns(surface.u, us), m_v = columns(surface.v, vs);
  const auto n = static_cast<std::size_t>(surface.u.points());
  if (surface.weights.empty())
    m_value.resize(n), m_slope.resize(n);
  else
    m_weighted.resize(n), m_weighted_slope.resize(n);
}

std::vector<GridEvaluator::Column> GridEvaluator::columns(const Knots& knots, std::span<const double> parameters) {
  std::vector<Column> result;
  for (double t : parameters) {
    const Basis2 basis = basis_at(knots, t, 1);
    Column column;
    column.parameter = into_domain(knots, t);
    for (int k = 0; k <= knots.degree; ++k) column.point[k] = knots.point_of(basis.first + k);
    column.value = basis.value[0], column.slope = basis.value[1];
    result.push_back(column);
  }
  return result;
}

template <class Sum>
void GridEvaluator::sum_along_v(std::span<const Vec3d> points, const Column& v, Sum* value, Sum* slope) const noexcept {
  const int nu = m_surface.u.points();
  for (int i = 0; i < nu; ++i) value[i] = slope[i] = Sum{};
  for (int l = 0; l <= m_surface.v.degree; ++l) {
    const std::size_t first = static_cast<std::size_t>(nu) * v.point[l];
    for (int i = 0; i < nu; ++i) {
      Sum p;
      if constexpr (std::is_same_v<Sum, Vec3d>)
        p = points[first + i];
      else
        p = weighted(points[first + i], m_surface.weights[first + i]);
      value[i] = value[i] + v.value[l] * p;
      slope[i] = slope[i] + v.slope[l] * p;
    }
  }
}

template <class Sum>
void GridEvaluator::evaluate_rows(std::span<const Vec3d> points, std::span<Vec3d> positions, std::span<Vec3d> normals,
                                  std::vector<Sum>& value, std::vector<Sum>& slope) noexcept {
  const int degree = m_surface.u.degree;
  const double stretch = m_surface.u.extent() / m_surface.v.extent();
  bool fresh = false;  // whether m_surface has these points already
  std::size_t target = 0;
  for (const Column& v : m_v) {
    sum_along_v(points, v, value.data(), slope.data());
    for (const Column& u : m_u) {
      Sum a{}, au{}, av{};
      for (int k = 0; k <= degree; ++k) {
        a = a + u.value[k] * value[u.point[k]];
        au = au + u.slope[k] * value[u.point[k]];
        av = av + u.value[k] * slope[u.point[k]];
      }
      const PointAndSlopes at = quotient(a, au, av);
      positions[target] = at.point;
      if (!normals.empty()) {
        const Vec3d n = cross(at.du, at.dv);
        const double size2 = dot(n, n), least = kFlat * (stretch * dot(at.du, at.du) + dot(at.dv, at.dv) / stretch);
        if (size2 > least * least) {
          normals[target] = n / std::sqrt(size2);
        } else {
          if (!fresh) std::copy(points.begin(), points.end(), m_surface.points.begin());
          fresh = true;
          normals[target] = normal(m_surface, u.parameter, v.parameter);
        }
      }
      ++target;
    }
  }
}

void GridEvaluator::evaluate(std::span<const Vec3d> points, std::span<Vec3d> positions,
                             std::span<Vec3d> normals) noexcept {
  if (m_surface.weights.empty())
    evaluate_rows(points, positions, normals, m_value, m_slope);
  else
    evaluate_rows(points, positions, normals, m_weighted, m_weighted_slope);
}

}  // namespace trocar::geometry::nurbs
