#include <algorithm>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/studies/operating_room/ways_in.hpp>

namespace trocar::studies {
namespace {

constexpr double kCounts = 0.003;  // [m] inside: less is grazed

bool may_meet(const geometry::TriMesh& mesh, Vec3d a, Vec3d b) {
  for (int k = 0; k < 3; ++k) {
    double low = 1e9, high = -1e9;
    for (const Vec3d& p : mesh.positions) low = std::min(low, p[k]), high = std::max(high, p[k]);
    if (std::max(a[k], b[k]) < low || std::min(a[k], b[k]) > high) return false;
  }
  return true;
}

}  // namespace

double way_through(const geometry::TriMesh& mesh, Vec3d a, Vec3d b) {
  if (!may_meet(mesh, a, b)) return 0;
  const Vec3d way = b - a;
  std::vector<double> cuts;
  for (const auto& t : mesh.triangles) {
    const auto hit = geometry::ray_triangle(a, way, mesh.positions[std::size_t(t[0])],
                                            mesh.positions[std::size_t(t[1])], mesh.positions[std::size_t(t[2])]);
    if (hit.hit && hit.t < 1) cuts.push_back(hit.t);
  }
  std::sort(cuts.begin(), cuts.end());
  // a ray through an edge cuts both neighbours in the same place
  cuts.erase(std::unique(cuts.begin(), cuts.end(), [](double x, double y) { return y - x < 1e-9; }), cuts.end());
  double inside = 0;
  for (std::size_t k = 0; k + 1 < cuts.size(); k += 2) inside += cuts[k + 1] - cuts[k];
  return inside * length(way);
}

WaysIn ways_in(const std::vector<InTheWay>& organs, Vec3d from, const std::vector<Vec3d>& to) {
  WaysIn out;
  std::vector<int> count(organs.size(), 0);
  std::vector<double> longest(organs.size(), 0.0);
  int blocked = 0;
  for (const Vec3d& p : to) {
    bool any = false;
    for (std::size_t k = 0; k < organs.size(); ++k) {
      const double through = way_through(organs[k].mesh, from, p);
      longest[k] = std::max(longest[k], through);
      if (through < kCounts) continue;
      ++count[k];
      any = true;
    }
    blocked += any;
  }
  if (blocked == 0) return out;
  const std::size_t most = std::size_t(std::max_element(count.begin(), count.end()) - count.begin());
  return {double(blocked) / double(to.size()), organs[most].name, longest[most]};
}

}  // namespace trocar::studies
