#include <algorithm>
#include <cmath>

#include <trocar/geometry/repair/crossing_cuts.hpp>
#include <trocar/geometry/surfaces/orientation.hpp>

namespace trocar::geometry {
namespace {

constexpr std::size_t kMostLines = 3000;      ///< in one triangle
constexpr std::size_t kMostTriples = 20'000;  ///< of one mesh

}  // namespace

bool CrossingCuts::find(const TriMesh& mesh, const std::vector<std::array<int, 2>>& pairs) {
  m_mesh = &mesh;
  m_places = mesh.positions;
  const bool good =
      std::all_of(pairs.begin(), pairs.end(), [&](const auto& pair) { return add_pair(pair[0], pair[1]); });
  if (!good) return false;
  for (auto& [edge, points] : m_edges) std::sort(points.begin(), points.end());
  for (const auto& [triangle, of] : m_triangles)
    if (!meet_in_threes(triangle)) return false;
  add_segments();
  return true;
}

/// Lines of one triangle that cross each other: there its two partners cross, too.
bool CrossingCuts::meet_in_threes(int triangle) {
  const std::vector<int>& lines = m_triangles[triangle].lines;
  if (lines.size() < 2) return true;
  if (lines.size() > kMostLines || m_triples.size() > kMostTriples) return false;
  const Vec3d n = area_vector(*m_mesh, triangle), size{std::fabs(n.x), std::fabs(n.y), std::fabs(n.z)};
  const int thin = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  const int u = (thin + 1) % 3, v = (thin + 2) % 3;
  const auto end = [&](int line, std::size_t k) {
    const Line& of = m_lines[line];
    return m_places[of.ends[of.triangles[0] == triangle ? 0 : 1][k]];
  };
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (std::size_t j = i + 1; j < lines.size(); ++j) {
      const Vec3d a = end(lines[i], 0), b = end(lines[i], 1), c = end(lines[j], 0), d = end(lines[j], 1);
      if (a == c || a == d || b == c || b == d) continue;
      if (side_of_line(a, b, c, u, v) * side_of_line(a, b, d, u, v) < 0 &&
          side_of_line(c, d, a, u, v) * side_of_line(c, d, b, u, v) < 0)
        add_triple(lines[i], lines[j]);
    }
  return true;
}

/// The point in which two lines of one triangle cross, once for all three triangles that meet there.
void CrossingCuts::add_triple(int line, int other) {
  std::array<int, 4> all{m_lines[line].triangles[0], m_lines[line].triangles[1], m_lines[other].triangles[0],
                         m_lines[other].triangles[1]};
  std::sort(all.begin(), all.end());
  const auto end = std::unique(all.begin(), all.end());
  if (end - all.begin() != 3) return;
  const auto [at, fresh] = m_triples.try_emplace({all[0], all[1], all[2]}, int(m_places.size()));
  if (!fresh) return;
  const auto place = [&](int of, std::size_t k) { return m_places[m_lines[of].ends[0][k]]; };
  const Vec3d a = place(line, 0), b = place(line, 1), c = place(other, 0), d = place(other, 1);
  const Vec3d across = cross(b - a, d - c);
  const double along = dot(cross(c - a, d - c), across) / dot(across, across);
  m_places.push_back(a + along * (b - a));
  const Vec3d point = m_places.back();
  for (const int t : {all[0], all[1], all[2]}) m_triangles[t].within.push_back(at->second);
  for (const auto& pair : {std::array{all[0], all[1]}, {all[0], all[2]}, {all[1], all[2]}})
    if (const auto found = m_line_of.find(pair); found != m_line_of.end())
      m_lines[found->second].within.push_back({length(point - place(found->second, 0)), at->second});
}

void CrossingCuts::add_segments() {
  for (Line& line : m_lines) {
    std::sort(line.within.begin(), line.within.end());
    for (std::size_t side = 0; side < 2; ++side) {
      std::vector<int> chain{line.ends[side][0]};
      for (const auto& [along, point] : line.within) chain.push_back(point);
      chain.push_back(line.ends[side][1]);
      for (std::size_t k = 0; k + 1 < chain.size(); ++k)
        m_triangles[line.triangles[side]].segments.push_back({chain[k], chain[k + 1]});
    }
  }
}

std::vector<int> CrossingCuts::on_edge(int low, int high) const {
  std::vector<int> out;
  const auto found = m_edges.find({low, high});
  if (found == m_edges.end()) return out;
  for (const auto& [along, point] : found->second) out.push_back(point);
  return out;
}

/// Does the edge go through the inside of the triangle?
CrossingCuts::Meets CrossingCuts::meets(int low, int high, int triangle) const {
  const auto& [a, b, c] = m_mesh->triangles[triangle];
  const Vec3d p = m_places[low], q = m_places[high], u = m_places[a], v = m_places[b], w = m_places[c];
  const int from = side_of_plane(u, v, w, p), to = side_of_plane(u, v, w, q);
  if (from * to > 0) return Meets::no;
  const int x = side_of_plane(p, q, u, v), y = side_of_plane(p, q, v, w), z = side_of_plane(p, q, w, u);
  const bool around = (x >= 0 && y >= 0 && z >= 0) || (x <= 0 && y <= 0 && z <= 0);
  if (from * to == 0) return from == 0 && to == 0 ? Meets::touches : (around ? Meets::touches : Meets::no);
  if (!around) return Meets::no;
  return x != 0 && y != 0 && z != 0 ? Meets::yes : Meets::touches;
}

int CrossingCuts::point(int low, int high, int triangle) {
  const auto [at, fresh] = m_points.try_emplace({low, high, triangle}, int(m_places.size()));
  if (!fresh) return at->second;
  const Vec3d p = m_places[low], q = m_places[high], corner = m_places[m_mesh->triangles[triangle][0]];
  const Vec3d n = area_vector(*m_mesh, triangle);
  const double from = dot(n, p - corner), to = dot(n, q - corner);
  const double along = std::clamp(from / (from - to), 0.0, 1.0);
  m_places.push_back(along < 0.5 ? p + along * (q - p) : q + (1 - along) * (p - q));
  m_edges[{low, high}].push_back({along, at->second});
  m_triangles[triangle].within.push_back(at->second);
  return at->second;
}

/// The point in which a side of s goes through t, if it does; false where it only touches.
bool CrossingCuts::pierce(int s, int side, int t, std::vector<int>& points) {
  const int a = m_mesh->triangles[s][side], b = m_mesh->triangles[s][(side + 1) % 3];
  const int low = std::min(a, b), high = std::max(a, b);
  const Meets how = meets(low, high, t);
  if (how == Meets::yes) points.push_back(point(low, high, t));
  return how != Meets::touches;
}

bool CrossingCuts::add_pair(int s, int t) {
  const auto &of_s = m_mesh->triangles[s], &of_t = m_mesh->triangles[t];
  std::vector<std::array<int, 2>> shared;  // corners at the same place
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (m_places[of_s[i]] == m_places[of_t[j]]) shared.push_back({i, j});
  std::vector<int> points;
  if (shared.size() > 1) return false;
  const int only_s = shared.empty() ? -1 : (shared[0][0] + 1) % 3,
            only_t = shared.empty() ? -1 : (shared[0][1] + 1) % 3;
  for (int k = 0; k < 3; ++k)
    if ((only_s < 0 || k == only_s) && !pierce(s, k, t, points)) return false;
  for (int k = 0; k < 3; ++k)
    if ((only_t < 0 || k == only_t) && !pierce(t, k, s, points)) return false;
  if (points.size() != (shared.empty() ? 2u : 1u)) return false;
  const int end_s = shared.empty() ? points[1] : of_s[shared[0][0]],
            end_t = shared.empty() ? points[1] : of_t[shared[0][1]];
  for (const int triangle : {s, t}) m_triangles[triangle].lines.push_back(int(m_lines.size()));
  m_line_of[{std::min(s, t), std::max(s, t)}] = int(m_lines.size());
  m_lines.push_back({{s, t}, {{{points[0], end_s}, {points[0], end_t}}}, {}});
  return true;
}

}  // namespace trocar::geometry
