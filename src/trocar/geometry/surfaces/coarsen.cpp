#include <algorithm>
#include <cmath>
#include <queue>

#include <trocar/geometry/surfaces/coarsen.hpp>
#include <trocar/geometry/surfaces/quadric.hpp>

namespace trocar::geometry {
namespace {

constexpr double kLeastTurn = 0.5;      // cosine: no triangle turns further than 60 degrees
constexpr double kThinnest = 0.05;      // height over base; a thinner triangle is not made
constexpr std::size_t kMostFaces = 24;  // around a vertex

using Face = std::array<std::uint32_t, 3>;

double square(Vec3d v) { return dot(v, v); }

/// A vertex that could go into a neighbour.
struct Move {
  double cost = 0;  ///< [m^2]
  std::uint32_t vertex = 0, into = 0, version = 0;
  /// The cheapest first, then by number: the same on every run.
  friend bool operator<(const Move& a, const Move& b) {
    return a.cost != b.cost ? a.cost > b.cost : a.vertex > b.vertex;
  }
};

class Coarsening {
 public:
  /// @param most error [m] that reach() will be asked for at most
  Coarsening(std::span<const Vec3f> positions, std::span<const std::uint32_t> triangles, std::span<const Vec3f> notes,
             double longest_edge, double most)
      : m_notes(notes),
        m_longest(longest_edge),
        m_most(most * most),
        m_place(positions.size()),
        m_quadric(positions.size()),
        m_drift(positions.size(), 0.0),
        m_version(positions.size(), 0),
        m_fixed(positions.size(), 0),
        m_faces_at(positions.size()) {
    for (std::size_t i = 0; i < positions.size(); ++i) m_place[i] = vec_cast<double>(positions[i]);
    for (std::size_t t = 0; t + 2 < triangles.size(); t += 3)
      add_face({triangles[t], triangles[t + 1], triangles[t + 2]});
    fix_borders();
    for (std::uint32_t v = 0; v < m_place.size(); ++v) offer(v);
  }

  /// Takes away all that costs no more than `error` [m].
  void reach(double error) {
    while (!m_moves.empty() && m_moves.top().cost <= error * error) {
      const Move move = m_moves.top();
      m_moves.pop();
      if (move.version == m_version[move.vertex]) carry_out(move);
    }
  }

  std::vector<std::uint32_t> triangles() const {
    std::vector<std::uint32_t> list;
    for (std::size_t f = 0; f < m_face.size(); ++f)
      if (m_alive[f]) list.insert(list.end(), m_face[f].begin(), m_face[f].end());
    return list;
  }

 private:
  Vec3d area(const Face& f) const { return cross(m_place[f[1]] - m_place[f[0]], m_place[f[2]] - m_place[f[0]]); }

  void add_face(const Face& face) {
    const std::uint32_t index = std::uint32_t(m_face.size());
    m_face.push_back(face);
    m_alive.push_back(1);
    const Vec3d twice = area(face), n = normalised(twice);
    for (const std::uint32_t v : face) {
      m_faces_at[v].push_back(index);
      m_quadric[v].add_plane(n, -dot(n, m_place[face[0]]), length(twice));
    }
  }

  /// How far off the notes of what v stands for would be if it went into w [m].
  double noted(std::uint32_t v, std::uint32_t w) const { return m_drift[v] + double(length(m_notes[v] - m_notes[w])); }

  /// The vertices around v, each once, and for each in how many of v's triangles it is.
  void look_around(std::uint32_t v, std::vector<std::pair<std::uint32_t, int>>& ring) const {
    ring.clear();
    for (const std::uint32_t f : m_faces_at[v])
      for (const std::uint32_t w : m_face[f]) {
        if (w == v) continue;
        const auto known = std::find_if(ring.begin(), ring.end(), [w](const auto& r) { return r.first == w; });
        if (known == ring.end())
          ring.emplace_back(w, 1);
        else
          ++known->second;
      }
  }

  /// Vertices at an edge that has not two triangles stay.
  void fix_borders() {
    std::vector<std::pair<std::uint32_t, int>> ring;
    for (std::uint32_t v = 0; v < m_place.size(); ++v) {
      look_around(v, ring);
      for (const auto& [w, faces] : ring)
        if (faces != 2) m_fixed[v] = 1;
    }
  }

  bool has(std::uint32_t face, std::uint32_t v) const {
    const Face& f = m_face[face];
    return f[0] == v || f[1] == v || f[2] == v;
  }

