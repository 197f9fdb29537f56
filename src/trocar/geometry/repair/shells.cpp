#include <algorithm>
#include <cmath>

#include <trocar/geometry/repair/shells.hpp>
#include <trocar/geometry/surfaces/groups.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::geometry {
namespace {

void enclose(Bounds& box, Vec3d p) {
  for (int k = 0; k < 3; ++k) {
    box.low[k] = std::min(box.low[k], p[k]);
    box.high[k] = std::max(box.high[k], p[k]);
  }
}

/// Of a triangle as seen from the origin.
double solid_angle(Vec3d a, Vec3d b, Vec3d c) {
  const double la = length(a), lb = length(b), lc = length(c);
  return 2 * portable::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

bool is_within(Vec3d p, const Bounds& box) {
  for (int k = 0; k < 3; ++k)
    if (!(p[k] >= box.low[k] && p[k] <= box.high[k])) return false;
  return true;
}

void number_shells(const TriMesh& mesh, const EdgeTable& edges, Shells& shells) {
  Groups groups(mesh.triangles.size());
  edges.for_each([&](std::span<const EdgeUse> uses) {
    for (const EdgeUse& use : uses) groups.join(uses[0].triangle, use.triangle);
  });
  shells.of.assign(mesh.triangles.size(), -1);
  for (int t = 0; t < int(mesh.triangles.size()); ++t) {
    if (corner_twice(mesh.triangles[t])) continue;
    const int root = groups.root(t);
    if (root == t) {
      shells.of[t] = int(shells.list.size());
      shells.list.emplace_back();
      shells.list.back().first = t;
      shells.list.back().box = bounds({});
    }
    shells.of[t] = shells.of[root];
  }
}

/// Some places of a shell, spread over its triangles: near an open end another shell does not quite go around it.
std::vector<Vec3d> places_on(const TriMesh& mesh, const Shells& shells, int shell) {
  constexpr int some = 5;
  std::vector<Vec3d> out;
  const int every = std::max(1, shells.list[shell].triangles / some);
  int seen = 0;
  for (int t = shells.list[shell].first; t < int(mesh.triangles.size()); ++t)
    if (shells.of[t] == shell && seen++ % every == 0) out.push_back(mesh.positions[mesh.triangles[t][0]]);
  return out;
}

/// Shells that face inwards within another one are cavities; beyond a bound of work all that face inwards are.
void find_cavities(const TriMesh& mesh, Shells& shells) {
  double work = 0;
  constexpr double most = 1e8;  // solid angles: some seconds
  std::vector<int> bodies;      // what may go around others
  for (int s = 0; s < int(shells.list.size()); ++s)
    if (shells.list[s].volume > 0 && !shells.list[s].is_sheet()) bodies.push_back(s);
  for (int s = 0; s < int(shells.list.size()); ++s) {
    Shell& shell = shells.list[s];
    if (!(shell.volume < 0) || shell.turned_edges > 0 || (shell.open_edges > 0 && shell.is_sheet())) continue;
    shell.is_cavity = work > most && !bodies.empty();
    if (work > most) continue;
    const Vec3d place = mesh.positions[mesh.triangles[shell.first][0]];
    bool surrounded = false, by_open = false;
    for (const int b : bodies) {
      if (!is_within(place, shells.list[b].box)) continue;
      surrounded = true;
      by_open = by_open || !shells.list[b].closed();
    }
    work += double(bodies.size());
    if (!surrounded) continue;
    std::vector<Vec3d> places{place};
    if (by_open) places = places_on(mesh, shells, s);
    work += double(places.size()) * double(mesh.triangles.size());
    shell.is_cavity =
        std::any_of(places.begin(), places.end(), [&](Vec3d p) { return turns_around(mesh, shells, p, s) > 0.7; });
  }
}

}  // namespace

bool Shell::is_sheet() const {
  constexpr double roundness = 1e-4;  // of the square of the volume, against that of a ball with this area
  const double ball = area * area * area / (36 * portable::pi);
  return !(volume * volume > roundness * ball);
}

Shells shells_of(const TriMesh& mesh, const EdgeTable& edges, const std::vector<Rim>& rims) {
  Shells shells;
  number_shells(mesh, edges, shells);
  for (int t = 0; t < int(mesh.triangles.size()); ++t) {
    if (shells.of[t] < 0) continue;
    Shell& shell = shells.list[shells.of[t]];
    const auto& corners = mesh.triangles[t];
    const Vec3d origin = mesh.positions[mesh.triangles[shell.first][0]], twice = area_vector(mesh, t);
    ++shell.triangles;
    shell.area += 0.5 * length(twice);
    shell.volume += dot(twice, mesh.positions[corners[0]] - origin) / 6;
    for (const int v : corners) enclose(shell.box, mesh.positions[v]);
  }
  edges.for_each([&](std::span<const EdgeUse> uses) {
    Shell& shell = shells.list[shells.of[uses[0].triangle]];
    shell.open_edges += uses.size() == 1;
    shell.crowded_edges += uses.size() > 2;
    shell.turned_edges += uses.size() == 2 && uses[0].upwards == uses[1].upwards;
  });
  for (const Rim& rim : rims) {
    Shell& shell = shells.list[shells.of[rim.triangles[0]]];
    shell.volume += fan_six_volumes(mesh, rim, mesh.positions[mesh.triangles[shell.first][0]]) / 6;
    shell.caps += fan_twice_area(mesh, rim) / 2;
  }
  find_cavities(mesh, shells);
  return shells;
}

double turns_around(const TriMesh& mesh, const Shells& shells, Vec3d place, int except) {
  double sum = 0;
  for (int t = 0; t < int(mesh.triangles.size()); ++t) {
    if (shells.of[t] < 0 || shells.of[t] == except) continue;
    const auto& [a, b, c] = mesh.triangles[t];
    sum += solid_angle(mesh.positions[a] - place, mesh.positions[b] - place, mesh.positions[c] - place);
  }
  return sum / (4 * portable::pi);
}

double turns_without(const TriMesh& mesh, int triangle, Vec3d place) {
  double sum = 0;
  for (int t = 0; t < int(mesh.triangles.size()); ++t) {
    if (t == triangle) continue;
    const auto& [a, b, c] = mesh.triangles[t];
    sum += solid_angle(mesh.positions[a] - place, mesh.positions[b] - place, mesh.positions[c] - place);
  }
  return sum / (4 * portable::pi);
}

}  // namespace trocar::geometry
