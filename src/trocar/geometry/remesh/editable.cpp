#include <algorithm>

#include <trocar/geometry/remesh/editable.hpp>
#include <trocar/geometry/surfaces/edge_table.hpp>

namespace trocar::geometry {

EditableMesh::EditableMesh(const TriMesh& mesh) : m_places(mesh.positions), m_faces_at(mesh.positions.size()) {
  for (const auto& t : mesh.triangles)
    if (!corner_twice(t)) add_face(t);
}

TriMesh EditableMesh::taken() const {
  TriMesh out;
  std::vector<int> number(m_places.size(), -1);
  for (int v = 0; v < vertices(); ++v) {
    if (m_faces_at[v].empty()) continue;
    number[v] = int(out.positions.size());
    out.positions.push_back(m_places[v]);
  }
  for (int f = 0; f < faces(); ++f)
    if (m_alive[f]) out.triangles.push_back({number[m_faces[f][0]], number[m_faces[f][1]], number[m_faces[f][2]]});
  return out;
}

Vec3d EditableMesh::area_vector(int face) const {
  const auto& [a, b, c] = m_faces[face];
  return cross(m_places[b] - m_places[a], m_places[c] - m_places[a]);
}

EditableMesh::Sides EditableMesh::sides(int a, int b) const {
  Sides out;
  for (const int f : m_faces_at[a]) {
    const auto& t = m_faces[f];
    if (t[0] != b && t[1] != b && t[2] != b) continue;
    if (out.count < 2) out.face[std::size_t(out.count)] = f;
    ++out.count;
  }
  return out;
}

int EditableMesh::opposite(int face, int a, int b) const {
  for (const int v : m_faces[face])
    if (v != a && v != b) return v;
  return -1;
}

void EditableMesh::neighbours(int vertex, std::vector<int>& out) const {
  out.clear();
  for (const int f : m_faces_at[vertex])
    for (const int v : m_faces[f])
      if (v != vertex && std::find(out.begin(), out.end(), v) == out.end()) out.push_back(v);
}

bool EditableMesh::on_border(int vertex) const {
  for (const int f : m_faces_at[vertex])
    for (const int w : m_faces[f])
      if (w != vertex && sides(vertex, w).count != 2) return true;
  return false;
}

bool EditableMesh::can_collapse(int from, int into) const {
  const Sides at = sides(from, into);
  if (at.count < 1 || at.count > 2) return false;
  std::vector<int> ring, other;
  neighbours(from, ring);
  neighbours(into, other);
  int common = 0;
  for (const int v : ring) common += std::find(other.begin(), other.end(), v) != other.end();
  if (common != at.count) return false;
  if (at.count == 2 && on_border(from) && on_border(into)) return false;  // would join two borders in one vertex
  for (const int f : m_faces_at[from]) {  // a face of one that would lie on a face of the other
    const auto& t = m_faces[f];
    if (t[0] == into || t[1] == into || t[2] == into) continue;
    const int k = corner_of(t, from), a = t[(k + 1) % 3], b = t[(k + 2) % 3];
    for (const int g : m_faces_at[into]) {
      const auto& u = m_faces[g];
      const bool has_a = u[0] == a || u[1] == a || u[2] == a, has_b = u[0] == b || u[1] == b || u[2] == b;
      if (has_a && has_b) return false;
    }
  }
  return at.count == 1 || m_faces_at[into].size() + m_faces_at[from].size() > 6;  // three faces at least stay
}

void EditableMesh::collapse(int from, int into) {
  const std::vector<int> faces_of = m_faces_at[from];
  for (const int f : faces_of) {
    auto t = m_faces[f];
    if (t[0] == into || t[1] == into || t[2] == into) {
      kill(f);
      continue;
    }
    t[corner_of(t, from)] = into;
    set_face(f, t);
  }
}

int EditableMesh::split(int a, int b, Vec3d at) {
  const int middle = add_vertex(at);
  std::vector<int> here;
  for (const int f : m_faces_at[a]) {
    const auto& t = m_faces[f];
    if (t[0] == b || t[1] == b || t[2] == b) here.push_back(f);
  }
  for (const int f : here) {
    auto near_a = m_faces[f], near_b = m_faces[f];
    near_a[corner_of(near_a, b)] = middle;
    near_b[corner_of(near_b, a)] = middle;
    set_face(f, near_a);
    add_face(near_b);
  }
  return middle;
}

int EditableMesh::split_face(int face, Vec3d at) {
  const int middle = add_vertex(at);
  const auto [a, b, c] = m_faces[face];
  set_face(face, {a, b, middle});
  add_face({b, c, middle});
  add_face({c, a, middle});
  return middle;
}

bool EditableMesh::can_flip(int a, int b) const {
  const Sides at = sides(a, b);
  if (at.count != 2) return false;
  const auto &s = m_faces[at.face[0]], &t = m_faces[at.face[1]];
  const bool s_runs = s[(corner_of(s, a) + 1) % 3] == b, t_runs = t[(corner_of(t, a) + 1) % 3] == b;
  const int c = opposite(at.face[0], a, b), d = opposite(at.face[1], a, b);
  return s_runs != t_runs && c != d && sides(c, d).count == 0;
}

void EditableMesh::flip(int a, int b) {
  const Sides at = sides(a, b);
  const int c = opposite(at.face[0], a, b), d = opposite(at.face[1], a, b);
  auto s = m_faces[at.face[0]], t = m_faces[at.face[1]];
  s[corner_of(s, b)] = d;  // (a, b, c) and (b, a, d) become (a, d, c) and (b, c, d)
  t[corner_of(t, a)] = c;
  set_face(at.face[0], s);
  set_face(at.face[1], t);
}

void EditableMesh::kill(int face) {
  if (!m_alive[face]) return;
  m_alive[face] = false;
  --m_living;
  for (const int v : m_faces[face]) std::erase(m_faces_at[v], face);
}

int EditableMesh::add_face(const std::array<int, 3>& corners) {
  const int number = faces();
  m_faces.push_back(corners);
  m_alive.push_back(true);
  ++m_living;
  for (const int v : corners) m_faces_at[v].push_back(number);
  return number;
}

int EditableMesh::add_vertex(Vec3d place) {
  m_places.push_back(place);
  m_faces_at.emplace_back();
  return vertices() - 1;
}

void EditableMesh::set_face(int face, const std::array<int, 3>& corners) {
  for (const int v : m_faces[face]) std::erase(m_faces_at[v], face);
  m_faces[face] = corners;
  for (const int v : corners) m_faces_at[v].push_back(face);
}

}  // namespace trocar::geometry
