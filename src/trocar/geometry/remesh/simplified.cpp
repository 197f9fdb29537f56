#include <algorithm>
#include <cmath>
#include <queue>

#include <trocar/geometry/remesh/editable.hpp>
#include <trocar/geometry/remesh/simplified.hpp>
#include <trocar/geometry/surfaces/quadric.hpp>

namespace trocar::geometry {
namespace {

constexpr double kLeastAgreement = 0.2;  ///< cosine between a triangle before and after
constexpr double kBorderWeight = 10;     ///< of a plane that stands on a border, against those of triangles
constexpr double kThinnestLeft = 0.02;   ///< height over longest side; a thinner one is not made of a better one

struct Collapse {
  double cost = 0;  ///< [m^2]
  int from = 0, into = 0, from_version = 0, into_version = 0;
  Vec3d place{};
  /// The cheapest first, then by number: the same on every run.
  friend bool operator<(const Collapse& a, const Collapse& b) {
    if (a.cost != b.cost) return a.cost > b.cost;
    return a.from != b.from ? a.from > b.from : a.into > b.into;
  }
};

class Simplifying {
 public:
  explicit Simplifying(const TriMesh& mesh)
      : m_work(mesh), m_quadric(mesh.positions.size()), m_version(mesh.positions.size()) {
    for (int f = 0; f < m_work.faces(); ++f) add_planes(f);
  }

  /// @param most  [m^2]
  void reach(int triangles, double most) {
    for (int before = -1; m_work.living_faces() > triangles && m_work.living_faces() != before;) {
      before = m_work.living_faces();  // what was not allowed may be so, now that its neighbours have changed
      offer_all();
      collapse_offered(triangles, most);
    }
  }
  TriMesh taken() const { return m_work.taken(); }
  double dearest = 0;  ///< [m^2]

 private:
  EditableMesh m_work;
  std::vector<Quadric> m_quadric;
  std::vector<int> m_version;
  std::priority_queue<Collapse> m_offers;
  std::vector<int> m_ring;

  void collapse_offered(int triangles, double most) {
    while (m_work.living_faces() > triangles && !m_offers.empty() && m_offers.top().cost <= most) {
      const Collapse next = m_offers.top();
      m_offers.pop();
      if (m_version[next.from] != next.from_version || m_version[next.into] != next.into_version) continue;
      if (allowed(next)) carry_out(next);
    }
  }

  void offer_all() {
    m_offers = {};
    for (int f = 0; f < m_work.faces(); ++f)
      for (int k = 0; m_work.alive(f) && k < 3; ++k) {
        const int a = m_work.face(f)[k], b = m_work.face(f)[(k + 1) % 3];
        if (a < b || m_work.sides(a, b).count == 1) offer(std::min(a, b), std::max(a, b));
      }
  }

  void add_planes(int f) {
    const auto& t = m_work.face(f);
    const Vec3d twice = m_work.area_vector(f), n = normalised(twice, Vec3d{});
    for (const int v : t) m_quadric[v].add_plane(n, -dot(n, m_work.place(t[0])), length(twice));
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      if (m_work.sides(a, b).count == 2) continue;
      const Vec3d along = m_work.place(b) - m_work.place(a), across = normalised(cross(along, n), Vec3d{});
      for (const int v : {a, b})
        m_quadric[v].add_plane(across, -dot(across, m_work.place(a)), kBorderWeight * dot(along, along));
    }
  }

  void offer(int a, int b) {
    Quadric both = m_quadric[a];
    both.add(m_quadric[b]);
    const Vec3d p = m_work.place(a), q = m_work.place(b), middle = 0.5 * (p + q);
    Collapse way{both.at(middle), a, b, m_version[a], m_version[b], middle};
    Vec3d best;
    if (both.least(best) && length(best - middle) < 2 * length(p - q)) {
      way.place = best;
      way.cost = both.at(best);
    } else {
      for (const Vec3d end : {p, q})
        if (both.at(end) < way.cost) way.place = end, way.cost = both.at(end);
    }
    way.cost += 1e-12 * dot(p - q, p - q);  // of those that cost nothing the shortest first
    m_offers.push(way);
  }

  double thinness(const Vec3d& a, const Vec3d& b, const Vec3d& c) const {
    const double longest = std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)});
    return longest > 0 ? length(cross(b - a, c - a)) / longest : 0;
  }

  bool stays_good(int vertex, int other, Vec3d to) const {
    for (const int f : m_work.faces_at(vertex)) {
      auto t = m_work.face(f);
      if (t[0] == other || t[1] == other || t[2] == other) continue;
      std::array<Vec3d, 3> p{m_work.place(t[0]), m_work.place(t[1]), m_work.place(t[2])};
      const Vec3d before = cross(p[1] - p[0], p[2] - p[0]);
      const double thin_before = thinness(p[0], p[1], p[2]);
      for (std::size_t k = 0; k < 3; ++k)
        if (t[k] == vertex) p[k] = to;
      const Vec3d after = cross(p[1] - p[0], p[2] - p[0]);
      if (!(dot(before, after) > kLeastAgreement * length(before) * length(after))) return false;
      if (thinness(p[0], p[1], p[2]) < std::min(kThinnestLeft, thin_before)) return false;
    }
    return true;
  }
  bool allowed(const Collapse& way) const {
    return m_work.can_collapse(way.from, way.into) && stays_good(way.from, way.into, way.place) &&
           stays_good(way.into, way.from, way.place);
  }

  void carry_out(const Collapse& way) {
    m_work.collapse(way.from, way.into);
    m_work.move(way.into, way.place);
    m_quadric[way.into].add(m_quadric[way.from]);
    dearest = std::max(dearest, way.cost);
    ++m_version[way.from];
    ++m_version[way.into];
    m_work.neighbours(way.into, m_ring);
    const std::vector<int> ring = m_ring;
    for (const int w : ring) offer(std::min(way.into, w), std::max(way.into, w));
  }
};

}  // namespace

Simplified simplified(const TriMesh& mesh, int triangles, const SimplifyOptions& options) {
  Simplified out{mesh, 0, volume(mesh), 0};
  Simplifying work(mesh);
  work.reach(triangles, options.most_error * options.most_error);
  out.mesh = work.taken();
  out.error = std::sqrt(work.dearest);
  out.volume = volume(out.mesh);
  return out;
}

}  // namespace trocar::geometry
