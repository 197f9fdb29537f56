#include <algorithm>

#include <trocar/tissue/tets/cuttable_skin.hpp>

namespace trocar::tissue {
namespace {

void list_triangles(const CuttableModel& m, const CuttableState& s, CuttableSkin& out) noexcept {
  Skin& skin = out.skin;
  skin.triangles.clear();
  out.inner.clear();
  for (std::size_t c = 0; c < s.tets.cells.size(); ++c)
    for (std::size_t f = 0; f < 4; ++f) {
      if (s.tets.across[c][f] >= 0) continue;
      const geometry::Tet& cell = s.tets.cells[c];
      const auto corner = [&](int k) { return cell[std::size_t(kFaceCorners[f][k])]; };
      skin.triangles.push_back({corner(0), corner(1), corner(2)});
      out.inner.push_back(m.drawn.across[c][f] >= 0);
    }
}

/// Which triangles are at each vertex, ascending: counted, then filled in.
void list_faces(Skin& skin) noexcept {
  const std::size_t m = skin.weights.size();
  std::fill(skin.face_first.begin(), skin.face_first.end(), 0);
  for (const auto& t : skin.triangles)
    for (const int v : t) ++skin.face_first[std::size_t(v) + 1];
  for (std::size_t v = 0; v < m; ++v) skin.face_first[v + 1] += skin.face_first[v];
  skin.face.resize(3 * skin.triangles.size());
  for (std::size_t t = 0; t < skin.triangles.size(); ++t)
    for (const int v : skin.triangles[t]) skin.face[std::size_t(skin.face_first[std::size_t(v)]++)] = int(t);
  for (std::size_t v = m; v > 0; --v) skin.face_first[v] = skin.face_first[v - 1];
  skin.face_first[0] = 0;
}

/// The other corners of a vertex's triangles, each once, ascending.
void list_neighbours(Skin& skin) noexcept {
  skin.neighbour.clear();
  for (std::size_t v = 0; v < skin.weights.size(); ++v) {
    const auto first = std::ptrdiff_t(skin.neighbour.size());
    skin.neighbour_first[v] = int(first);
    for (int k = skin.face_first[v]; k < skin.face_first[v + 1]; ++k)
      for (const int other : skin.triangles[std::size_t(skin.face[std::size_t(k)])]) {
        if (other == int(v)) continue;
        if (std::find(skin.neighbour.begin() + first, skin.neighbour.end(), other) == skin.neighbour.end())
          skin.neighbour.push_back(other);
      }
    std::sort(skin.neighbour.begin() + first, skin.neighbour.end());
  }
  skin.neighbour_first.back() = int(skin.neighbour.size());
}

}  // namespace

CuttableSkin make_skin(const CuttableModel& m) {
  CuttableSkin out;
  Skin& skin = out.skin;
  const std::size_t nodes = m.drawn.rest.size(), most = 4 * m.drawn.cells.size();
  for (std::size_t i = 0; i < nodes; ++i) {
    skin.weights.push_back(SkinWeights::at(int(i), m.row_of_node[i]));
    skin.rest.push_back(vec_cast<float>(m.drawn.rest[i]));
  }
  skin.rest_normal.assign(nodes, Vec3f{0, 0, 1});
  skin.triangles.reserve(most);
  out.inner.reserve(most);
  skin.face.reserve(3 * most);
  skin.neighbour.reserve(6 * most);
  skin.face_first.resize(nodes + 1);
  skin.neighbour_first.resize(nodes + 1);
  update(m, rest_state(m), out);
  std::vector<Vec3d> normal(nodes, Vec3d{});
  for (const auto& t : skin.triangles) {
    const auto x = [&](std::size_t k) { return m.drawn.rest[std::size_t(t[k])]; };
    const Vec3d n = cross(x(1) - x(0), x(2) - x(0));
    for (const int v : t) normal[std::size_t(v)] += n;
  }
  for (std::size_t i = 0; i < nodes; ++i) skin.rest_normal[i] = vec_cast<float>(normalised(normal[i], Vec3d{0, 0, 1}));
  return out;
}

void update(const CuttableModel& m, const CuttableState& s, CuttableSkin& out) noexcept {
  if (out.made_for == s.version) return;
  list_triangles(m, s, out);
  list_faces(out.skin);
  list_neighbours(out.skin);
  out.made_for = s.version;
}

}  // namespace trocar::tissue
