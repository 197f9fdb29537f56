#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include <trocar/geometry/remesh/editable.hpp>
#include <trocar/geometry/remesh/remeshed.hpp>
#include <trocar/geometry/surfaces/triangle_tree.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::geometry {
namespace {

constexpr double kLongEdge = 4.0 / 3, kShortEdge = 4.0 / 5;  ///< of the wanted length [Botsch & Kobbelt 2004]
constexpr double kLeastTurnKept = 0.5;                       ///< cosine between a triangle before and after a change
constexpr int kHalvings = 3;  ///< of the wanted length: up to there a mesh that is far too fine is coarsened first

constexpr const char* kTooFine = "longer edges expected: the surface would have too many triangles";

class Remeshing {
 public:
  Remeshing(const TriMesh& mesh, double edge, const RemeshOptions& options)
      : m_given(mesh),
        m_tree(mesh),
        m_work(mesh),
        m_edge(edge),
        m_most(options.most_triangles),
        m_sharp(portable::cos(options.sharp_deg * portable::pi / 180)) {}

  void round() {
    split_long();
    collapse_short(kShortEdge * m_edge);
    flip_edges();
    relax();
  }
  /// A mesh that is far too fine is coarsened in steps first, so that no needle is split along its whole length, and no
  /// vertex takes hundreds of others at once.
  void coarsen() {
    if (!is_far_too_fine()) return;
    m_may_be_long = true;
    for (int halvings = 12; halvings >= kHalvings; --halvings) {
      collapse_short(std::ldexp(m_edge, -halvings));
      if (halvings % 2 == 0) flip_edges();
    }
    m_may_be_long = false;
  }
  TriMesh taken() const { return m_work.taken(); }
  double off(Vec3d p) const { return std::sqrt(m_tree.distance2(p)); }

 private:
  const TriMesh& m_given;
  TriangleTree m_tree;
  EditableMesh m_work;
  double m_edge;
  int m_most;
  double m_sharp;
  std::vector<int> m_ring;
  std::vector<char> m_border;  ///< of vertices, while edges are flipped

  bool m_may_be_long = false;  ///< may edges become longer than they should be?

  /// Is every tenth edge shorter than 1/32 of what is wanted?
  bool is_far_too_fine() const {
    std::int64_t all = 0, tiny = 0;
    for (int f = 0; f < m_work.faces(); ++f)
      for (int k = 0; k < 3; ++k, ++all)
        tiny += edge_length(m_work.face(f)[k], m_work.face(f)[(k + 1) % 3]) < m_edge / 32;
    return 10 * tiny > all;
  }

  double edge_length(int a, int b) const { return length(m_work.place(a) - m_work.place(b)); }

  /// Borders, and edges at which the surface turns sharply.
  bool is_kept(int a, int b) const {
    const EditableMesh::Sides at = m_work.sides(a, b);
    if (at.count != 2) return true;
    const Vec3d n = m_work.area_vector(at.face[0]), m = m_work.area_vector(at.face[1]);
    return dot(n, m) < m_sharp * length(n) * length(m);
  }
  int kept_at(int v) {
    m_work.neighbours(v, m_ring);
    const std::vector<int> ring = m_ring;
    return int(std::count_if(ring.begin(), ring.end(), [&](int w) { return is_kept(v, w); }));
  }

  /// The longest first: what is left over has no needles.
  void split_long() {
    struct Long {
      double length;
      int a, b;
    };
    for (std::vector<Long> found(1); !found.empty();) {
      found.clear();
      for (int f = 0; f < m_work.faces(); ++f)
        for (int k = 0; m_work.alive(f) && k < 3; ++k) {
          const int a = m_work.face(f)[k], b = m_work.face(f)[(k + 1) % 3];
          const bool once = a < b || m_work.sides(a, b).count == 1;
          if (once && edge_length(a, b) > kLongEdge * m_edge) found.push_back({edge_length(a, b), a, b});
        }
      std::stable_sort(found.begin(), found.end(), [](const Long& x, const Long& y) { return x.length > y.length; });
      for (const auto& [size, a, b] : found) {
        m_work.split(a, b, 0.5 * (m_work.place(a) + m_work.place(b)));
        if (m_work.living_faces() > m_most) throw std::invalid_argument(kTooFine);
      }
    }
  }

