#include <algorithm>
#include <cmath>

#include <trocar/geometry/curves/quarter.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/view/anatomy/lobules.hpp>
#include <trocar/view/anatomy/omentum.hpp>
#include <trocar/view/base/relief.hpp>

namespace trocar::view {
namespace {

constexpr double kReaches = 0.47;         // share of the wall's height up to which it lies, in the mean
constexpr int kOmentumHalvings = 2;       // of the wall's edges: lobes are finer than its triangles
constexpr double kOmentumMargin = 0.006;  // [m] beyond its border, below the wall

/// How far inside its border a point lies [m]: tongues, frills on them. @param above the wall's lowest point [m]
double inside(Vec3d p, double above, double whole) {
  const double tongues = 0.011 * waves(p, 0.07) + 0.0035 * waves(p + Vec3d{0.2, 0, 0.1}, 0.03);
  const double frills = 0.0009 * waves(p + Vec3d{0.3, 0.2, 0}, 0.012);
  return kReaches * whole - above + tongues + frills;
}

/// What the apron is like in a place.
struct ApronFat {
  double thick = 0;   ///< [m]; below 0: under the wall
  double groove = 0;  ///< 1 between lobules
};

/// Broad swellings, lobes, and lobules on them, in places more, in places fewer; towards its border a thin, rounded
/// lip. Beyond it lies below the wall.
ApronFat apron_fat(Vec3d p, double deep) {
  if (deep <= 0) return {std::max(-0.0012, 0.5 * deep), 0};
  const double lip = 0.0015 * (1 - std::exp(-deep / 0.003));
  const double grown = smooth(0, 0.02, deep);
  const double swell = 0.0034 + 0.0034 * waves(p, 0.052);
  const double lobe = lobules(p + Vec3d{0.4, 0.1, 0.2}, 0.022);
  const double marked = 0.5 + 0.5 * smooth(-0.5, 0.5, waves(p + Vec3d{0.2, 0.6, 0.4}, 0.037));
  const double lobule = lobules(p + Vec3d{0.1, 0.5, 0.3}, 0.0072);
  const double uneven = 0.0034 * lobe + 0.0020 * marked * lobule;
  return {lip + grown * (swell + uneven) + 0.3 * (1 - grown) * smooth(0, 0.004, deep) * 0.0016 * lobule,
          std::max(0.6 * (1 - lobe) * (1 - lobe), marked * (1 - lobule) * (1 - lobule))};
}

struct ApronPoint {
  Vec3d p, n;
};

/// Triangles over points, each divided into four.
struct ApronNet {
  std::vector<ApronPoint> points;
  std::vector<std::array<int, 3>> triangles;

  void divide() {
    geometry::Quartered finer = geometry::quartered(triangles, int(points.size()));
    for (const auto& [a, b] : finer.halved) {
      const ApronPoint &i = points[std::size_t(a)], &j = points[std::size_t(b)];
      points.push_back({0.5 * (i.p + j.p), normalised(i.n + j.n, i.n)});
    }
    triangles = std::move(finer.triangles);
  }
};

/// Which part of a surface is covered.
struct CoveredGround {
  Vec3d up;
  double lowest = 1e9, highest = -1e9;  ///< of the wall [m]

  double inside_at(Vec3d p) const { return inside(p, dot(p, up) - lowest, highest - lowest); }
};

/// Adds what of a surface is covered at all, and a little more.
void take(std::span<const Vec3f> points, std::span<const Vec3f> normals, std::span<const std::uint32_t> triangles,
          const CoveredGround& ground, ApronNet& net) {
  std::vector<std::uint8_t> covered(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    covered[i] = ground.inside_at(vec_cast<double>(points[i])) > -kOmentumMargin;
  std::vector<int> number(points.size(), -1);
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    const std::span<const std::uint32_t> corners = triangles.subspan(t, 3);
    if (std::none_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return covered[v] != 0; })) continue;
    std::array<int, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = corners[k];
      if (number[v] < 0) {
        number[v] = int(net.points.size());
        net.points.push_back({vec_cast<double>(points[v]), vec_cast<double>(normals[v])});
      }
      corner[k] = number[v];
    }
    net.triangles.push_back(corner);
  }
}

CoveredGround ground_of(const tissue::Skin& wall, Vec3d gravity) {
  CoveredGround ground{normalised(-1.0 * gravity, Vec3d{0, 0, 1})};
  for (const Vec3f& x : wall.rest) {
    ground.lowest = std::min(ground.lowest, dot(vec_cast<double>(x), ground.up));
    ground.highest = std::max(ground.highest, dot(vec_cast<double>(x), ground.up));
  }
  return ground;
}

MeshBuffer apron(ApronNet net, const CoveredGround& ground) {
  MeshBuffer b;
  for (int i = 0; i < kOmentumHalvings; ++i) net.divide();
  for (const ApronPoint& point : net.points) {
    const double deep = ground.inside_at(point.p);
    const ApronFat fat = apron_fat(point.p, deep);
    const double patch = smooth(0.2, 0.9, waves(point.p + Vec3d{0.3, 0.3, 0}, 0.03));
    Paint paint;
    paint.openness = to_byte((0.72 + 0.28 * smooth(0.001, 0.007, fat.thick)) * (1 - 0.45 * fat.groove));
    paint.tint = to_byte(std::max({0.3 * patch, 0.4 * fat.groove, 0.9 * smooth(0.008, 0, deep)}));
    b.add(vec_cast<float>(point.p + fat.thick * point.n), paint);
  }
  for (const auto& [i, j, k] : net.triangles) b.triangle(std::uint32_t(i), std::uint32_t(j), std::uint32_t(k));
  render::vertex_normals(b.positions, b.indices, b.normals);
  return b;
}

}  // namespace

MeshBuffer omentum_on(const tissue::Skin& wall, Vec3d gravity) {
  const CoveredGround ground = ground_of(wall, gravity);
  ApronNet net;
  if (!(ground.highest > ground.lowest)) return {};
  std::vector<std::uint32_t> triangles;
  for (const auto& t : wall.triangles)
    for (const int v : t) triangles.push_back(std::uint32_t(v));
  take(wall.rest, wall.rest_normal, triangles, ground, net);
  return apron(std::move(net), ground);
}

MeshBuffer omentum_beyond(const tissue::Skin& wall, Vec3d gravity, const MeshBuffer& beyond) {
  const CoveredGround ground = ground_of(wall, gravity);
  ApronNet net;
  if (ground.highest > ground.lowest) take(beyond.positions, beyond.normals, beyond.indices, ground, net);
  return apron(std::move(net), ground);
}

}  // namespace trocar::view
