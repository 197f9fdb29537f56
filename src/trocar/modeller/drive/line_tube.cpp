#include <cmath>
#include <vector>

#include <trocar/geometry/curves/frames.hpp>
#include <trocar/modeller/drive/line_tube.hpp>

namespace trocar::modeller {
namespace {

constexpr double kOnePlace = 1e-9;  // [m]

struct Corner {
  double cos, sin;
};

/// Of a polygon with a unit circle's area.
std::vector<Corner> ring_corners() {
  const double angle = 2 * M_PI / kTubeSides, out = std::sqrt(angle / std::sin(angle));
  std::vector<Corner> corners;
  for (int i = 0; i < kTubeSides; ++i) corners.push_back({out * std::cos(i * angle), out * std::sin(i * angle)});
  return corners;
}

/// A fan from the middle of a ring. @param first  vertex of the ring @param outward  along the line, else against it
void close_ring(geometry::TriMesh& mesh, int first, Vec3d middle, bool outward) {
  const int centre = int(mesh.positions.size());
  mesh.positions.push_back(middle);
  for (int i = 0; i < kTubeSides; ++i) {
    const int a = first + i, b = first + (i + 1) % kTubeSides;
    mesh.triangles.push_back(outward ? std::array{centre, a, b} : std::array{centre, b, a});
  }
}

}  // namespace

geometry::TriMesh tube_around(std::span<const Vec3d> line, std::span<const double> radius) {
  std::vector<Vec3d> points;
  std::vector<double> radii;
  for (std::size_t i = 0; i < line.size(); ++i)
    if (points.empty() || length(line[i] - points.back()) > kOnePlace)
      points.push_back(line[i]), radii.push_back(radius[i]);
  geometry::TriMesh mesh;
  if (points.size() < 2) return mesh;
  std::vector<geometry::Frame> frames(points.size());
  geometry::transport_frames(points, {0, 0, 1}, frames);
  const std::vector<Corner> corners = ring_corners();
  for (std::size_t k = 0; k < points.size(); ++k)
    for (const Corner& c : corners)
      mesh.positions.push_back(points[k] + radii[k] * (c.cos * frames[k].normal + c.sin * frames[k].binormal));
  const int rings = int(points.size());
  for (int k = 0; k + 1 < rings; ++k)
    for (int i = 0; i < kTubeSides; ++i) {
      const int a = k * kTubeSides + i, b = k * kTubeSides + (i + 1) % kTubeSides;
      mesh.triangles.push_back({a, b, b + kTubeSides});
      mesh.triangles.push_back({a, b + kTubeSides, a + kTubeSides});
    }
  close_ring(mesh, 0, points.front(), false);
  close_ring(mesh, (rings - 1) * kTubeSides, points.back(), true);
  return mesh;
}

}  // namespace trocar::modeller