  void collapse_short(double shorter) {
    for (int f = 0; f < m_work.faces(); ++f)
      for (int k = 0; m_work.alive(f) && k < 3; ++k) {
        const int a = m_work.face(f)[k], b = m_work.face(f)[(k + 1) % 3];
        if (edge_length(a, b) >= shorter) continue;
        if (collapsed(a, b)) break;
      }
  }

  /// Into the middle; where one end lies on a kept edge, into that.
  bool collapsed(int a, int b) {
    const int kept_a = kept_at(a), kept_b = kept_at(b);
    const bool kept = is_kept(a, b);
    if (kept_a > 0 && kept_b > 0 && !kept) return false;  // across from one kept edge to another
    const bool a_stays = kept_a > 0 && (kept_b == 0 || kept_a != 2),
               b_stays = kept_b > 0 && (kept_a == 0 || kept_b != 2);
    if (a_stays && b_stays) return false;
    const int from = a_stays ? b : a, into = a_stays ? a : b;
    const bool to_middle = !a_stays && !b_stays && !(kept_a > 0);
    const Vec3d place = to_middle ? 0.5 * (m_work.place(a) + m_work.place(b)) : m_work.place(into);
    if (!m_work.can_collapse(from, into)) return false;
    if (!may_move(from, into, place) || !may_move(into, from, place)) return false;
    for (const int v : {from, into}) {
      if (m_may_be_long) break;
      m_work.neighbours(v, m_ring);
      for (const int w : m_ring)
        if (length(m_work.place(w) - place) > kLongEdge * m_edge) return false;
    }
    m_work.collapse(from, into);
    m_work.move(into, place);
    return true;
  }

  /// Does no triangle of v turn over if v goes there? Those at `other` as well do not count.
  bool may_move(int v, int other, Vec3d to) const {
    for (const int f : m_work.faces_at(v)) {
      const auto& t = m_work.face(f);
      if (t[0] == other || t[1] == other || t[2] == other) continue;
      std::array<Vec3d, 3> p{m_work.place(t[0]), m_work.place(t[1]), m_work.place(t[2])};
      const Vec3d before = cross(p[1] - p[0], p[2] - p[0]);
      for (std::size_t k = 0; k < 3; ++k)
        if (t[k] == v) p[k] = to;
      const Vec3d after = cross(p[1] - p[0], p[2] - p[0]);
      if (!(dot(before, after) > kLeastTurnKept * length(before) * length(after))) return false;
    }
    return true;
  }

  /// Edges too many or too few: six are best, on a border four.
  int off_valence(int v, int change) const {
    const int own = int(m_work.faces_at(v).size()) + m_border[v] + change;
    const int off = own - (m_border[v] ? 4 : 6);
    return off * off;
  }

  void flip_edges() {
    m_border.resize(m_work.vertices());  // flips change no border
    for (int v = 0; v < m_work.vertices(); ++v) m_border[v] = m_work.on_border(v);
    for (int f = 0; f < m_work.faces(); ++f)
      for (int k = 0; m_work.alive(f) && k < 3; ++k) {
        const int a = m_work.face(f)[k], b = m_work.face(f)[(k + 1) % 3];
        const EditableMesh::Sides at = m_work.sides(a, b);
        if (a > b || at.count != 2) continue;
        const int c = m_work.opposite(at.face[0], a, b), d = m_work.opposite(at.face[1], a, b);
        const int before = off_valence(a, 0) + off_valence(b, 0) + off_valence(c, 0) + off_valence(d, 0);
        const int after = off_valence(a, -1) + off_valence(b, -1) + off_valence(c, 1) + off_valence(d, 1);
        if (after >= before || is_kept(a, b) || !m_work.can_flip(a, b)) continue;
        const Vec3d n = m_work.area_vector(at.face[0]) + m_work.area_vector(at.face[1]);
        m_work.flip(a, b);
        if (!faces_along(at.face[0], n) || !faces_along(at.face[1], n)) m_work.flip(c, d);
      }
  }
  bool faces_along(int f, Vec3d n) const {
    const Vec3d own = m_work.area_vector(f);
    return dot(own, n) > 0.8 * length(own) * length(n);
  }

