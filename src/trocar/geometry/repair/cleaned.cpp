#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/geometry/repair/cleaned.hpp>
#include <trocar/geometry/repair/examine.hpp>
#include <trocar/geometry/tets/tet_faces.hpp>

namespace trocar::geometry {
namespace {

/// Leaves out vertices that are not `keep`; triangles name the others by their new numbers.
void keep_vertices(TriMesh& mesh, const std::vector<bool>& keep) {
  std::vector<int> number(mesh.positions.size(), -1);
  std::size_t kept = 0;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    if (keep[v]) {
      number[v] = int(kept);
      mesh.positions[kept++] = mesh.positions[v];
    }
  mesh.positions.resize(kept);
  for (auto& t : mesh.triangles)
    for (int& v : t) v = number[v];
}

std::vector<bool> vertices_in_use(const TriMesh& mesh) {
  std::vector<bool> used(mesh.positions.size());
  for (const auto& t : mesh.triangles)
    for (const int v : t) used[v] = true;
  return used;
}

/// Triangles name the first of each place; how many vertices that were others.
int take_same(TriMesh& mesh, const std::vector<int>& same) {
  std::vector<bool> keep(same.size());
  int count = 0;
  for (int v = 0; v < int(same.size()); ++v) {
    keep[v] = same[v] == v;
    count += !keep[v];
  }
  for (auto& t : mesh.triangles)
    for (int& v : t) v = same[v];
  std::erase_if(mesh.triangles, corner_twice);
  keep_vertices(mesh, keep);
  return count;
}

bool same_way(std::array<int, 3> a, const std::array<int, 3>& b) {
  for (int turn = 0; turn < 3; ++turn) {
    if (a == b) return true;
    std::rotate(a.begin(), a.begin() + 1, a.end());
  }
  return false;
}

/// Groups of triangles with the same corners, each in the order of triangles.
std::vector<std::vector<int>> same_corners(const TriMesh& mesh) {
  std::vector<std::pair<std::array<int, 3>, int>> sorted;
  for (int t = 0; t < int(mesh.triangles.size()); ++t) {
    sorted.push_back({mesh.triangles[t], t});
    std::sort(sorted.back().first.begin(), sorted.back().first.end());
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::vector<int>> groups;
  for (std::size_t first = 0, last = 0; first < sorted.size(); first = last) {
    while (last < sorted.size() && sorted[last].first == sorted[first].first) ++last;
    if (last - first == 1) continue;
    groups.emplace_back();
    for (std::size_t i = first; i < last; ++i) groups.back().push_back(sorted[i].second);
  }
  return groups;
}

void drop_triangles(TriMesh& mesh, const std::vector<bool>& drop) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (!drop[t]) mesh.triangles[kept++] = mesh.triangles[t];
  mesh.triangles.resize(kept);
}

}  // namespace

void Repaired::tell(const char* remedy, int count, const char* one, const char* many) {
  if (count > 0) changes.push_back({remedy, count, fmt::format("{} {}", count, count == 1 ? one : many)});
}

Repaired without_broken(const TriMesh& mesh) {
  Repaired out{mesh, {}, {}};
  std::vector<bool> good(mesh.positions.size());
  int bad = 0;
  for (std::size_t v = 0; v < good.size(); ++v) {
    good[v] = is_place(mesh.positions[v]);
    bad += !good[v];
  }
  if (bad == 0) return out;
  const std::size_t dropped = std::erase_if(
      out.mesh.triangles, [&](const std::array<int, 3>& t) { return !good[t[0]] || !good[t[1]] || !good[t[2]]; });
  keep_vertices(out.mesh, good);
  out.tell("without_broken", bad, "vertex with a coordinate that is not a number removed",
           "vertices with coordinates that are not numbers removed");
  out.tell("without_broken", int(dropped), "triangle with it removed", "triangles with them removed");
  return out;
}

Repaired welded(const TriMesh& mesh, double distance) {
  Repaired out{mesh, {}, {}};
  const int count = take_same(out.mesh, same_nodes(mesh.positions, vertices_in_use(mesh), distance));
  out.tell("welded", count, "vertex welded", "vertices welded");
  out.tell("welded", int(mesh.triangles.size() - out.mesh.triangles.size()), "triangle without area removed",
           "triangles without area removed");
  return out;
}

Repaired with_borders_welded(const TriMesh& mesh, double distance) {
  Repaired out{mesh, {}, {}};
  constexpr double share = 0.2;
  std::vector<double> reach(mesh.positions.size(), -1);
  const EdgeTable edges(mesh);
  for (const Rim& rim : rims_of(mesh, edges))
    for (std::size_t i = 0; i < rim.vertices.size(); ++i) {
      const int a = rim.vertices[i], b = rim.vertices[(i + 1) % rim.vertices.size()];
      const double most = std::min(distance, share * length(mesh.positions[a] - mesh.positions[b]));
      for (const int v : {a, b}) reach[v] = reach[v] < 0 ? most : std::min(reach[v], most);
    }
  std::vector<bool> on_border(reach.size());
  for (std::size_t v = 0; v < reach.size(); ++v) on_border[v] = reach[v] >= 0;
  std::vector<int> same = same_nodes(mesh.positions, on_border, distance);
  for (int v = 0; v < int(same.size()); ++v)
    if (same[v] != v && length(mesh.positions[v] - mesh.positions[same[v]]) > std::min(reach[v], reach[same[v]]))
      same[v] = v;
  const int count = take_same(out.mesh, same);
  out.tell("with_borders_welded", count, "vertex of a border welded", "vertices of borders welded");
  return out;
}

Repaired without_duplicates(const TriMesh& mesh) {
  Repaired out{mesh, {}, {}};
  const std::vector<std::vector<int>> groups = same_corners(mesh);
  for (const bool cancel : {true, false}) {
    std::vector<bool> drop(mesh.triangles.size());
    for (const auto& group : groups) {
      const auto& first = mesh.triangles[group[0]];
      const auto same = [&](int t) { return same_way(mesh.triangles[t], first); };
      const int along = int(std::count_if(group.begin(), group.end(), same)), against = int(group.size()) - along;
      for (const int t : group) drop[t] = true;
      if (cancel && along == against) continue;
      const bool keep_along = along >= against;
      drop[*std::find_if(group.begin(), group.end(), [&](int t) { return same(t) == keep_along; })] = false;
    }
    out.mesh.triangles = mesh.triangles;
    drop_triangles(out.mesh, drop);
    if (!out.mesh.triangles.empty()) break;
  }
  out.tell("without_duplicates", int(mesh.triangles.size() - out.mesh.triangles.size()), "duplicate triangle removed",
           "duplicate triangles removed");
  return out;
}

Repaired without_unused(const TriMesh& mesh) {
  Repaired out{mesh, {}, {}};
  keep_vertices(out.mesh, vertices_in_use(mesh));
  out.tell("without_unused", int(mesh.positions.size() - out.mesh.positions.size()), "vertex without triangles removed",
           "vertices without triangles removed");
  return out;
}

Repaired without_small_shells(const TriMesh& mesh, double share, bool open_only) {
  Repaired out{mesh, {}, {}};
  const EdgeTable edges(mesh);
  const Shells shells = shells_of(mesh, edges, rims_of(mesh, edges));
  double largest = 0;
  for (const Shell& shell : shells.list) largest = std::max(largest, shell.area);
  const auto small = [&](const Shell& shell) {
    return shell.area < share * largest && !(open_only && shell.open_edges == 0);
  };
  std::vector<bool> drop(mesh.triangles.size());
  for (std::size_t t = 0; t < drop.size(); ++t) drop[t] = shells.of[t] >= 0 && small(shells.list[shells.of[t]]);
  drop_triangles(out.mesh, drop);
  out.tell("without_small_shells", int(std::count_if(shells.list.begin(), shells.list.end(), small)),
           "small shell removed", "small shells removed");
  out.mesh = without_unused(out.mesh).mesh;
  return out;
}

}  // namespace trocar::geometry
