#include <algorithm>

#include <trocar/attempt/free_way.hpp>

namespace trocar::attempt {

std::vector<Vec3d> drawn_points_but(const sim::Model& model, int organ) {
  std::vector<Vec3d> points;
  for (int o = 0; o < model.organs(); ++o)
    if (o != organ)
      for (const Vec3f& p : model.skin(o).rest) points.push_back(vec_cast<double>(p));
  for (const interactions::StrandBody& s : model.strand_bodies)
    points.insert(points.end(), s.model.rest.begin(), s.model.rest.end());
  for (const sim::MembraneBody& m : model.membranes)
    for (const Vec3f& p : m.skin.rest) points.push_back(vec_cast<double>(p));
  return points;
}

double off_segment(Vec3d p, Vec3d a, Vec3d b) {
  const Vec3d way = b - a;
  const double t = std::clamp(dot(p - a, way) / dot(way, way), 0.0, 1.0);
  return length(p - (a + t * way));
}

int points_near(const std::vector<Vec3d>& points, Vec3d a, Vec3d b, double radius) {
  return int(std::count_if(points.begin(), points.end(), [&](Vec3d p) { return off_segment(p, a, b) < radius; }));
}

}  // namespace trocar::attempt
