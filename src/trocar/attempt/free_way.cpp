#include <algorithm>
#include <array>

#include <trocar/attempt/free_way.hpp>

namespace trocar::attempt {
namespace {

/// Half of a mean edge, so that nothing passes between vertices unnoticed.
double half_edge(const tissue::Skin& skin) {
  double sum = 0;
  for (const std::array<int, 3>& t : skin.triangles)
    sum += length(vec_cast<double>(skin.rest[std::size_t(t[0])] - skin.rest[std::size_t(t[1])]));
  return skin.triangles.empty() ? 0 : 0.5 * sum / double(skin.triangles.size());
}

void add(const tissue::Skin& skin, std::vector<DrawnPoint>& points) {
  const double radius = half_edge(skin);
  for (const Vec3f& p : skin.rest) points.push_back({vec_cast<double>(p), radius});
}

}  // namespace

std::vector<DrawnPoint> drawn_points_but(const sim::Model& model, int organ) {
  std::vector<DrawnPoint> points;
  for (int o = 0; o < model.organs(); ++o)
    if (o != organ) add(model.skin(o), points);
  for (std::size_t s = 0; s < model.strands.size(); ++s)
    for (std::size_t n = 0; n < model.strand_bodies[s].model.rest.size(); ++n)
      points.push_back({model.strand_bodies[s].model.rest[n], model.strands[s].outer[n]});
  for (const sim::MembraneBody& m : model.membranes) add(m.skin, points);
  return points;
}

std::vector<DrawnPoint> wall_points(const sim::Model& model) {
  std::vector<DrawnPoint> points;
  for (const sim::WallModel& w : model.walls) add(w.skin, points);
  return points;
}

double off_segment(Vec3d p, Vec3d a, Vec3d b) {
  const Vec3d way = b - a;
  const double t = std::clamp(dot(p - a, way) / dot(way, way), 0.0, 1.0);
  return length(p - (a + t * way));
}

int points_near(const std::vector<DrawnPoint>& points, Vec3d a, Vec3d b, double radius) {
  return int(std::count_if(points.begin(), points.end(),
                           [&](const DrawnPoint& p) { return off_segment(p.at, a, b) < radius + p.radius; }));
}

}  // namespace trocar::attempt
