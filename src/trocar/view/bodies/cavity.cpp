#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include <trocar/geometry/curves/quarter.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/view/base/fair_surface.hpp>
#include <trocar/view/base/relief.hpp>
#include <trocar/view/bodies/cavity.hpp>

namespace trocar::view {
namespace {

constexpr int kCavityHalvings = 5;                         // of an icosahedron's edges: 6 mm on average
constexpr int kCavityBelow = 3;                            // rings of the cavity that lie below a wall
constexpr double kCavitySunk = 0.00015;                    // [m] times (rings from the wall's border)^2
constexpr double kCavityNear = 1.5e-6, kCavityFar = 4e-5;  // weights, see fairest()

tissue::Box bounds_of(const sim::Model& model) {
  tissue::Box box;
  for (int i = 0; i < model.organs(); ++i)
    for (int v = 0; v < model.skin(i).size(); ++v)
      if (model.skin(i).at_surface(v)) box.add(model.skin(i).rest[std::size_t(v)]);
  for (const sim::WallModel& w : model.walls)
    for (const Vec3f& p : w.skin.rest) box.add(p);
  for (const sim::HandModel& t : model.hands) box.add(vec_cast<float>(t.port));
  box.add(vec_cast<float>(model.scope.port));
  return box;
}

/// An uneven ellipsoid.
struct Cavity {
  Vec3d middle, half;

