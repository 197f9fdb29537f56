#include <algorithm>
#include <cmath>

#include <trocar/geometry/nurbs_fit/samples.hpp>

namespace trocar::geometry::nurbs {
namespace {

constexpr int kMostPieces = 32;  // to which a triangle's edges are cut

// Parameters of a triangle's corners such that they may be averaged.
std::array<std::array<double, 2>, 3> corner_parameters(const std::array<int, 3>& t,
                                                       const std::vector<std::array<double, 2>>& parameters, bool wraps,
                                                       const std::vector<int>& poles) {
  std::array<std::array<double, 2>, 3> uv{parameters[t[0]], parameters[t[1]], parameters[t[2]]};
  const auto is_pole = [&poles, &t](int k) { return std::find(poles.begin(), poles.end(), t[k]) != poles.end(); };
  const int first = is_pole(0) ? 1 : 0;
  double sum = 0.0;
  int count = 0;
  for (int k = 0; k < 3; ++k) {
    if (is_pole(k)) continue;
    if (wraps) uv[k][0] -= std::floor(uv[k][0] - uv[first][0] + 0.5);
    sum += uv[k][0], ++count;
  }
  for (int k = 0; k < 3; ++k)
    if (is_pole(k) && count > 0) uv[k][0] = sum / count;
  return uv;
}

}  // namespace

Samples samples_of(const TriMesh& mesh, const std::vector<std::array<double, 2>>& parameters, double spacing,
                   bool wraps, const std::vector<int>& poles) {
  Samples s;
  s.points = mesh.positions, s.parameters = parameters;
  s.shares.assign(mesh.positions.size(), 0.0);
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const auto& corners = mesh.triangles[t];
    const Vec3d a = mesh.positions[corners[0]], x = mesh.positions[corners[1]] - a, y = mesh.positions[corners[2]] - a;
    const double size = 0.5 * length(area_vector(mesh, t));
    for (int v : corners) s.shares[v] += size / 12.0;
    const double longest = std::max({length(x), length(y), length(x - y)});
    const int pieces = std::clamp(static_cast<int>(std::ceil(longest / spacing)), 1, kMostPieces);
    const auto uv = corner_parameters(corners, parameters, wraps, poles);
    const auto add = [&](double p, double q) {  // the point a + p x + q y
      s.points.push_back(a + p * x + q * y);
      s.shares.push_back(0.75 * size / (pieces * pieces));
      std::array<double, 2> at{};
      for (int k = 0; k < 2; ++k) at[k] = (1.0 - p - q) * uv[0][k] + p * uv[1][k] + q * uv[2][k];
      if (wraps) at[0] -= std::floor(at[0]);
      s.parameters.push_back(at);
    };
    const double third = 1.0 / (3.0 * pieces);
    for (int j = 0; j < pieces; ++j)
      for (int i = 0; i + j < pieces; ++i) {
        add((3 * i + 1) * third, (3 * j + 1) * third);
        if (i + j + 1 < pieces) add((3 * i + 2) * third, (3 * j + 2) * third);
      }
  }
  double whole = 0.0;
  for (double share : s.shares) whole += share;
  if (whole > 0.0)
    for (double& share : s.shares) share /= whole;
  return s;
}

}  // namespace trocar::geometry::nurbs
