#include <algorithm>
#include <stdexcept>

#include <trocar/interactions/bodies/bodies.hpp>
#include <trocar/interactions/bodies/spread.hpp>

namespace trocar::interactions {
namespace {

/// Solves the 4x4 system a z = b by elimination with pivoting.
bool solve4(double (&a)[4][5], double (&z)[4]) {
  for (int c = 0; c < 4; ++c) {
    int pivot = c;
    for (int r = c + 1; r < 4; ++r)
      if (std::fabs(a[r][c]) > std::fabs(a[pivot][c])) pivot = r;
    if (std::fabs(a[pivot][c]) < 1e-12) return false;
    for (int k = 0; k < 5; ++k) std::swap(a[c][k], a[pivot][k]);
    for (int r = 0; r < 4; ++r) {
      if (r == c) continue;
      const double f = a[r][c] / a[c][c];
      for (int k = c; k < 5; ++k) a[r][k] -= f * a[c][k];
    }
  }
  for (int c = 0; c < 4; ++c) z[c] = a[c][4] / a[c][c];
  return true;
}

}  // namespace

MaterialPoint spread(BodyModels& models, std::size_t organ, std::span<const double> mass, Vec3d place, double radius) {
  const std::span<const Vec3d> rest = drawn_nodes(models, BodyId::organ(organ));
  LongRow row;
  std::vector<double> g;
  std::vector<Vec3d> d;
  for (int i = 0; i < int(mass.size()); ++i) {
    const Vec3d away = (rest[size_t(i)] - place) / radius;
    const double r2 = dot(away, away);
    if (r2 >= 1.0) continue;
    row.node.push_back(i);
    g.push_back(mass[size_t(i)] * (1 - r2) * (1 - r2));
    d.push_back(away);
  }
  if (row.node.size() < 4) throw std::invalid_argument("fewer than four nodes near the end");
  // w_i = g_i (z0 + z . d_i) with sum w = 1, sum w d = 0: moments of g give a 4x4 system.
  double total = 0;
  for (double gi : g) total += gi;
  double a[4][5] = {};
  for (size_t i = 0; i < g.size(); ++i) {
    const double basis[4] = {1, d[i].x, d[i].y, d[i].z};
    for (int r = 0; r < 4; ++r)
      for (int c = 0; c < 4; ++c) a[r][c] += g[i] / total * basis[r] * basis[c];
  }
  a[0][4] = 1;
  double z[4] = {1, 0, 0, 0};
  const bool exact = solve4(a, z);
  Vec3d mean{0, 0, 0};
  for (size_t i = 0; i < g.size(); ++i) {
    const double tilt = exact ? z[0] + z[1] * d[i].x + z[2] * d[i].y + z[3] * d[i].z : 1.0;
    row.weight.push_back(float(g[i] / total * tilt));
    mean += double(row.weight.back()) * rest[size_t(row.node[i])];
  }
  MaterialPoint point;
  point.body = BodyId::organ(organ);
  point.element = std::int32_t(models.rows.size());
  point.frame = MaterialPoint::long_row;
  const Vec3d off = place - mean;
  point.offset = {float(off.x), float(off.y), float(off.z)};
  models.rows.push_back(std::move(row));
  return point;
}

}  // namespace trocar::interactions
