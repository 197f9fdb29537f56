#include <trocar/geometry/repair/rims.hpp>

namespace trocar::geometry {
namespace {

struct OpenSide {
  int triangle, side, to;  ///< the vertex in which it ends
};

class RimWalk {
 public:
  RimWalk(const TriMesh& mesh, const EdgeTable& edges)
      : m_mesh(mesh), m_edges(edges), m_done(mesh.triangles.size(), {false, false, false}) {}

  std::vector<Rim> all() {
    std::vector<Rim> rims;
    for (int t = 0; t < int(m_mesh.triangles.size()); ++t)
      for (int k = 0; k < 3; ++k)
        if (is_open(t, k) && !m_done[t][k]) rims.push_back(from({t, k, m_mesh.triangles[t][(k + 1) % 3]}));
    return rims;
  }

 private:
  const TriMesh& m_mesh;
  const EdgeTable& m_edges;
  std::vector<std::array<bool, 3>> m_done;

  bool is_open(int t, int k) const {
    return m_edges.across(t, k) == EdgeTable::kOpen && !corner_twice(m_mesh.triangles[t]);
  }

  Rim from(const OpenSide& first) {
    Rim rim;
    OpenSide now = first;
    do {
      m_done[now.triangle][now.side] = true;
      const auto& corners = m_mesh.triangles[now.triangle];
      const int start = corners[now.side] == now.to ? corners[(now.side + 1) % 3] : corners[now.side];
      rim.vertices.push_back(start);
      rim.triangles.push_back(now.triangle);
      rim.length += length(m_mesh.positions[now.to] - m_mesh.positions[start]);
      rim.is_loop = next(now);
    } while (rim.is_loop && !m_done[now.triangle][now.side]);
    return rim;
  }

  /// Around the vertex in which the side ends, through its triangles, to the next open side.
  bool next(OpenSide& at) const {
    int triangle = at.triangle, side = at.side;
    for (std::size_t guard = 0; guard <= m_mesh.triangles.size(); ++guard) {
      const auto& corners = m_mesh.triangles[triangle];
      const int corner = corner_of(corners, at.to);
      const int other = side == corner ? (corner + 2) % 3 : corner;  // the other side at this corner
      const int across = m_edges.across(triangle, other);
      if (across == EdgeTable::kOpen) {
        at = {triangle, other, corners[other] == at.to ? corners[(other + 1) % 3] : corners[other]};
        return true;
      }
      if (across < 0) return false;
      const int end = corners[other] == at.to ? corners[(other + 1) % 3] : corners[other];
      const auto& beyond = m_mesh.triangles[across];
      for (int k = 0; k < 3; ++k)
        if ((beyond[k] == at.to && beyond[(k + 1) % 3] == end) || (beyond[k] == end && beyond[(k + 1) % 3] == at.to))
          side = k;
      triangle = across;
    }
    return false;
  }
};

Vec3d middle_of(const TriMesh& mesh, const Rim& rim) {
  Vec3d sum{};
  for (const int v : rim.vertices) sum += mesh.positions[v];
  return sum / double(rim.vertices.size());
}

}  // namespace

std::vector<Rim> rims_of(const TriMesh& mesh, const EdgeTable& edges) { return RimWalk(mesh, edges).all(); }

double fan_six_volumes(const TriMesh& mesh, const Rim& rim, Vec3d origin) {
  const Vec3d middle = middle_of(mesh, rim) - origin;
  double sum = 0;
  for (std::size_t i = 0; i < rim.vertices.size(); ++i) {
    const Vec3d p = mesh.positions[rim.vertices[i]] - origin,
                q = mesh.positions[rim.vertices[(i + 1) % rim.vertices.size()]] - origin;
    sum += dot(middle, cross(q, p));
  }
  return sum;
}

double fan_twice_area(const TriMesh& mesh, const Rim& rim) {
  const Vec3d middle = middle_of(mesh, rim);
  double sum = 0;
  for (std::size_t i = 0; i < rim.vertices.size(); ++i)
    sum += length(cross(mesh.positions[rim.vertices[i]] - middle,
                        mesh.positions[rim.vertices[(i + 1) % rim.vertices.size()]] - middle));
  return sum;
}

}  // namespace trocar::geometry
