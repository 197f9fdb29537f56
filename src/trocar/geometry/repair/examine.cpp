#include <algorithm>
#include <cmath>

#include <trocar/geometry/repair/examine.hpp>
#include <trocar/geometry/surfaces/crossings.hpp>
#include <trocar/geometry/surfaces/groups.hpp>
#include <trocar/geometry/tets/tet_faces.hpp>

namespace trocar::geometry {
namespace {

/// The triangles without those that have a corner that is no place: these get a corner twice, and so no edges.
TriMesh finite_part(const TriMesh& mesh, std::vector<int>& not_finite) {
  TriMesh good = mesh;
  std::vector<bool> bad(mesh.positions.size());
  for (int v = 0; v < int(mesh.positions.size()); ++v) {
    if (is_place(mesh.positions[v])) continue;
    not_finite.push_back(v);
    good.positions[v] = {};
    bad[v] = true;
  }
  for (auto& t : good.triangles)
    if (bad[t[0]] || bad[t[1]] || bad[t[2]]) t = {t[0], t[0], t[0]};
  return good;
}

std::vector<bool> used_vertices(const TriMesh& mesh) {
  std::vector<bool> used(mesh.positions.size());
  for (const auto& t : mesh.triangles)
    for (const int v : t) used[v] = true;
  return used;
}

void look_at_edges(const EdgeTable& edges, Diagnosis& d) {
  edges.for_each([&](std::span<const EdgeUse> uses) {
    const std::array<int, 2> edge{uses[0].low, uses[0].high};
    if (uses.size() > 2) d.crowded_edges.push_back(edge);
    if (uses.size() == 2 && uses[0].upwards == uses[1].upwards) d.turned_edges.push_back(edge);
  });
}

void look_at_vertices(const TriMesh& mesh, const EdgeTable& edges, double tolerance, Diagnosis& d) {
  const std::vector<bool> used = used_vertices(mesh);
  const std::vector<int> fans = fans_of(mesh, edges);
  for (int v = 0; v < int(used.size()); ++v) {
    if (!used[v]) d.unused.push_back(v);
    if (fans[v] > 1) d.pinched_vertices.push_back(v);
  }
  std::erase_if(d.unused, [&](int v) { return std::binary_search(d.not_finite.begin(), d.not_finite.end(), v); });
  d.box = bounds_of(mesh.positions, used);
  std::vector<bool> on_border(mesh.positions.size());
  for (const Rim& rim : d.holes)
    for (const int v : rim.vertices) on_border[v] = true;
  const std::vector<int> same = same_nodes(mesh.positions, used, tolerance * diagonal(d.box));
  std::vector<bool> border_there(mesh.positions.size());
  for (int v = 0; v < int(same.size()); ++v)
    if (on_border[v]) border_there[same[v]] = true;
  for (int v = 0; v < int(same.size()); ++v)
    if (same[v] != v && border_there[same[v]]) d.duplicate_vertices.push_back({v, same[v]});
}

void look_at_triangles(const TriMesh& mesh, double sliver_deg, Diagnosis& d) {
  std::vector<std::pair<std::array<int, 3>, int>> sorted;
  for (int t = 0; t < int(mesh.triangles.size()); ++t) {
    if (is_degenerate(mesh, t)) {
      d.degenerate.push_back(t);
    } else {
      const double angle = least_angle_deg(mesh, t);
      d.least_angle = std::min(d.least_angle, angle);
      if (angle < sliver_deg) d.slivers.push_back(t);
    }
    if (corner_twice(mesh.triangles[t])) continue;
    sorted.push_back({mesh.triangles[t], t});
    std::sort(sorted.back().first.begin(), sorted.back().first.end());
  }
  std::sort(sorted.begin(), sorted.end());
  std::size_t first = 0;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i].first != sorted[first].first)
      first = i;
    else
      d.duplicate_triangles.push_back({sorted[i].second, sorted[first].second});
  }
  std::sort(d.duplicate_triangles.begin(), d.duplicate_triangles.end());
}

void look_at_shells(Diagnosis& d) {
  for (int s = 0; s < int(d.shells.list.size()); ++s) {
    const Shell& shell = d.shells.list[s];
    d.area += shell.area;
    d.volume += shell.is_cavity || !shell.closed() ? shell.volume : std::fabs(shell.volume);
    if (shell.closed() && shell.volume < 0 && !shell.is_cavity) d.inward.push_back(s);
  }
}

}  // namespace

bool is_place(Vec3d p) {
  for (int k = 0; k < 3; ++k)
    if (!(std::fabs(p[k]) <= kMostCoordinate)) return false;
  return true;
}

std::vector<int> fans_of(const TriMesh& mesh, const EdgeTable& edges) {
  Groups corners(3 * mesh.triangles.size());  // of all triangles: those that share a vertex and an edge at it
  for (int t = 0; t < int(mesh.triangles.size()); ++t)
    for (int k = 0; k < 3; ++k) {
      const int other = edges.across(t, k);
      if (other < t) continue;
      for (const int end : {k, (k + 1) % 3})
        corners.join(3 * t + end, 3 * other + corner_of(mesh.triangles[other], mesh.triangles[t][end]));
    }
  std::vector<int> fans(mesh.positions.size());
  for (int t = 0; t < int(mesh.triangles.size()); ++t)
    for (int k = 0; k < 3 && !corner_twice(mesh.triangles[t]); ++k)
      fans[mesh.triangles[t][k]] += corners.root(3 * t + k) == 3 * t + k;
  return fans;
}

bool is_degenerate(const TriMesh& mesh, int triangle) {
  const auto& t = mesh.triangles[triangle];
  if (corner_twice(t)) return true;
  double longest2 = 0;
  for (int k = 0; k < 3; ++k) {
    const Vec3d side = mesh.positions[t[(k + 1) % 3]] - mesh.positions[t[k]];
    longest2 = std::max(longest2, dot(side, side));
  }
  return !(length(area_vector(mesh, triangle)) > kNoHeight * longest2);
}

Diagnosis examine(const TriMesh& mesh, const ExamineOptions& options) {
  Diagnosis d;
  d.vertices = int(mesh.positions.size());
  d.triangles = int(mesh.triangles.size());
  const TriMesh good = finite_part(mesh, d.not_finite);
  const EdgeTable edges(good);
  d.holes = rims_of(good, edges);
  d.shells = shells_of(good, edges, d.holes);
  look_at_edges(edges, d);
  look_at_vertices(good, edges, options.tolerance, d);
  look_at_triangles(good, options.sliver_deg, d);
  look_at_shells(d);
  const bool mostly_twice = 2 * d.duplicate_triangles.size() > mesh.triangles.size();  // all of them cross all others
  if (options.crossings && mostly_twice) d.all_crossings = false;
  if (options.crossings && !mostly_twice) {
    Crossings found = self_crossings(good);
    d.crossings = std::move(found.pairs);
    d.all_crossings = found.all;
  }
  return d;
}

int Diagnosis::open_edges() const {
  int sum = 0;
  for (const Shell& shell : shells.list) sum += shell.open_edges;
  return sum;
}

bool Diagnosis::is_body() const {
  return !shells.list.empty() && not_finite.empty() && degenerate.empty() && duplicate_triangles.empty() &&
         crowded_edges.empty() && pinched_vertices.empty() && turned_edges.empty() && holes.empty() && inward.empty() &&
         crossings.empty() && all_crossings;
}

bool Diagnosis::encloses() const { return std::fabs(volume) > kNoInside * area * diagonal(box); }

}  // namespace trocar::geometry
