#include <algorithm>
#include <cmath>

#include <trocar/geometry/repair/oriented.hpp>
#include <trocar/geometry/repair/parted.hpp>
#include <trocar/geometry/repair/shells.hpp>

namespace trocar::geometry {
namespace {

bool runs_along(const std::array<int, 3>& t, int from, int to) {
  const int k = corner_of(t, from);
  return t[(k + 1) % 3] == to;
}

/// From every shell's first triangle on over edges with two triangles.
class Flood {
 public:
  Flood(const TriMesh& mesh, const EdgeTable& edges) : m_mesh(mesh), m_edges(edges) {
    turned.assign(mesh.triangles.size(), false);
    m_reached.assign(mesh.triangles.size(), false);
    for (int t = 0; t < int(mesh.triangles.size()); ++t)
      if (!m_reached[t]) from(t);
    std::sort(torn.begin(), torn.end());
    torn.erase(std::unique(torn.begin(), torn.end()), torn.end());
  }
  std::vector<bool> turned;              ///< triangles that face the other way than their shell's first one
  std::vector<std::array<int, 2>> torn;  ///< edges whose triangles cannot agree

 private:
  const TriMesh& m_mesh;
  const EdgeTable& m_edges;
  std::vector<bool> m_reached;
  std::vector<int> m_waiting;

  void from(int first) {
    m_reached[first] = true;
    m_waiting.assign(1, first);
    for (std::size_t i = 0; i < m_waiting.size(); ++i)
      for (int k = 0; k < 3; ++k) look_across(m_waiting[i], k);
  }

  void look_across(int t, int k) {
    const int other = m_edges.across(t, k);
    if (other < 0) return;
    const int a = m_mesh.triangles[t][k], b = m_mesh.triangles[t][(k + 1) % 3];
    const bool turn = runs_along(m_mesh.triangles[other], a, b) != bool(turned[t]);
    if (!m_reached[other]) {
      m_reached[other] = true;
      turned[other] = turn;
      m_waiting.push_back(other);
    } else if (bool(turned[other]) != turn) {
      torn.push_back({std::min(a, b), std::max(a, b)});
    }
  }
};

/// Which shells, now consistent, shall be turned as a whole.
std::vector<bool> shells_to_turn(const TriMesh& before, const std::vector<bool>& flooded, const TriMesh& mesh) {
  const EdgeTable edges(mesh);
  const Shells shells = shells_of(mesh, edges, rims_of(mesh, edges));
  std::vector<double> turned_area(shells.list.size());
  std::vector<bool> any(shells.list.size()), turn(shells.list.size());
  for (int t = 0; t < int(flooded.size()); ++t)
    if (flooded[t] && shells.of[t] >= 0) {
      turned_area[shells.of[t]] += 0.5 * length(area_vector(before, t));
      any[shells.of[t]] = true;
    }
  for (std::size_t s = 0; s < turn.size(); ++s) {
    const Shell& shell = shells.list[s];
    if (shell.is_sheet())
      turn[s] = turned_area[s] > 0.5 * shell.area;
    else if (shell.open_edges > 0)
      turn[s] = any[s] && shell.volume < 0;
    else
      turn[s] = shell.volume < 0 && (any[s] || !shell.is_cavity);
  }
  return turn;
}

int differences(const TriMesh& a, const TriMesh& b) {
  int count = 0;
  for (std::size_t t = 0; t < a.triangles.size(); ++t) count += a.triangles[t] != b.triangles[t];
  return count;
}

void turn_over(std::array<int, 3>& t) { std::swap(t[1], t[2]); }

}  // namespace

Repaired oriented(const TriMesh& mesh) {
  Repaired out{mesh, {}, {}};
  TriMesh before = mesh;
  std::erase_if(before.triangles, [](const auto& t) { return corner_twice(t); });
  for (int round = 0; round < 4; ++round) {
    const EdgeTable edges(before);
    const Flood flood(before, edges);
    if (flood.torn.empty()) {
      out.mesh = before;
      for (std::size_t t = 0; t < flood.turned.size(); ++t)
        if (flood.turned[t]) turn_over(out.mesh.triangles[t]);
      const std::vector<bool> turn = shells_to_turn(before, flood.turned, out.mesh);
      const EdgeTable now(out.mesh);
      const Shells shells = shells_of(out.mesh, now, {});
      for (std::size_t t = 0; t < out.mesh.triangles.size(); ++t)
        if (turn[shells.of[t]]) turn_over(out.mesh.triangles[t]);
      break;
    }
    out.tell("oriented", int(flood.torn.size()), "edge parted, as the surface has one side only",
             "edges parted, as the surface has one side only");
    before = parted_along(before, flood.torn).mesh;
    out.mesh = before;
  }
  out.tell("oriented", differences(before, out.mesh), "triangle turned", "triangles turned");
  return out;
}

}  // namespace trocar::geometry
