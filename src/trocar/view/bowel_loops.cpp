#include <algorithm>
#include <cmath>

#include <trocar/render/mesh_arrays.hpp>
#include <trocar/view/bowel_loops.hpp>
#include <trocar/view/cavity.hpp>
#include <trocar/view/looks.hpp>
#include <trocar/view/relief.hpp>

namespace trocar::view {
namespace {

constexpr double kTwoPi = 6.28318530717959;
constexpr int kSides = 20;
constexpr double kRadius = 0.0105;               // [m]
constexpr double kStep = 0.0028;                 // [m] between rings
constexpr double kFine = 0.0004;                 // [m] of border between points of the line
constexpr double kInside = 0.022;                // [m] from the border, on the wall
constexpr double kSwing = 0.013, kBend = 0.046;  // [m] of the windings: to either side, one after the other
constexpr double kFloor = 0.35;                  // cosine between up and the normal of what counts as a floor

/// A place on the border and across it.
struct Edge {
  Vec3d at, out, up;
};

/// The longest run of the border that is a floor.
std::vector<Edge> floor_of(const sim::Model& model, const tissue::Skin& wall) {
  const Vec3d up = -normalised(model.gravity, Vec3d{0, 0, -1});
  std::vector<Edge> best;
  for (const std::vector<int>& loop : border_loops(wall)) {
    std::vector<Edge> run;
    for (std::size_t i = 0; i < 2 * loop.size(); ++i) {
      const int v = loop[i % loop.size()], next = loop[(i + 1) % loop.size()];
      const Vec3d n = vec_cast<double>(wall.rest_normal[std::size_t(v)]);
      const Vec3d a = vec_cast<double>(wall.rest[std::size_t(v)]), b = vec_cast<double>(wall.rest[std::size_t(next)]);
      if (dot(n, up) > kFloor)
        run.push_back({a, normalised(cross(b - a, n)), n});
      else
        run.clear();
      if (run.size() > best.size() && run.size() <= loop.size()) best = run;
    }
  }
  return best;
}

}  // namespace

MeshBuffer bowel_loops(const sim::Model& model, const WallSurface& walls) {
  MeshBuffer b;
  const auto large = [](const sim::SolidModel& s) { return look(s.look).fat_tags > 0; };
  if (model.walls.empty() || std::none_of(model.solids.begin(), model.solids.end(), large)) return b;
  const std::vector<Edge> edges = floor_of(model, model.walls.front().skin);
  if (edges.size() < 8) return b;
  std::vector<double> way{0};
  for (std::size_t i = 1; i < edges.size(); ++i) way.push_back(way.back() + length(edges[i].at - edges[i - 1].at));
  // A winding line on the floor, then lifted by the radius; both ends go down below it.
  std::vector<Vec3d> line, up;
  for (double s = 0; s < way.back(); s += kFine) {
    const auto i = std::size_t(std::upper_bound(way.begin(), way.end(), s) - way.begin()) - 1;
    const std::size_t j = std::min(i + 1, edges.size() - 1);
    const double w = j > i ? (s - way[i]) / (way[j] - way[i]) : 0;
    const Vec3d out = normalised((1 - w) * edges[i].out + w * edges[j].out),
                at = edges[i].at + w * (edges[j].at - edges[i].at);
    const Vec3d along = normalised(edges[j].at - edges[i].at);
    const double turn = kTwoPi * s / kBend + 0.8 * std::sin(23 * s);
    const Vec3d p = at - kInside * out + (kSwing * std::sin(turn)) * out + (0.35 * kSwing * std::sin(2 * turn)) * along;
    const WallSurface::Place floor = walls.nearest(p);
    const double ends = std::min(s, way.back() - s);
    line.push_back(floor.point + (kRadius * (0.75 - 2.6 * smooth(0.03, 0, ends))) * floor.normal);
    up.push_back(floor.normal);
  }
  for (int pass = 0; pass < 60; ++pass)
    for (std::size_t i = 1; i + 1 < line.size(); ++i) line[i] = 0.5 * line[i] + 0.25 * (line[i - 1] + line[i + 1]);
  double since = kStep, ends = 0;
  std::uint32_t before = 0;
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    since += length(line[i] - line[i - 1]);
    ends = std::min(double(i), double(line.size() - i)) * kFine;
    if (since < kStep) continue;
    since = 0;
    const Vec3d along = normalised(line[i + 1] - line[i - 1]), high = normalised(up[i] - dot(up[i], along) * along);
    const Vec3d beside = cross(along, high);
    const std::uint32_t row = b.size();
    for (int k = 0; k < kSides; ++k) {
      const double a = kTwoPi * k / kSides;
      const Vec3d dir = std::cos(a) * high + std::sin(a) * beside;
      const double r = kRadius * (0.15 + 0.85 * smooth(0, 0.02, ends)) *
                       (1 + 0.07 * waves(line[i] + 0.004 * dir, 0.017) + 0.05 * waves(line[i], 0.009));
      b.add(vec_cast<float>(line[i] + r * dir), {to_byte(0.3 + 0.7 * smooth(-0.7, 0.35, std::cos(a))), 0, 0, 0});
    }
    if (row > 0) join_rows(b, before, row, kSides, true);
    before = row;
  }
  render::vertex_normals(b.positions, b.indices, b.normals);
  return b;
}

}  // namespace trocar::view
