#include <algorithm>
#include <cmath>
#include <map>

#include <trocar/render/mesh_arrays.hpp>
#include <trocar/view/omentum.hpp>
#include <trocar/view/relief.hpp>

namespace trocar::view {
namespace {

constexpr double kCovered = 0.24, kBare = 0.42;  // shares of the wall's height: covered below the first
constexpr int kHalvings = 2;                     // of the wall's edges: lobes are finer than its triangles

/// How much of the apron there is over a point, 0..1. @param height 0 lowest point of the wall .. 1 highest
double cover(Vec3d p, double height) {
  return smooth(kBare, kCovered, height + 0.07 * waves(p, 0.075) + 0.03 * waves(p + Vec3d{0.2, 0, 0.1}, 0.028));
}

/// Thickness [m]: broad swellings, lobes, and lobules on them. Where it ends it dips below the wall.
double thickness(Vec3d p, double covered) {
  const double swell = 0.0045 + 0.0022 * waves(p, 0.034);
  const double lobes = 0.0034 * std::fabs(waves(p + Vec3d{0.4, 0.1, 0.2}, 0.026));
  const double lobules = 0.0013 * std::fabs(waves(p + Vec3d{0.1, 0.5, 0.3}, 0.0105));
  return covered * (swell + lobes + lobules) - 0.0012 * (1 - covered);
}

struct Point {
  Vec3d p, n;
};

/// Triangles over points, each divided into four.
struct Net {
  std::vector<Point> points;
  std::vector<std::array<int, 3>> triangles;

  void divide() {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [found, anew] = middles.try_emplace(std::minmax(a, b), int(points.size()));
      if (anew) {
        const Point &i = points[std::size_t(a)], &j = points[std::size_t(b)];
        points.push_back({0.5 * (i.p + j.p), normalised(i.n + j.n, i.n)});
      }
      return found->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& [a, b, c] : triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
};

/// What of the wall is covered at all.
Net lowest_part(const tissue::Skin& wall, Vec3d up, double lowest, double highest) {
  Net net;
  std::map<int, int> number;
  for (const auto& t : wall.triangles) {
    const auto is_covered = [&](int v) {
      const Vec3d p = vec_cast<double>(wall.rest[std::size_t(v)]);
      return cover(p, (dot(p, up) - lowest) / (highest - lowest)) > 0;
    };
    if (std::none_of(t.begin(), t.end(), is_covered)) continue;
    std::array<int, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [found, anew] = number.try_emplace(t[k], int(net.points.size()));
      const auto v = std::size_t(t[k]);
      if (anew) net.points.push_back({vec_cast<double>(wall.rest[v]), vec_cast<double>(wall.rest_normal[v])});
      corner[k] = found->second;
    }
    net.triangles.push_back(corner);
  }
  return net;
}

}  // namespace

MeshBuffer omentum_on(const tissue::Skin& wall, Vec3d gravity) {
  const Vec3d up = normalised(-1.0 * gravity, Vec3d{0, 0, 1});
  double lowest = 1e9, highest = -1e9;
  for (const Vec3f& x : wall.rest) {
    lowest = std::min(lowest, dot(vec_cast<double>(x), up));
    highest = std::max(highest, dot(vec_cast<double>(x), up));
  }
  MeshBuffer b;
  if (!(highest > lowest)) return b;
  Net net = lowest_part(wall, up, lowest, highest);
  for (int i = 0; i < kHalvings; ++i) net.divide();
  for (const Point& point : net.points) {
    const double covered = cover(point.p, (dot(point.p, up) - lowest) / (highest - lowest));
    const double thick = thickness(point.p, covered);
    Paint paint;
    paint.openness = to_byte(0.55 + 0.45 * smooth(0.001, 0.006, thick));
    paint.tint = to_byte(0.55 * smooth(0.2, 0.9, waves(point.p + Vec3d{0.3, 0.3, 0}, 0.03)));
    b.add(vec_cast<float>(point.p + thick * point.n), paint);
  }
  for (const auto& [i, j, k] : net.triangles) b.triangle(std::uint32_t(i), std::uint32_t(j), std::uint32_t(k));
  render::vertex_normals(b.positions, b.indices, b.normals);
  return b;
}

}  // namespace trocar::view
