#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/nurbs_fit/laplace.hpp>
#include <trocar/geometry/nurbs_fit/square_map.hpp>
#include <trocar/geometry/repair/rims.hpp>
#include <trocar/numerics/symmetric3.hpp>

namespace trocar::geometry::nurbs {
namespace {

// The only rim, counter-clockwise seen from where the triangles face.
std::vector<int> rim_of_sheet(const TriMesh& mesh) {
  const EdgeReport edges = check_edges(mesh);
  if (edges.inconsistent > 0)
    throw std::invalid_argument("map_to_square: triangles that share an edge are turned against each other");
  std::vector<Rim> all = rims_of(mesh, EdgeTable(mesh));
  if (all.size() != 1)
    throw std::invalid_argument(tr("map_to_square: a mesh with one rim expected, got {}", all.size()));
  const int euler = static_cast<int>(mesh.positions.size()) - edges.edges + static_cast<int>(mesh.triangles.size());
  if (euler != 1 || edges.crowded > 0)
    throw std::invalid_argument("map_to_square: a mesh in one piece and without handles expected");
  std::vector<int>& rim = all[0].vertices;  // its lowest vertex comes last
  std::rotate(rim.begin(), std::min_element(rim.begin(), rim.end()) + 1, rim.end());
  return rim;
}

// Places in the rim of the corners (0, 0), (1, 0), (1, 1), (0, 1).
std::array<std::size_t, 4> corners_of(const TriMesh& mesh, const std::vector<int>& rim) {
  std::vector<Vec3d> points;
  for (int v : rim) points.push_back(mesh.positions[v]);
  Vec3d middle, up;
  const numerics::Principal axes = numerics::principal(numerics::covariance(points, middle));
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) up += area_vector(mesh, t);
  const Vec3d x = axes.axis[0], y = dot(axes.axis[2], up) < 0.0 ? -axes.axis[1] : axes.axis[1];
  const double wide = std::sqrt(std::max(axes.value[0], 1e-300)), high = std::sqrt(std::max(axes.value[1], 1e-300));
  std::array<std::size_t, 4> corners{};
  const double side[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (int k = 0; k < 4; ++k) {
    const auto out = [&](std::size_t i) {
      const Vec3d d = points[i] - middle;
      return side[k][0] * dot(d, x) / wide + side[k][1] * dot(d, y) / high;
    };
    for (std::size_t i = 1; i < points.size(); ++i)
      if (out(i) > out(corners[k])) corners[k] = i;
  }
  return corners;
}

// Corners that come one after the other around; else quarters of the way, from the first on.
void put_in_order(std::array<std::size_t, 4>& corners, const std::vector<double>& way) {
  const std::size_t n = way.size() - 1;
  std::size_t last = 0;
  bool ordered = true;
  for (int k = 1; k < 4; ++k) {
    const std::size_t after = (corners[k] + n - corners[0]) % n;
    ordered = ordered && after > last;
    last = after;
  }
  if (ordered) return;
  for (int k = 1; k < 4; ++k) {
    std::size_t steps = 1;
    const auto gone = [&](std::size_t s) {
      const std::size_t i = corners[0] + s;
      return i <= n ? way[i] - way[corners[0]] : way[n] - way[corners[0]] + way[i - n];
    };
    while (gone(steps) < 0.25 * k * way[n] && steps + 1 < n) ++steps;
    corners[k] = (corners[0] + steps) % n;
  }
}

}  // namespace

SquareMap map_to_square(const TriMesh& mesh) {
  const std::vector<int> rim = rim_of_sheet(mesh);
  const std::size_t n = rim.size();
  if (n < 4) throw std::invalid_argument("map_to_square: a rim of at least 4 vertices expected");
  std::vector<double> way{0.0};
  for (std::size_t i = 0; i < n; ++i)
    way.push_back(way.back() + length(mesh.positions[rim[(i + 1) % n]] - mesh.positions[rim[i]]));
  std::array<std::size_t, 4> corners = corners_of(mesh, rim);
  put_in_order(corners, way);

  std::vector<double> u(mesh.positions.size(), 0.0), v = u;
  std::vector<std::uint8_t> held(u.size(), 0);
  double edge[4];
  const double at[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
  for (int k = 0; k < 4; ++k) {
    const std::size_t from = corners[k], steps = (corners[(k + 1) % 4] + n - from) % n;
    std::vector<double> gone{0.0};
    for (std::size_t s = 0; s < steps; ++s) gone.push_back(gone.back() + way[(from + s) % n + 1] - way[(from + s) % n]);
    edge[k] = gone.back();
    for (std::size_t s = 0; s < steps; ++s) {
      const int vertex = rim[(from + s) % n];
      const double t = gone[s] / gone.back();
      u[vertex] = at[k][0] + t * (at[k + 1][0] - at[k][0]);
      v[vertex] = at[k][1] + t * (at[k + 1][1] - at[k][1]);
      held[vertex] = 1;
    }
  }
  const EdgeWeights weights = cotangent_weights(mesh);
  relax(weights, held, u);
  relax(weights, held, v);
  SquareMap map{{}, 0.5 * (edge[0] + edge[2]), 0.5 * (edge[1] + edge[3])};
  for (std::size_t i = 0; i < u.size(); ++i) map.parameters.push_back({u[i], v[i]});
  return map;
}

}  // namespace trocar::geometry::nurbs
