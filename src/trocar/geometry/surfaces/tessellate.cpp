// The mesh of a closed surface, in three steps: rings of vertices in equal ways, zipped together; edges flipped where
// that makes the smaller angles larger; vertices moved on the surface towards the middle of their neighbours.
#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include <trocar/geometry/surfaces/loft.hpp>

namespace trocar::geometry {
namespace {

constexpr int kRounds = 8;  // of flips and smoothing
constexpr int kSamplesAlong = 400;
constexpr int kSamplesAround = 128;

double wrapped(double u) { return u - std::floor(u); }

class Tessellator {
 public:
  Tessellator(const NurbsSurface& surface, double edge) : m_surface(surface), m_edge(edge) {
    if (!surface.periodic_u || surface.start_u() != 0.0 || surface.end_u() != 1.0)
      throw std::invalid_argument("tessellate: a surface periodic in u, 0 .. 1, expected");
    if (!(edge > 0.0)) throw std::invalid_argument("tessellate: an edge length above 0 expected");
  }

  Tessellation run() {
    measure_along();
    require_pole(m_surface.start_v());
    require_pole(m_surface.end_v());
    place_rings();
    zip_rings();
    if (volume(m_result.mesh) < 0.0)
      for (auto& t : m_result.mesh.triangles) std::swap(t[1], t[2]);
    for (int round = 0; round < kRounds; ++round) {
      flip_edges();
      smooth();
    }
    flip_edges();
    return std::move(m_result);
  }

 private:
  int add_vertex(double u, double v) {
    m_result.mesh.positions.push_back(m_surface.point(u, v));
    m_result.parameters.push_back({u, v});
    return static_cast<int>(m_result.parameters.size()) - 1;
  }

  // Way along the surface from the first pole, mean around, at even steps of v.
  void measure_along() {
    constexpr int kMeridians = 16;
    m_way.assign(kSamplesAlong + 1, 0.0);
    std::vector<Vec3d> last(kMeridians);
    for (int k = 0; k <= kSamplesAlong; ++k) {
      double step = 0.0;
      for (int i = 0; i < kMeridians; ++i) {
        const Vec3d p = m_surface.point(double(i) / kMeridians, v_of_sample(k));
        if (k > 0) step += length(p - last[i]) / kMeridians;
        last[i] = p;
      }
      if (k > 0) m_way[k] = m_way[k - 1] + step;
    }
  }
  double v_of_sample(double k) const {
    return m_surface.start_v() + (m_surface.end_v() - m_surface.start_v()) * (k / kSamplesAlong);
  }
  double v_of_way(double way) const {
    const auto above = std::upper_bound(m_way.begin(), m_way.end() - 1, way);
    const std::size_t k = above == m_way.begin() ? 0 : static_cast<std::size_t>(above - m_way.begin()) - 1;
    return v_of_sample(double(k) + (way - m_way[k]) / (m_way[k + 1] - m_way[k]));
  }

  void require_pole(double v) const {
    for (double u : {0.25, 0.5, 0.75})
      if (length(m_surface.point(u, v) - m_surface.point(0.0, v)) > 1e-6 * m_way.back())
        throw std::invalid_argument("tessellate: a surface that closes in poles at both ends expected");
  }

  // Rows at the height of an even triangle; in each, as many vertices as edges fit around, turned by half a step
  // against the row before.
  void place_rings() {
    const int steps = std::max(3, static_cast<int>(m_way.back() / (0.866 * m_edge) + 0.5));
    m_rings.push_back({add_vertex(0.0, m_surface.start_v())});
    for (int k = 1; k < steps; ++k) {
      const double v = v_of_way(m_way.back() * k / steps);
      std::vector<double> around(kSamplesAround + 1, 0.0);
      for (int i = 1; i <= kSamplesAround; ++i)
        around[i] = around[i - 1] + length(m_surface.point(double(i) / kSamplesAround, v) -
                                           m_surface.point(double(i - 1) / kSamplesAround, v));
      const int count = std::max(5, static_cast<int>(around.back() / m_edge + 0.5));
      std::vector<int> ring;
      for (int i = 0; i < count; ++i) {
        const double way = around.back() * (i + 0.5 * (k % 2)) / count;
        const auto above = std::upper_bound(around.begin(), around.end() - 1, way);
        const std::size_t s = static_cast<std::size_t>(above - around.begin()) - 1;
        const double u = (double(s) + (way - around[s]) / (around[s + 1] - around[s])) / kSamplesAround;
        ring.push_back(add_vertex(wrapped(u), v));
      }
      m_rings.push_back(ring);
    }
    m_rings.push_back({add_vertex(0.0, m_surface.end_v())});
  }

  // Between neighbouring rings always the shorter of the two next diagonals.
  void zip_rings() {
    const auto& p = m_result.mesh.positions;
    for (std::size_t k = 0; k + 1 < m_rings.size(); ++k) {
      const auto &a = m_rings[k], &b = m_rings[k + 1];
      const std::size_t na = a.size() == 1 ? 0 : a.size(), nb = b.size() == 1 ? 0 : b.size();
      for (std::size_t i = 0, j = 0; i < na || j < nb;) {
        const int ai = a[i % a.size()], bj = b[j % b.size()];
        const int a_next = a[(i + 1) % a.size()], b_next = b[(j + 1) % b.size()];
        const bool step_a = j >= nb || (i < na && length(p[a_next] - p[bj]) < length(p[b_next] - p[ai]));
        m_result.mesh.triangles.push_back({ai, step_a ? a_next : b_next, bj});
        ++(step_a ? i : j);
      }
    }
  }

