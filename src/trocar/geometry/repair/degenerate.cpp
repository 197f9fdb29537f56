#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/remesh/editable.hpp>
#include <trocar/geometry/repair/degenerate.hpp>
#include <trocar/geometry/repair/examine.hpp>

namespace trocar::geometry {
namespace {

constexpr int kFlatRounds = 10;
constexpr double kNeedle = 4;         ///< times the height that is none: an edge shorter than that collapses
constexpr double kLastResort = 1e-3;  ///< of the longest side: a short one collapses where nothing can be flipped

class Flat {
 public:
  Flat(const TriMesh& mesh, double height) : m_work(mesh), m_height(height) {}

  int remove_all() {
    int count = 0;
    for (int round = 0, now = 1; now > 0 && round < kFlatRounds; ++round) {
      now = 0;
      for (int f = 0; f < m_work.faces(); ++f)
        if (m_work.alive(f) && is_flat_face(f)) now += remove(f);
      count += now;
    }
    return count;
  }
  int left() const {
    int sum = 0;
    for (int f = 0; f < m_work.faces(); ++f) sum += m_work.alive(f) && is_flat_face(f);
    return sum;
  }
  TriMesh taken() const { return m_work.taken(); }

 private:
  EditableMesh m_work;
  double m_height;

  double side(int f, int k) const {
    const auto& t = m_work.face(f);
    return length(m_work.place(t[(k + 1) % 3]) - m_work.place(t[k]));
  }
  int longest(int f) const {
    int k = 0;
    for (int i = 1; i < 3; ++i)
      if (side(f, i) > side(f, k)) k = i;
    return k;
  }
  int shortest(int f) const {
    int k = 0;
    for (int i = 1; i < 3; ++i)
      if (side(f, i) < side(f, k)) k = i;
    return k;
  }
  /// Height over the longest side.
  double lowness(int f) const {
    const double most = side(f, longest(f));
    return most > 0 ? length(m_work.area_vector(f)) / (most * most) : 0;
  }
  bool is_flat_face(int f) const { return !(lowness(f) > kNoHeight) || lowness(f) * side(f, longest(f)) < m_height; }

  bool remove(int f) {
    const int l = longest(f), s = shortest(f);
    const double low = std::max(m_height, kNoHeight * side(f, l));
    if (side(f, s) <= kNeedle * low && collapsed(f, s)) return true;
    const auto t = m_work.face(f);
    const int a = t[l], b = t[(l + 1) % 3];
    if (m_work.sides(a, b).count == 1) {  // its long edge is a border: the other two become it
      m_work.kill(f);
      return true;
    }
    return flipped(f, a, b) || (side(f, s) <= kLastResort * side(f, l) && collapsed(f, s));
  }

  bool collapsed(int f, int k) {
    const auto t = m_work.face(f);
    const int a = t[k], b = t[(k + 1) % 3];
    const bool a_fixed = m_work.on_border(a);
    const int from = a_fixed ? b : a, into = a_fixed ? a : b;
    if (!m_work.can_collapse(from, into)) return false;
    m_work.collapse(from, into);
    return true;
  }

  /// Only where neither of the new ones is as flat.
  bool flipped(int f, int a, int b) {
    if (!m_work.can_flip(a, b)) return false;
    const double before = lowness(f);
    const EditableMesh::Sides at = m_work.sides(a, b);
    const int c = m_work.opposite(at.face[0], a, b), d = m_work.opposite(at.face[1], a, b);
    m_work.flip(a, b);
    if (std::min(lowness(at.face[0]), lowness(at.face[1])) > before) return true;
    m_work.flip(c, d);
    return false;
  }
};

}  // namespace

Repaired without_degenerate(const TriMesh& mesh, double height) {
  Repaired out{mesh, {}, {}};
  const int twice = int(std::count_if(mesh.triangles.begin(), mesh.triangles.end(), corner_twice));
  Flat work(mesh, height);
  if (twice + work.left() == 0) return out;
  const int removed = twice + work.remove_all();
  if (removed > 0) out.mesh = work.taken();
  out.tell("without_degenerate", removed, "triangle without area removed", "triangles without area removed");
  if (work.left() > 0) out.left.push_back(tr("{} triangles without area remain", work.left()));
  return out;
}

}  // namespace trocar::geometry
