#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/repair/cleaned.hpp>
#include <trocar/geometry/repair/degenerate.hpp>
#include <trocar/geometry/repair/holes.hpp>
#include <trocar/geometry/repair/oriented.hpp>
#include <trocar/geometry/repair/parted.hpp>
#include <trocar/geometry/repair/untangled.hpp>
#include <trocar/geometry/surfaces/crossings.hpp>

namespace trocar::geometry {
namespace {

constexpr int kEaseRounds = 8, kCutRounds = 4;
constexpr double kEaseReach = 0.5;  ///< of its edges' mean, so far a vertex is moved at most
constexpr double kScrap = 0.05;     ///< an open piece that is smaller than this share of the largest one goes

/// A crossing surface, and how often it does.
struct Tangle {
  TriMesh mesh;
  std::vector<std::array<int, 2>> pairs;
  explicit Tangle(TriMesh given) : mesh(std::move(given)), pairs(self_crossings(mesh).pairs) {}
};

std::vector<bool> crossing_triangles(const Tangle& tangle) {
  std::vector<bool> out(tangle.mesh.triangles.size());
  for (const auto& [a, b] : tangle.pairs) out[a] = out[b] = true;
  return out;
}

void mark_vertices(const TriMesh& mesh, const std::vector<bool>& triangles, std::vector<bool>& vertices) {
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (triangles[t])
      for (const int v : mesh.triangles[t]) vertices[v] = true;
}

/// All triangles with a marked vertex.
std::vector<bool> grown(const TriMesh& mesh, const std::vector<bool>& triangles) {
  std::vector<bool> vertices(mesh.positions.size()), out(triangles.size());
  mark_vertices(mesh, triangles, vertices);
  for (std::size_t t = 0; t < out.size(); ++t)
    for (const int v : mesh.triangles[t]) out[t] = out[t] || vertices[v];
  return out;
}

/// Where an edge is in one triangle only nothing is eased: the mesh is closed.
Tangle eased(const Tangle& given) {
  Tangle best = given, now = given;
  const Csr neighbours = vertex_neighbours(given.mesh);
  const auto too_far = [&](int v) {
    double sum = 0;
    for (const int w : neighbours.row(v)) sum += length(given.mesh.positions[w] - given.mesh.positions[v]);
    const double reach = kEaseReach * sum / double(neighbours.row(v).size());
    return length(now.mesh.positions[v] - given.mesh.positions[v]) > reach;
  };
  for (int round = 0; round < kEaseRounds && !best.pairs.empty(); ++round) {
    std::vector<bool> moves(now.mesh.positions.size());
    mark_vertices(now.mesh, crossing_triangles(now), moves);
    const std::vector<Vec3d> before = now.mesh.positions;
    for (int v = 0; v < neighbours.rows(); ++v) {
      if (!moves[v]) continue;
      Vec3d sum{};
      for (const int w : neighbours.row(v)) sum += before[w];
      now.mesh.positions[v] = 0.5 * (before[v] + sum / double(neighbours.row(v).size()));
      if (too_far(v)) now.mesh.positions[v] = before[v];
    }
    now = Tangle(now.mesh);
    if (now.pairs.size() < best.pairs.size()) best = now;
  }
  return best;
}

/// Cuts out what crosses and `rings` around it, and closes the holes; nothing where that would be too much.
bool cut(const Tangle& tangle, int rings, bool smooth, TriMesh& out, int& gone) {
  std::vector<bool> drop = crossing_triangles(tangle);
  for (int ring = 0; ring < rings; ++ring) drop = grown(tangle.mesh, drop);
  gone = int(std::count(drop.begin(), drop.end(), true));
  if (gone > kMostCutOut * double(drop.size())) return false;
  out = tangle.mesh;
  out.triangles.clear();
  for (std::size_t t = 0; t < drop.size(); ++t)
    if (!drop[t]) out.triangles.push_back(tangle.mesh.triangles[t]);
  out = without_unused(parted(out).mesh).mesh;
  out = without_small_shells(out, kScrap, true).mesh;
  HoleOptions options;
  options.smooth = smooth;
  options.rings = false;
  out = with_holes_closed(out, options).mesh;
  out = oriented(without_degenerate(out).mesh).mesh;
  return check_edges(out).closed();
}

}  // namespace

Repaired untangled(const TriMesh& mesh) {
  Repaired out{mesh, {}, {}};
  Tangle best(mesh);
  const std::size_t before = best.pairs.size();
  if (before == 0) return out;
  best = eased(best);
  out.tell("untangled", int(before - best.pairs.size()), "crossing eased", "crossings eased");
  for (int round = 0; round < kCutRounds && !best.pairs.empty(); ++round)
    for (const bool smooth : {true, false}) {
      TriMesh trial;
      int gone = 0;
      if (best.pairs.empty() || !cut(best, 1 + round, smooth, trial, gone)) continue;
      Tangle tangle(std::move(trial));
      if (tangle.pairs.size() >= best.pairs.size()) continue;
      best = std::move(tangle);
      out.tell("untangled", gone, "triangle at crossings removed", "triangles at crossings removed");
    }
  out.mesh = std::move(best.mesh);
  if (!best.pairs.empty()) out.left.push_back(tr("{} pairs of triangles still cross", best.pairs.size()));
  return out;
}

}  // namespace trocar::geometry