  /// Would the surface stay one without folds? m_ring is around v.
  bool allowed(std::uint32_t v, std::uint32_t into) {
    look_around(into, m_other_ring);
    int common = 0;
    for (const auto& [w, faces] : m_ring)
      common += std::any_of(m_other_ring.begin(), m_other_ring.end(), [w = w](const auto& r) { return r.first == w; });
    if (common != 2 || m_faces_at[v].size() + m_faces_at[into].size() > kMostFaces + 4) return false;
    for (const std::uint32_t f : m_faces_at[v]) {
      if (has(f, into)) continue;
      Face moved = m_face[f];
      std::replace(moved.begin(), moved.end(), v, into);
      const Vec3d before = area(m_face[f]), after = area(moved);
      double longest = 0;
      for (std::size_t k = 0; k < 3; ++k)
        longest = std::max(longest, square(m_place[moved[(k + 1) % 3]] - m_place[moved[k]]));
      if (longest > m_longest * m_longest) return false;
      if (!(length(after) > kThinnest * longest)) return false;
      if (dot(before, after) < kLeastTurn * length(before) * length(after)) return false;
    }
    return true;
  }

  /// Puts the vertex's cheapest move on the list. What it costs is asked first: whether it is allowed takes longer.
  void offer(std::uint32_t v) {
    if (m_fixed[v] || m_faces_at[v].empty()) return;
    look_around(v, m_ring);
    m_ways.clear();
    for (const auto& [w, faces] : m_ring) {
      double cost = m_quadric[v].at(m_place[w]);
      if (!m_notes.empty()) cost = std::max(cost, noted(v, w) * noted(v, w));
      if (cost > m_most) continue;
      const auto dearer =
          std::upper_bound(m_ways.begin(), m_ways.end(), cost, [](double c, const Move& m) { return c < m.cost; });
      m_ways.insert(dearer, {cost, v, w, m_version[v]});
    }
    const auto best = std::find_if(m_ways.begin(), m_ways.end(), [&](const Move& m) { return allowed(v, m.into); });
    if (best != m_ways.end()) m_moves.push(*best);
  }

  void carry_out(const Move& move) {
    const std::uint32_t v = move.vertex, into = move.into;
    for (const std::uint32_t f : m_faces_at[v]) {
      if (has(f, into)) {
        m_alive[f] = 0;
        for (const std::uint32_t w : m_face[f])
          if (w != v) std::erase(m_faces_at[w], f);
        continue;
      }
      std::replace(m_face[f].begin(), m_face[f].end(), v, into);
      m_faces_at[into].push_back(f);
    }
    m_faces_at[v].clear();
    m_quadric[into].add(m_quadric[v]);
    if (!m_notes.empty()) m_drift[into] = std::max(m_drift[into], noted(v, into));
    look_around(into, m_ring);
    std::vector<std::uint32_t> stale{into};
    for (const auto& [w, faces] : m_ring) stale.push_back(w);
    for (const std::uint32_t w : stale) {
      ++m_version[w];
      offer(w);
    }
  }

  std::span<const Vec3f> m_notes;
  double m_longest, m_most;  ///< [m], [m^2]
  std::vector<Vec3d> m_place;
  std::vector<Quadric> m_quadric;  ///< (n) of the planes that a vertex stands for
  std::vector<double> m_drift;     ///< (n) [m] of the notes
  std::vector<std::uint32_t> m_version;
  std::vector<std::uint8_t> m_fixed;
  std::vector<std::vector<std::uint32_t>> m_faces_at;
  std::vector<Face> m_face;
  std::vector<std::uint8_t> m_alive;
  std::priority_queue<Move> m_moves;
  std::vector<std::pair<std::uint32_t, int>> m_ring, m_other_ring;  ///< scratch, as is the next
  std::vector<Move> m_ways;
};

}  // namespace

std::vector<std::vector<std::uint32_t>> coarsened(std::span<const Vec3f> positions,
                                                  std::span<const std::uint32_t> triangles,
                                                  std::span<const Vec3f> notes, std::span<const double> errors,
                                                  double longest_edge) {
  const double most = errors.empty() ? 0 : *std::max_element(errors.begin(), errors.end());
  Coarsening coarsening(positions, triangles, notes, longest_edge, most);
  std::vector<std::vector<std::uint32_t>> lists;
  for (const double error : errors) {
    coarsening.reach(error);
    lists.push_back(coarsening.triangles());
  }
  return lists;
}

}  // namespace trocar::geometry