  // Where two triangles' angles facing their common edge sum to more than a half turn, the other diagonal is better
  // (Delaunay); unless it exists already or would fold the surface.
  void flip_edges() {
    auto& triangles = m_result.mesh.triangles;
    struct FacedSide {
      int low, high, triangle, opposite;
    };
    std::vector<FacedSide> sides;
    for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
      for (int k = 0; k < 3; ++k) {
        const int a = triangles[t][k], b = triangles[t][(k + 1) % 3];
        sides.push_back({std::min(a, b), std::max(a, b), t, triangles[t][(k + 2) % 3]});
      }
    std::sort(sides.begin(), sides.end(), [](const FacedSide& x, const FacedSide& y) {
      if (x.low != y.low) return x.low < y.low;
      if (x.high != y.high) return x.high < y.high;
      return x.triangle < y.triangle;
    });
    std::set<std::array<int, 2>> known;
    for (const FacedSide& side : sides) known.insert({side.low, side.high});
    std::vector<char> changed(triangles.size(), 0);
    for (std::size_t i = 0; i + 1 < sides.size(); i += 2) {
      const FacedSide &one = sides[i], &two = sides[i + 1];
      if (changed[one.triangle] || changed[two.triangle]) continue;
      const std::array<int, 2> other{std::min(one.opposite, two.opposite), std::max(one.opposite, two.opposite)};
      if (known.count(other) || !worth_flipping(one.low, one.high, one.opposite, two.opposite)) continue;
      const std::array<int, 3> old_one = triangles[one.triangle];
      // Keep the orientation: in `one` the edge runs from..to.
      int k = 0;
      while (old_one[k] == one.opposite || old_one[(k + 1) % 3] == one.opposite) ++k;
      const int from = old_one[k], to = old_one[(k + 1) % 3];
      const std::array<int, 3> new_one{one.opposite, from, two.opposite}, new_two{two.opposite, to, one.opposite};
      if (folds(old_one, new_one) || folds(old_one, new_two)) continue;
      triangles[one.triangle] = new_one;
      triangles[two.triangle] = new_two;
      changed[one.triangle] = changed[two.triangle] = 1;
      known.insert(other);
      known.erase({one.low, one.high});
    }
  }
  bool worth_flipping(int a, int b, int c, int d) const {
    const auto& p = m_result.mesh.positions;
    const auto cotangent = [&](int at) {
      const Vec3d x = p[a] - p[at], y = p[b] - p[at];
      return dot(x, y) / std::max(length(cross(x, y)), 1e-300);
    };
    return cotangent(c) + cotangent(d) < -1e-6;
  }
  bool folds(const std::array<int, 3>& before, const std::array<int, 3>& after) const {
    return !(dot(normal_of(before), normal_of(after)) > 0.5);
  }
  Vec3d normal_of(const std::array<int, 3>& t) const {
    const auto& p = m_result.mesh.positions;
    return normalised(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]), Vec3d{});
  }

  // Half the way towards the middle of the neighbours, by the step in (u, v) that comes closest to it.
  void smooth() {
    const Csr neighbours = vertex_neighbours(m_result.mesh);
    const std::vector<Vec3d> old = m_result.mesh.positions;
    for (int i = 0; i < neighbours.rows(); ++i) {
      auto& [u, v] = m_result.parameters[i];
      if (v == m_surface.start_v() || v == m_surface.end_v()) continue;
      Vec3d middle{};
      for (int j : neighbours.row(i)) middle += old[j];
      middle = middle / double(neighbours.row(i).size());
      move_towards(0.5 * (middle - old[i]), u, v);
      m_result.mesh.positions[i] = m_surface.point(u, v);
    }
  }
  void move_towards(Vec3d step, double& u, double& v) const {
    const SurfacePoint at = m_surface.at(u, v);
    const double uu = dot(at.du, at.du), uv = dot(at.du, at.dv), vv = dot(at.dv, at.dv);
    const double ru = dot(at.du, step), rv = dot(at.dv, step), whole = uu * vv - uv * uv;
    if (!(whole > 1e-8 * uu * vv)) return;
    const double du = (vv * ru - uv * rv) / whole, dv = (uu * rv - uv * ru) / whole;
    const double next_v = v + dv, margin = 0.25 * m_edge / m_way.back() * (m_surface.end_v() - m_surface.start_v());
    if (std::fabs(du) > 0.1 || next_v < m_surface.start_v() + margin || next_v > m_surface.end_v() - margin) return;
    u = wrapped(u + du);
    v = next_v;
  }

  const NurbsSurface& m_surface;
  double m_edge;
  std::vector<double> m_way;
  std::vector<std::vector<int>> m_rings;
  Tessellation m_result;
};

}  // namespace

Tessellation tessellate_with_parameters(const NurbsSurface& surface, double target_edge) {
  return Tessellator(surface, target_edge).run();
}

TriMesh tessellate(const NurbsSurface& surface, double target_edge) {
  return tessellate_with_parameters(surface, target_edge).mesh;
}

}  // namespace trocar::geometry