  explicit Cavity(const sim::Model& model) {
    const tissue::Box box = bounds_of(model);
    middle = 0.5 * vec_cast<double>(box.low + box.high);
    half = 0.5 * vec_cast<double>(box.high - box.low) + Vec3d{0.03, 0.03, 0.03};
  }
  Vec3d at(Vec3d d) const {
    const double uneven = 1.22 + 0.05 * waves(0.1 * d, 0.09);
    return middle + uneven * Vec3d{half.x * d.x, half.y * d.y, half.z * d.z};
  }
  /// Where a ray from the middle meets it.
  Vec3d at_direction(Vec3d d) const {
    return at(normalised(Vec3d{d.x / half.x, d.y / half.y, d.z / half.z}, Vec3d{0, 1, 0}));
  }
};

}  // namespace

double fat_below(Vec3d p) {
  return 0.4 * smooth(0.0, 0.9, 0.75 * waves(p, 0.052) + 0.4 * waves(p + Vec3d{0.3, 0.1, 0.2}, 0.019));
}

namespace {

/// The border of a skin as directed edges, in the order of its triangles.
std::vector<std::array<int, 2>> border_of(const tissue::Skin& skin) {
  std::map<std::pair<int, int>, int> seen;
  for (const auto& t : skin.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++seen[{t[k], t[(k + 1) % 3]}];
  std::vector<std::array<int, 2>> border;
  for (const auto& t : skin.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (const int a = t[k], b = t[(k + 1) % 3]; !seen.count({b, a})) border.push_back({a, b});
  return border;
}

/// The border's vertices in the order in which its edges follow each other.
std::vector<std::vector<int>> loops_of(const std::vector<std::array<int, 2>>& border) {
  std::map<int, int> next;
  for (const auto& [a, b] : border) next[a] = b;
  std::vector<std::vector<int>> loops;
  while (!next.empty()) {
    std::vector<int>& loop = loops.emplace_back();
    for (auto at = next.begin(); at != next.end();) {
      const int following = at->second;
      loop.push_back(at->first);
      next.erase(at);
      at = next.find(following);
    }
  }
  return loops;
}

}  // namespace

std::vector<std::vector<int>> border_loops(const tissue::Skin& wall) { return loops_of(border_of(wall)); }

namespace {

/// A ball of triangles around the origin: unit directions.
struct Ball {
  std::vector<Vec3d> points;
  std::vector<std::array<int, 3>> triangles;

  Ball() {
    const double g = 0.5 * (1 + std::sqrt(5.0));
    for (const double a : {-1.0, 1.0})
      for (const double b : {-g, g}) {
        points.push_back(normalised(Vec3d{0, a, b}));
        points.push_back(normalised(Vec3d{a, b, 0}));
        points.push_back(normalised(Vec3d{b, 0, a}));
      }
    for (int i = 0; i < 12; ++i)  // faces: three corners that are neighbours of each other
      for (int j = i + 1; j < 12; ++j)
        for (int k = j + 1; k < 12; ++k) {
          const Vec3d &p = points[std::size_t(i)], &q = points[std::size_t(j)], &r = points[std::size_t(k)];
          if (std::min({dot(p, q), dot(q, r), dot(r, p)}) < 0.4) continue;
          if (dot(cross(q - p, r - p), p) > 0)
            triangles.push_back({i, j, k});
          else
            triangles.push_back({i, k, j});
        }
    for (int i = 0; i < kCavityHalvings; ++i) divide();
  }
  void divide() {
    geometry::Quartered finer = geometry::quartered(triangles, int(points.size()));
    for (const auto& [a, b] : finer.halved)
      points.push_back(normalised(points[std::size_t(a)] + points[std::size_t(b)]));
    triangles = std::move(finer.triangles);
  }
  std::vector<std::vector<int>> neighbours() const {
    std::vector<std::vector<int>> net(points.size());
    for (const auto& t : triangles)  // every edge is seen once from either side
      for (std::size_t k = 0; k < 3; ++k) net[std::size_t(t[k])].push_back(t[(k + 1) % 3]);
    return net;
  }
};

/// How far out the walls are in every direction of the ball, 0 where there is none.
std::vector<double> distances(const sim::Model& model, const Ball& ball, Vec3d middle) {
  std::vector<double> out(ball.points.size(), 0.0);
  std::vector<int> order(ball.points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto z_of = [&](int i) { return ball.points[std::size_t(i)].z; };
  std::sort(order.begin(), order.end(), [&](int i, int j) { return z_of(i) < z_of(j); });
  for (const sim::WallModel& wall : model.walls)
    for (const auto& t : wall.skin.triangles) {
      std::array<Vec3d, 3> p;
      double low = 1, high = -1;
      for (std::size_t k = 0; k < 3; ++k) {
        p[k] = vec_cast<double>(wall.skin.rest[std::size_t(t[k])]) - middle;
        low = std::min(low, normalised(p[k]).z);
        high = std::max(high, normalised(p[k]).z);
      }
      const Vec3d n = cross(p[1] - p[0], p[2] - p[0]);
      const double volume = dot(p[0], n);
      constexpr double kSlack = 1e-3;  // an arc bulges over its ends
      auto at =
          std::lower_bound(order.begin(), order.end(), low - kSlack, [&](int i, double z) { return z_of(i) < z; });
      for (; at != order.end() && z_of(*at) < high + kSlack; ++at) {
        const Vec3d d = ball.points[std::size_t(*at)];
        const double u = dot(d, cross(p[1], p[2])) / volume, v = dot(d, cross(p[2], p[0])) / volume,
                     w = dot(d, cross(p[0], p[1])) / volume;
        if (u < 0 || v < 0 || w < 0) continue;
        double& far = out[std::size_t(*at)];
        far = std::max(far, 1 / (u + v + w));
      }
    }
  return out;
}

/// Rings of neighbours from where `inside` changes, counted within it.
std::vector<int> rings(const std::vector<std::vector<int>>& net, const std::vector<double>& far, bool inside) {
  std::vector<int> ring(far.size(), 0), front;
  for (std::size_t i = 0; i < far.size(); ++i) {
    if ((far[i] > 0) == inside) continue;
    for (const int j : net[i])
      if ((far[std::size_t(j)] > 0) == inside && ring[std::size_t(j)] == 0) {
        ring[std::size_t(j)] = 1;
        front.push_back(j);
      }
  }
  for (std::size_t k = 0; k < front.size(); ++k) {
    const auto from = std::size_t(front[k]);
    for (const int j : net[from])
      if ((far[std::size_t(j)] > 0) == inside && ring[std::size_t(j)] == 0) {
        ring[std::size_t(j)] = ring[from] + 1;
        front.push_back(j);
      }
  }
  return ring;
}

}  // namespace

render::Material lining(render::Material material, const sim::Model& model) {
  const Cavity cavity(model);
  material.middle = vec_cast<float>(cavity.middle);
  material.fibre_axis = vec_cast<float>(normalised(cavity.middle - model.scope.port, Vec3d{0, 1, 0}));
  return material;
}

MeshBuffer cavity_around(const sim::Model& model) {
  const Cavity cavity(model);
  const Ball ball;
  const std::vector<std::vector<int>> net = ball.neighbours();
  const std::vector<double> far = distances(model, ball, cavity.middle);
  const std::vector<int> below = rings(net, far, true), beyond = rings(net, far, false);
  std::vector<double> wished(far.size()), weight(far.size());
  for (std::size_t i = 0; i < far.size(); ++i) {
    wished[i] = far[i] > 0 ? far[i] : length(cavity.at_direction(ball.points[i]) - cavity.middle);
    weight[i] = far[i] > 0 ? kHeldFast : kCavityNear + kCavityFar * smooth(2, 16, beyond[i]);
  }
  const std::vector<double> radius = model.walls.empty() ? wished : fairest(net, wished, weight);
  MeshBuffer b;
  std::vector<int> number(far.size(), -1);
  for (const auto& t : ball.triangles) {
    const auto deep = [&](int v) { return below[std::size_t(v)] > kCavityBelow; };
    if (deep(t[0]) || deep(t[1]) || deep(t[2])) continue;
    std::array<std::uint32_t, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = std::size_t(t[k]);
      if (number[v] < 0) {
        const double sunk = kCavitySunk * below[v] * below[v];
        const Vec3d p = cavity.middle + (radius[v] + sunk) * ball.points[v];
        number[v] = int(b.add(vec_cast<float>(p), Paint{255, 0, 0, to_byte(fat_below(p))}));
      }
      corner[k] = std::uint32_t(number[v]);
    }
    b.triangle(corner[0], corner[2], corner[1]);  // seen from inside
  }
  render::vertex_normals(b.positions, b.indices, b.normals);
  return b;
}

}  // namespace trocar::view
