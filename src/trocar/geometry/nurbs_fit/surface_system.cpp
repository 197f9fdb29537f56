#include <algorithm>
#include <stdexcept>

#include <trocar/geometry/nurbs/basis.hpp>
#include <trocar/geometry/nurbs_fit/surface_system.hpp>
#include <trocar/numerics/banded.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::geometry::nurbs {
namespace {

// Gauss's quadrature with three points on 0 .. 1: enough for squares of second derivatives of cubics.
constexpr double kGauss3[3] = {0.1127016653792583, 0.5, 0.8872983346207417};
constexpr double kShare3[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};

}  // namespace

Unknowns free_unknowns(const Knots& u, const Knots& v) {
  Unknowns result{u, v, {}, u.points() * v.points()};
  for (int i = 0; i < result.count; ++i) result.of_point.push_back({{i, 1.0}});
  return result;
}

Unknowns sphere_unknowns(const Knots& u, const Knots& v) {
  const int nu = u.points(), nv = v.points();
  if (!u.periodic || v.periodic || nv < 5)
    throw std::invalid_argument("sphere_unknowns: u periodic and v clamped with at least 5 rows expected");
  Unknowns result{u, v, {}, 6 + nu * (nv - 4)};
  // A pole, the two half-axes of the ellipse around it; rows; the same at the other end.
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i) {
      const bool north = j >= nv - 2;
      const int pole = north ? result.count - 3 : 0;
      const double angle = portable::two_pi * i / nu;
      if (j == 0 || j == nv - 1)
        result.of_point.push_back({{pole, 1.0}});
      else if (j == 1 || north)
        result.of_point.push_back({{pole, 1.0}, {pole + 1, portable::cos(angle)}, {pole + 2, portable::sin(angle)}});
      else
        result.of_point.push_back({{3 + i + nu * (j - 2), 1.0}});
    }
  return result;
}

SurfaceSystem::SurfaceSystem(const Unknowns& unknowns) : m_unknowns(unknowns) {
  // Functions that live together: degree + 1 rows of control points, all around.
  const int reach = (unknowns.v.degree + 1) * unknowns.u.points() + 2;
  m_half = std::min(unknowns.count - 1, reach);
  m_a.assign(numerics::band_size(unknowns.count, m_half), 0.0);
  m_b.assign(3 * static_cast<std::size_t>(unknowns.count), 0.0);
}

void SurfaceSystem::row_at(double u, double v, int k, int l, std::vector<Entry>& row) const {
  const Basis2 bu = basis_at(m_unknowns.u, u), bv = basis_at(m_unknowns.v, v);
  row.clear();
  for (int b = 0; b <= m_unknowns.v.degree; ++b)
    for (int a = 0; a <= m_unknowns.u.degree; ++a) {
      const double share = bu.value[k][a] * bv.value[l][b];
      const int point =
          m_unknowns.u.point_of(bu.first + a) + m_unknowns.u.points() * m_unknowns.v.point_of(bv.first + b);
      for (const Unknowns::Part& part : m_unknowns.of_point[point]) {
        const auto same =
            std::find_if(row.begin(), row.end(), [&](const Entry& e) { return e.unknown == part.unknown; });
        if (same == row.end())
          row.push_back({part.unknown, share * part.factor});
        else
          same->value += share * part.factor;
      }
    }
}

void SurfaceSystem::add_row(const std::vector<Entry>& row, Vec3d x, double share) {
  for (const Entry& p : row) {
    for (const Entry& q : row)
      if (q.unknown <= p.unknown) m_a[numerics::band_at(m_half, p.unknown, q.unknown)] += share * p.value * q.value;
    for (int k = 0; k < 3; ++k) m_b[3 * static_cast<std::size_t>(p.unknown) + k] += share * p.value * x[k];
  }
}

void SurfaceSystem::add_point(double u, double v, Vec3d x, double share) {
  row_at(u, v, 0, 0, m_row);
  add_row(m_row, x, share);
}

void SurfaceSystem::add_bending(double smoothing, double way_u, double way_v) {
  const double fourth = smoothing * smoothing * smoothing * smoothing;
  const double eu = m_unknowns.u.extent(), ev = m_unknowns.v.extent();
  const double by_u = eu / way_u, by_v = ev / way_v;  // parameter per way
  const std::vector<double> us = breaks(m_unknowns.u), vs = breaks(m_unknowns.v);
  for (std::size_t j = 0; j + 1 < vs.size(); ++j)
    for (std::size_t i = 0; i + 1 < us.size(); ++i)
      for (int b = 0; b < 3; ++b)
        for (int a = 0; a < 3; ++a) {
          const double u = us[i] + kGauss3[a] * (us[i + 1] - us[i]), v = vs[j] + kGauss3[b] * (vs[j + 1] - vs[j]);
          const double part = kShare3[a] * kShare3[b] * (us[i + 1] - us[i]) / eu * (vs[j + 1] - vs[j]) / ev;
          const auto add = [&](int k, int l, double scale) {
            row_at(u, v, k, l, m_row);
            add_row(m_row, {}, fourth * part * scale);
          };
          add(2, 0, by_u * by_u * by_u * by_u);
          add(1, 1, 2.0 * by_u * by_u * by_v * by_v);
          add(0, 2, by_v * by_v * by_v * by_v);
        }
}

Surface SurfaceSystem::solve() {
  const int n = m_unknowns.count;
  if (numerics::band_factor(n, m_half, m_a.data()) >= 0)
    throw std::runtime_error("SurfaceSystem: points and smoothing do not determine the surface");
  numerics::band_solve(n, m_half, m_a.data(), m_b.data(), 3);
  Surface s{m_unknowns.u, m_unknowns.v, {}, {}};
  for (const auto& parts : m_unknowns.of_point) {
    Vec3d p;
    for (const Unknowns::Part& part : parts) {
      const double* x = &m_b[3 * static_cast<std::size_t>(part.unknown)];
      p += part.factor * Vec3d{x[0], x[1], x[2]};
    }
    s.points.push_back(p);
  }
  return s;
}

}  // namespace trocar::geometry::nurbs