  void relax() {
    std::vector<Vec3d> wanted(m_work.vertices());
    std::vector<bool> moves(m_work.vertices());
    for (int v = 0; v < m_work.vertices(); ++v) {
      if (m_work.faces_at(v).empty()) continue;
      const int kept = kept_at(v);
      if (kept != 0) continue;
      moves[v] = true;
      wanted[v] = on_surface(v, middle_of_faces(v));
    }
    for (int v = 0; v < m_work.vertices(); ++v)
      if (moves[v] && may_move(v, -1, wanted[v])) m_work.move(v, wanted[v]);
  }

  /// The middle of the triangles around, each by its area, in the plane that touches the surface in v.
  Vec3d middle_of_faces(int v) const {
    Vec3d normal{}, sum{};
    double weight = 0;
    for (const int f : m_work.faces_at(v)) {
      const auto& [a, b, c] = m_work.face(f);
      const Vec3d twice = m_work.area_vector(f);
      const double own = length(twice);
      normal += twice;
      sum += own / 3 * (m_work.place(a) + m_work.place(b) + m_work.place(c));
      weight += own;
    }
    const Vec3d place = m_work.place(v);
    if (!(weight > 0)) return place;
    const Vec3d n = normalised(normal, Vec3d{}), way = sum / weight - place;
    return place + way - dot(way, n) * n;
  }

  /// The nearest place of the surface that was given, if it faces the same way: not that on the other side of a wall.
  Vec3d on_surface(int v, Vec3d p) const {
    const NearestTriangle near = m_tree.nearest(p);
    Vec3d normal{};
    for (const int f : m_work.faces_at(v)) normal += m_work.area_vector(f);
    return dot(geometry::area_vector(m_given, near.triangle), normal) > 0 ? near.point : p;
  }
};

double mean_edge_of(const TriMesh& mesh) {
  double sum = 0;
  const auto all = edges(mesh);
  for (const auto& [a, b] : all) sum += length(mesh.positions[a] - mesh.positions[b]);
  return all.empty() ? 0 : sum / double(all.size());
}

}  // namespace

Remeshed remeshed(const TriMesh& mesh, double edge, const RemeshOptions& options) {
  if (!(edge > 0)) throw std::invalid_argument("an edge longer than 0 expected");
  Remeshed out{mesh, 0, 0, volume(mesh), 0, 0};
  if (mesh.triangles.empty()) return out;
  if (area(mesh) / (0.433 * edge * edge) > options.most_triangles) throw std::invalid_argument(kTooFine);
  Remeshing work(mesh, edge, options);
  work.coarsen();
  for (int round = 0; round < options.rounds; ++round) work.round();
  out.mesh = work.taken();
  out.mean_edge = mean_edge_of(out.mesh);
  out.least_angle = 60;
  out.volume = volume(out.mesh);
  for (const Vec3d& p : out.mesh.positions) out.farthest = std::max(out.farthest, work.off(p));
  for (int t = 0; t < int(out.mesh.triangles.size()); ++t) {
    const auto& [a, b, c] = out.mesh.triangles[t];
    const Vec3d middle = (out.mesh.positions[a] + out.mesh.positions[b] + out.mesh.positions[c]) / 3.0;
    out.farthest = std::max(out.farthest, work.off(middle));
    out.least_angle = std::min(out.least_angle, least_angle_deg(out.mesh, t));
  }
  return out;
}

}  // namespace trocar::geometry
