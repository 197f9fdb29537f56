#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include <fmt/format.h>

#include <trocar/core/random.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/repair/cleaned.hpp>
#include <trocar/geometry/repair/crossing_cuts.hpp>
#include <trocar/geometry/repair/cut_triangle.hpp>
#include <trocar/geometry/repair/parted.hpp>
#include <trocar/geometry/repair/resolved.hpp>
#include <trocar/geometry/repair/shells.hpp>
#include <trocar/geometry/surfaces/crossings.hpp>
#include <trocar/geometry/surfaces/groups.hpp>

namespace trocar::geometry {
namespace {

constexpr double kNudges[] = {0, 1e-8, 1e-7, 1e-6};  ///< of the box's diagonal
constexpr double kMostWindingWork = 1e8;             ///< solid angles for one mesh: some seconds
constexpr double kCrumb = 1e-4;                      ///< of the area: a shell that was cut off and is smaller goes
constexpr double kGap = 4;                           ///< nudges: a shell that is thinner goes
constexpr double kWindingDoubt = 0.2;                ///< off a whole number of turns

using Pairs = std::vector<std::array<int, 2>>;

/// The same for all vertices at one place, so that what was parted stays together.
Vec3d nudge_of(Vec3d place, std::uint64_t round) {
  std::uint64_t seed = round;
  for (int k = 0; k < 3; ++k) {
    const double value = place[k] + 0.0;  // -0 is 0
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    seed = core::Random(seed ^ bits).next();
  }
  core::Random random(seed);
  const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
  return {x, y, z};
}

/// Vertices of triangles that cross are moved a little: nothing only touches after that.
TriMesh nudged(const TriMesh& mesh, const Pairs& pairs, double by, std::uint64_t round) {
  TriMesh out = mesh;
  std::vector<bool> moves(mesh.positions.size());
  for (const auto& pair : pairs)
    for (const int t : pair)
      for (const int v : mesh.triangles[t]) moves[v] = true;
  for (std::size_t v = 0; v < moves.size(); ++v)
    if (moves[v]) out.positions[v] += by * nudge_of(mesh.positions[v], round);
  return out;
}

/// A mesh whose triangles are cut where they cross, and which of the given ones each piece is of.
struct CutMesh {
  TriMesh mesh;
  std::vector<int> parent;
};

std::optional<CutMesh> cut_along(const TriMesh& mesh, const CrossingCuts& cuts) {
  CutMesh out;
  out.mesh.positions = cuts.places();
  for (int t = 0; t < int(mesh.triangles.size()); ++t) {
    const auto& corners = mesh.triangles[t];
    const auto within = cuts.triangles().find(t);
    bool any = within != cuts.triangles().end();
    for (int k = 0; k < 3; ++k)
      any = any ||
            cuts.any_on_edge(std::min(corners[k], corners[(k + 1) % 3]), std::max(corners[k], corners[(k + 1) % 3]));
    if (!any) {
      out.mesh.triangles.push_back(corners);
      out.parent.push_back(t);
      continue;
    }
    CutTriangle cut(out.mesh.positions, corners);
    for (int k = 0; k < 3; ++k) {
      const int a = corners[k], b = corners[(k + 1) % 3];
      std::vector<int> points = cuts.on_edge(std::min(a, b), std::max(a, b));
      if (a > b) std::reverse(points.begin(), points.end());
      cut.add_on_side(k, points);
    }
    if (within != cuts.triangles().end()) {
      for (const int p : within->second.within) cut.add_within(p);
      for (const auto& [a, b] : within->second.segments) cut.constrain(a, b);
    }
    cut.widen();
    if (!cut.good()) return std::nullopt;
    for (const auto& piece : cut.triangles()) {
      out.mesh.triangles.push_back(piece);
      out.parent.push_back(t);
    }
  }
  return out;
}

/// Pieces that hang together by edges with two triangles: none of them is cut off from the others by a crossing.
std::vector<int> patches_of(const TriMesh& mesh, std::vector<int>& largest) {
  const EdgeTable edges(mesh);
  Groups groups(mesh.triangles.size());
  for (int t = 0; t < int(mesh.triangles.size()); ++t)
    for (int k = 0; k < 3; ++k)
      if (const int other = edges.across(t, k); other >= 0) groups.join(t, other);
  std::vector<int> patch(mesh.triangles.size(), -1);
  for (int t = 0; t < int(patch.size()); ++t) {
    const int root = groups.root(t);
    if (root == t) {
      patch[t] = int(largest.size());
      largest.push_back(t);
    }
    patch[t] = patch[root];
    int& most = largest[patch[t]];
    if (length(area_vector(mesh, t)) > length(area_vector(mesh, most))) most = t;
  }
  return patch;
}

/// How often all triangles but one go around a place on that one: a whole number and a half, as it counts half.
std::optional<int> turns_before(const TriMesh& mesh, int own, Vec3d place) {
  const double turns = turns_without(mesh, own, place) - 0.5;  // in front of it
  const double whole = std::floor(turns + 0.5);
  if (std::fabs(turns - whole) > kWindingDoubt) return std::nullopt;
  return int(whole);
}

/// Folds leave shells of next to no size, and faces that lay in each other gaps as thin as they were nudged: of what
/// was cut off, which its new vertices tell, such shells go.
/// @param thickness  [m] that is none
TriMesh without_crumbs(TriMesh mesh, int old_vertices, double thickness) {
  const EdgeTable edges(mesh);
  const Shells shells = shells_of(mesh, edges, {});
  double all = 0;
  for (const Shell& shell : shells.list) all += shell.area;
  std::vector<bool> is_cut(shells.list.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int v : mesh.triangles[t])
      if (v >= old_vertices) is_cut[shells.of[t]] = true;
  std::vector<std::array<int, 3>> kept;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (const Shell& shell = shells.list[shells.of[t]];
        !is_cut[shells.of[t]] || (shell.area > kCrumb * all && std::fabs(shell.volume) > thickness * shell.area))
      kept.push_back(mesh.triangles[t]);
  mesh.triangles = std::move(kept);
  return without_unused(mesh).mesh;
}

/// The pieces that have inside behind them and outside in front.
std::optional<TriMesh> boundary_of(const TriMesh& mesh, const CutMesh& cut, double thickness, double& work_left) {
  std::vector<int> largest;
  const std::vector<int> patch = patches_of(cut.mesh, largest);
  work_left -= double(largest.size()) * double(mesh.triangles.size());
  if (work_left < 0) return std::nullopt;
  std::vector<bool> keep(largest.size());
  for (std::size_t p = 0; p < largest.size(); ++p) {
    const auto& [a, b, c] = cut.mesh.triangles[largest[p]];
    const Vec3d middle = (cut.mesh.positions[a] + cut.mesh.positions[b] + cut.mesh.positions[c]) / 3.0;
    const std::optional<int> front = turns_before(mesh, cut.parent[largest[p]], middle);
    if (!front) return std::nullopt;
    keep[p] = *front <= 0 && *front + 1 > 0;
  }
  TriMesh out{cut.mesh.positions, {}};
  for (std::size_t t = 0; t < patch.size(); ++t)
    if (keep[patch[t]]) out.triangles.push_back(cut.mesh.triangles[t]);
  return without_crumbs(parted(out).mesh, int(mesh.positions.size()), thickness);
}

bool is_resolved(const TriMesh& mesh) { return check_edges(mesh).closed() && self_crossings(mesh).pairs.empty(); }

std::optional<TriMesh> resolved_at_once(const TriMesh& mesh, double& work_left) {
  const Pairs given = self_crossings(mesh).pairs;
  if (given.empty()) return mesh;
  const Bounds box = bounds(mesh.positions);
  const double size = length(box.high - box.low);
  std::uint64_t round = 0;
  for (const double nudge : kNudges) {
    if (work_left < 0) break;
    const TriMesh work = nudge > 0 ? nudged(mesh, given, nudge * size, ++round) : mesh;
    const Crossings found = nudge > 0 ? self_crossings(work) : Crossings{given, int(given.size()) < kMostCrossings};
    if (!found.all) return std::nullopt;
    CrossingCuts cuts;
    if (!cuts.find(work, found.pairs)) continue;
    const std::optional<CutMesh> cut = cut_along(work, cuts);
    if (!cut) continue;
    std::optional<TriMesh> boundary = boundary_of(work, *cut, kGap * nudge * size, work_left);
    if (boundary && !boundary->triangles.empty() && is_resolved(*boundary)) return boundary;
  }
  return std::nullopt;
}

/// One shell after the other: where three surfaces meet in a point a cut of all at once fails. Cavities come last.
std::optional<TriMesh> resolved_by_shells(const TriMesh& mesh, double& work_left) {
  constexpr std::size_t most = 64;
  const EdgeTable edges(mesh);
  const Shells shells = shells_of(mesh, edges, {});
  if (shells.list.size() < 2 || shells.list.size() > most) return std::nullopt;
  TriMesh all;
  for (const bool cavities : {false, true})
    for (int s = 0; s < int(shells.list.size()); ++s) {
      if ((shells.list[s].volume < 0) != cavities) continue;
      TriMesh one{mesh.positions, {}};
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        if (shells.of[t] == s) one.triangles.push_back(mesh.triangles[t]);
      const std::optional<TriMesh> own = cavities ? std::optional(one) : resolved_at_once(one, work_left);
      if (!own) return std::nullopt;
      append(all, without_unused(*own).mesh);
      const std::optional<TriMesh> sum = resolved_at_once(all, work_left);
      if (!sum) return std::nullopt;
      all = *sum;
    }
  return all;
}

}  // namespace

Repaired resolved(const TriMesh& mesh) {
  Repaired out{mesh, {}, {}};
  const int before = int(self_crossings(mesh).pairs.size());
  if (before == 0) return out;
  double work_left = kMostWindingWork;
  std::optional<TriMesh> done = resolved_at_once(mesh, work_left);
  if (!done) done = resolved_by_shells(mesh, work_left);
  if (!done) {
    out.left.push_back(tr("{} pairs of triangles that cross could not be cut along their crossing", before));
    return out;
  }
  out.mesh = std::move(*done);
  out.tell("resolved", before, "crossing of triangles cut along its line",
           "crossings of triangles cut along their lines");
  return out;
}

}  // namespace trocar::geometry
