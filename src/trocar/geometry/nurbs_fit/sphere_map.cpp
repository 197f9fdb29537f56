#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include <trocar/geometry/nurbs_fit/laplace.hpp>
#include <trocar/geometry/nurbs_fit/sphere_map.hpp>
#include <trocar/numerics/symmetric3.hpp>

namespace trocar::geometry::nurbs {
namespace {

constexpr int kBands = 256;  // of latitude, to measure how wide they are

// Edges that each vertex is away from one, -1 where there is no way.
std::vector<int> hops_from(const Csr& neighbours, int from) {
  std::vector<int> hops(static_cast<std::size_t>(neighbours.rows()), -1), queue{from};
  hops[from] = 0;
  for (std::size_t k = 0; k < queue.size(); ++k)
    for (int other : neighbours.row(queue[k]))
      if (hops[other] < 0) {
        hops[other] = hops[queue[k]] + 1;
        queue.push_back(other);
      }
  return hops;
}

// The way along edges to each vertex that can be reached.  [Dijkstra 1959]
std::vector<double> ways_from(const TriMesh& mesh, const Csr& neighbours, int from) {
  std::vector<double> way(mesh.positions.size(), -1.0);
  std::set<std::pair<double, int>> next{{0.0, from}};
  while (!next.empty()) {
    const auto [sofar, vertex] = *next.begin();
    next.erase(next.begin());
    if (way[vertex] >= 0.0) continue;
    way[vertex] = sofar;
    for (int other : neighbours.row(vertex))
      if (way[other] < 0.0) next.emplace(sofar + length(mesh.positions[other] - mesh.positions[vertex]), other);
  }
  return way;
}

void require_sphere(const TriMesh& mesh, const Csr& neighbours, std::array<int, 2> poles) {
  const EdgeReport edges = check_edges(mesh);
  if (!edges.closed()) throw std::invalid_argument("map_to_sphere: a closed mesh expected");
  const auto hops = hops_from(neighbours, poles[0]);
  if (std::find(hops.begin(), hops.end(), -1) != hops.end())
    throw std::invalid_argument("map_to_sphere: a mesh in one piece expected");
  if (static_cast<int>(mesh.positions.size()) - edges.edges + static_cast<int>(mesh.triangles.size()) != 2)
    throw std::invalid_argument("map_to_sphere: a mesh without handles expected");
  if (hops[poles[1]] < 2) throw std::invalid_argument("map_to_sphere: poles that are no neighbours expected");
}

// The shortest way by edges, so that no edge leads from one of its vertices to another but the next.
std::vector<int> date_line(const Csr& neighbours, int south, int north) {
  const std::vector<int> hops = hops_from(neighbours, north);
  std::vector<int> line{south};
  while (line.back() != north)
    for (int other : neighbours.row(line.back()))
      if (hops[other] == hops[line.back()] - 1) {
        line.push_back(other);
        break;
      }
  return line;
}

// The neighbours of `at` counter-clockwise from `next` to `last`, both left out: left of who comes from last.
std::vector<int> left_of(const TriMesh& mesh, const Csr& triangles, int at, int next, int last) {
  const auto after = [&](int corner) {
    for (int t : triangles.row(at)) {
      const auto& c = mesh.triangles[t];
      for (int k = 0; k < 3; ++k)
        if (c[k] == at && c[(k + 1) % 3] == corner) return c[(k + 2) % 3];
    }
    return last;
  };
  std::vector<int> left;
  for (int corner = after(next); corner != last && left.size() < triangles.row(at).size(); corner = after(corner))
    left.push_back(corner);
  return left;
}

std::vector<double> longitudes(const TriMesh& mesh, const EdgeWeights& weights, std::array<int, 2> poles) {
  const std::vector<int> line = date_line(weights.neighbours, poles[0], poles[1]);
  const Csr triangles = vertex_triangles(mesh);
  std::vector<double> step(weights.weight.size(), 0.0), u(mesh.positions.size(), 0.0);
  const auto see = [&](int from, int to, double turns) {
    for (int k = weights.neighbours.start[from]; k < weights.neighbours.start[from + 1]; ++k)
      if (weights.neighbours.items[k] == to) step[k] += turns;
  };
  // What lies west of the line has nearly a turn more.
  for (std::size_t i = 1; i + 1 < line.size(); ++i)
    for (int west : left_of(mesh, triangles, line[i], line[i + 1], line[i - 1])) {
      see(line[i], west, -1.0);
      see(west, line[i], 1.0);
    }
  // Poles take no part: nobody sees them.
  EdgeWeights apart = weights;
  for (int i = 0; i < apart.neighbours.rows(); ++i)
    for (int k = apart.neighbours.start[i]; k < apart.neighbours.start[i + 1]; ++k) {
      const int j = apart.neighbours.items[k];
      if (j == poles[0] || j == poles[1]) apart.weight[k] = 0.0, step[k] = 0.0;
    }
  std::vector<std::uint8_t> held(u.size(), 0);
  held[poles[0]] = held[poles[1]] = held[line[1]] = 1;
  relax(apart, held, u, step);
  for (double& value : u) value -= std::floor(value);
  u[poles[0]] = u[poles[1]] = 0.0;
  return u;
}

// Of a triangle's area the share where a linear function of these corner values, ascending, is below t.
double share_below(const std::array<double, 3>& f, double t) {
  if (t <= f[0]) return 0.0;
  if (t >= f[2]) return 1.0;
  if (t < f[1]) return (t - f[0]) * (t - f[0]) / ((f[1] - f[0]) * (f[2] - f[0]));
  return 1.0 - (f[2] - t) * (f[2] - t) / ((f[2] - f[0]) * (f[2] - f[1]));
}

// How steep a linear function of these corner values is [1/m].
double steepness(const std::array<Vec3d, 3>& p, const std::array<double, 3>& f) {
  const Vec3d x = p[1] - p[0], y = p[2] - p[0], n = cross(x, y);
  const double area2 = dot(n, n);
  if (!(area2 > 0.0)) return 0.0;
  return length((f[1] - f[0]) * cross(y, n) + (f[2] - f[0]) * cross(n, x)) / area2;
}

// Latitude by the mean way along the body: a band between two temperatures has an area and a mean length of its lines,
// which is the area's integral of the steepness over the step of temperature; their quotient is how wide it is.
struct Bands {
  std::vector<double> temperature, way;
  double around = 0.0;
};
Bands measure_bands(const TriMesh& mesh, const std::vector<double>& temperature) {
  std::vector<double> sorted = temperature;
  std::sort(sorted.begin(), sorted.end());
  Bands bands;
  for (int k = 0; k <= kBands; ++k) {
    const double t = sorted[(sorted.size() - 1) * static_cast<std::size_t>(k) / kBands];
    if (bands.temperature.empty() || t > bands.temperature.back()) bands.temperature.push_back(t);
  }
  const std::size_t n = bands.temperature.size();
  std::vector<double> area(n, 0.0), lines(n, 0.0);  // up to each temperature
  double whole = 0.0;
  for (const auto& t : mesh.triangles) {
    const std::array<Vec3d, 3> p{mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
    std::array<double, 3> f{temperature[t[0]], temperature[t[1]], temperature[t[2]]};
    const double steep = steepness(p, f), size = 0.5 * length(cross(p[1] - p[0], p[2] - p[0]));
    std::sort(f.begin(), f.end());
    for (std::size_t k = 0; k < n; ++k) {
      const double below = share_below(f, bands.temperature[k]);
      area[k] += below * size, lines[k] += below * size * steep;
    }
    whole += size;
  }
  bands.way.assign(n, 0.0);
  for (std::size_t k = 1; k < n; ++k) {
    const double line = (lines[k] - lines[k - 1]) / (bands.temperature[k] - bands.temperature[k - 1]);
    bands.way[k] = bands.way[k - 1] + (line > 0.0 ? (area[k] - area[k - 1]) / line : 0.0);
  }
  bands.around = bands.way.back() > 0.0 ? whole / bands.way.back() : 0.0;
  return bands;
}

}  // namespace

std::array<int, 2> poles_along_longest_axis(const TriMesh& mesh) {
  Vec3d mean;
  const Vec3d axis = numerics::principal(numerics::covariance(mesh.positions, mean)).axis[0];
  std::array<int, 2> poles{0, 0};
  for (int i = 0; i < static_cast<int>(mesh.positions.size()); ++i) {
    const double along = dot(mesh.positions[i], axis);
    if (along < dot(mesh.positions[poles[0]], axis)) poles[0] = i;
    if (along > dot(mesh.positions[poles[1]], axis)) poles[1] = i;
  }
  return poles;
}

std::array<int, 2> poles_farthest_along_edges(const TriMesh& mesh) {
  const Csr neighbours = vertex_neighbours(mesh);
  std::array<int, 2> poles{poles_along_longest_axis(mesh)[0], 0};
  for (int sweep = 0; sweep < 4; ++sweep) {
    const std::vector<double> way = ways_from(mesh, neighbours, poles[0]);
    poles[1] = static_cast<int>(std::max_element(way.begin(), way.end()) - way.begin());
    std::swap(poles[0], poles[1]);
  }
  return poles;
}

int nearest_vertex(const TriMesh& mesh, Vec3d place) {
  int best = 0;
  for (int i = 0; i < static_cast<int>(mesh.positions.size()); ++i)
    if (length(mesh.positions[i] - place) < length(mesh.positions[best] - place)) best = i;
  return best;
}

SphereMap map_to_sphere(const TriMesh& mesh, std::array<int, 2> poles) {
  const EdgeWeights weights = cotangent_weights(mesh);
  require_sphere(mesh, weights.neighbours, poles);
  SphereMap map;
  map.u = longitudes(mesh, weights, poles);
  std::vector<double> temperature(mesh.positions.size(), 0.0);
  std::vector<std::uint8_t> held(temperature.size(), 0);
  held[poles[0]] = held[poles[1]] = 1;
  temperature[poles[1]] = 1.0;
  relax(weights, held, temperature);
  const Bands bands = measure_bands(mesh, temperature);
  map.length = bands.way.back(), map.around = bands.around;
  for (double t : temperature) {
    const auto above = std::upper_bound(bands.temperature.begin() + 1, bands.temperature.end() - 1, t);
    const auto k = static_cast<std::size_t>(above - bands.temperature.begin());
    const double share = (t - bands.temperature[k - 1]) / (bands.temperature[k] - bands.temperature[k - 1]);
    const double way = bands.way[k - 1] + std::clamp(share, 0.0, 1.0) * (bands.way[k] - bands.way[k - 1]);
    map.v.push_back(way / map.length);
  }
  return map;
}

}  // namespace trocar::geometry::nurbs
