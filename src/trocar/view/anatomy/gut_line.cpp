#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/view/anatomy/gut_line.hpp>
#include <trocar/view/base/relief.hpp>

namespace trocar::view {
namespace {

constexpr int kPasses = 80;
constexpr double kTouch = 0.96;                      // of both radii: touching walls flatten each other
constexpr double kOnFloor = 0.8;                     // of the radius above a wall
constexpr double kGutAlong = 1.2, kGutRound = 0.85;  // patterns: shorter along the gut, longer around it

/// Two points of one line are neighbours, not in each other's way, when they are nearer than this along it [radii].
constexpr double kOwnReach = 3.2;

void push_apart(GutLine& a, std::size_t i, GutLine& b, std::size_t j) {
  const Vec3d d = b.points[j] - a.points[i];
  const double far = length(d), want = kTouch * (a.radius[i] + b.radius[j]);
  if (far >= want || far < 1e-9) return;
  const Vec3d step = (0.25 * (want - far) / far) * d;
  a.points[i] -= (1 - a.hold[i]) * step;
  b.points[j] += (1 - b.hold[j]) * step;
}

void part_lines(std::vector<GutLine>& lines) {
  for (std::size_t m = 0; m < lines.size(); ++m)
    for (std::size_t n = m; n < lines.size(); ++n)
      for (std::size_t i = 0; i < lines[m].points.size(); ++i) {
        const double own = m == n ? kOwnReach * lines[m].radius[i] / kGutStep : 0;
        for (std::size_t j = m == n ? i + std::size_t(own) + 1 : 0; j < lines[n].points.size(); ++j)
          push_apart(lines[m], i, lines[n], j);
      }
}

void keep_out_of(GutLine& line, std::span<const Vec3d> bodies) {
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    if (line.hold[i] >= 1) continue;
    for (const Vec3d& p : bodies) {
      const Vec3d d = line.points[i] - p;
      const double far = length(d), want = 0.9 * line.radius[i];
      if (far < want && far > 1e-9) line.points[i] += ((1 - line.hold[i]) * 0.3 * (want - far) / far) * d;
    }
  }
}

void keep_above(GutLine& line, const WallSurface& walls) {
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    if (line.hold[i] >= 0.5) continue;
    const WallSurface::Place floor = walls.nearest(line.points[i]);
    if (!floor.there) continue;
    const double low = kOnFloor * line.radius[i] - dot(line.points[i] - floor.point, floor.normal);
    if (low > 0) line.points[i] += ((1 - line.hold[i]) * low) * floor.normal;
  }
}

void even_out(GutLine& line) {
  for (std::size_t i = 1; i + 1 < line.points.size(); ++i) {
    const Vec3d middle = 0.5 * (line.points[i - 1] + line.points[i + 1]);
    line.points[i] += (0.3 * (1 - line.hold[i])) * (middle - line.points[i]);
  }
}

}  // namespace

std::vector<Vec3d> line_through(std::span<const Vec3d> knots) {
  std::vector<Vec3d> line;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const Vec3d &a = knots[i], &b = knots[i + 1];
    const Vec3d da = 0.5 * (b - knots[i > 0 ? i - 1 : 0]), db = 0.5 * (knots[std::min(i + 2, knots.size() - 1)] - a);
    const int steps = std::max(1, int(length(b - a) / kGutStep));
    for (int k = 0; k < steps; ++k) {
      const double t = double(k) / steps, u = 1 - t;
      line.push_back((u * u * (1 + 2 * t)) * a + (t * t * (3 - 2 * t)) * b + (u * u * t) * da - (t * t * u) * db);
    }
  }
  if (!knots.empty()) line.push_back(knots.back());
  return line;
}

void settle(std::vector<GutLine>& lines, std::span<const Vec3d> bodies, const WallSurface& walls) {
  for (int pass = 0; pass < kPasses; ++pass) {
    part_lines(lines);
    for (GutLine& line : lines) {
      keep_out_of(line, bodies);
      even_out(line);
      if (pass % 8 == 7) keep_above(line, walls);
    }
  }
}

MeshBuffer gut(const GutLine& line, Vec3d up, int patch) {
  MeshBuffer b;
  double way = 0;
  const std::size_t n = line.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3d p = line.points[i];
    if (i > 0) way += length(p - line.points[i - 1]);
    const Vec3d along = normalised(line.points[std::min(i + 1, n - 1)] - line.points[i > 0 ? i - 1 : 0]);
    const Vec3d high = normalised(up - dot(up, along) * along, any_perpendicular(along)), beside = cross(along, high);
    // On the inner side of a bend the wall is drawn together in shallow creases.
    const Vec3d bend = i > 0 && i + 1 < n ? line.points[i + 1] + line.points[i - 1] - 2.0 * p : Vec3d{};
    const Vec3d inward = normalised(bend, high);
    const double bent = std::min(1.0, length(bend) / (kGutStep * kGutStep) * line.radius[i]);
    const double squeeze = 0.07 * waves({way, 0.1 * patch, 0}, 0.034) + 0.035 * waves({way, 0.2, 0.1 * patch}, 0.013);
    const std::uint32_t row = b.size();
    for (int k = 0; k < kGutSides; ++k) {
      const double a =
          2 * portable::pi * k / kGutSides - portable::pi;  // begins below, where nobody sees the patterns' seam
      const Vec3d dir = std::cos(a) * high + std::sin(a) * beside;
      const double crease =
          0.04 * bent * smooth(-0.1, 0.9, dot(dir, inward)) * waves({way, 0.3 * a * line.radius[i], 0}, 0.0095);
      const double r = line.radius[i] * (1 + squeeze + crease + 0.03 * waves(p + 0.006 * dir, 0.015));
      b.add(vec_cast<float>(p + r * dir));
      b.rest.push_back(vec_cast<float>(Vec3d{kGutAlong * way + 0.317 * patch, kGutRound * a * line.radius[i], 0}));
    }
    if (i > 0) join_rows(b, row - kGutSides, row, kGutSides, true);
  }
  render::vertex_normals(b.positions, b.indices, b.normals);
  return b;
}

}  // namespace trocar::view
