#include <algorithm>
#include <cmath>
#include <queue>

#include <trocar/geometry/remesh/editable.hpp>
#include <trocar/geometry/repair/parted.hpp>
#include <trocar/geometry/surfaces/edge_table.hpp>
#include <trocar/geometry/surfaces/groups.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::geometry {
namespace {

/// A triangle at a crowded edge, and the direction around the edge in which it lies.
struct Leaf {
  EdgeUse use;
  double angle;
};
using LeafPair = std::array<EdgeUse, 2>;

std::vector<Leaf> around_edge(const TriMesh& mesh, std::span<const EdgeUse> uses) {
  const Vec3d low = mesh.positions[uses[0].low], axis = normalised(mesh.positions[uses[0].high] - low);
  const Vec3d u = any_perpendicular(axis), v = cross(axis, u);
  std::vector<Leaf> leaves;
  for (const EdgeUse& use : uses) {
    const Vec3d out = mesh.positions[mesh.triangles[use.triangle][(use.side + 2) % 3]] - low;
    leaves.push_back({use, portable::atan2(dot(out, v), dot(out, u))});
  }
  std::stable_sort(leaves.begin(), leaves.end(), [](const Leaf& a, const Leaf& b) { return a.angle < b.angle; });
  return leaves;
}

/// From one leaf on to another, around the edge [rad].
double wedge(const Leaf& from, const Leaf& to) {
  const double angle = to.angle - from.angle;
  return angle < 0 ? angle + portable::two_pi : angle;
}

/// Bodies' boundaries run up and down in turn; between one that runs down and the next there is the inside.
bool in_turn(const std::vector<Leaf>& leaves) {
  for (std::size_t i = 0; i < leaves.size(); ++i)
    if (leaves[i].use.upwards == leaves[(i + 1) % leaves.size()].use.upwards) return false;
  return true;
}

/// Three leaves, or what is left of more: the two that are the flattest go together, if possible of both directions.
LeafPair flattest(const std::vector<Leaf>& leaves) {
  LeafPair best{leaves[0].use, leaves[1].use};
  double least = 1e9;
  for (std::size_t i = 0; i < leaves.size(); ++i)
    for (std::size_t j = i + 1; j < leaves.size(); ++j) {
      const double off = std::fabs(wedge(leaves[i], leaves[j]) - portable::pi) +
                         (leaves[i].use.upwards == leaves[j].use.upwards ? 10 : 0);
      if (off < least) least = off, best = {leaves[i].use, leaves[j].use};
    }
  return best;
}

/// Takes neighbours with the least between them away, if possible of both directions, until three are left at most.
std::vector<LeafPair> nearest_taken(std::vector<Leaf>& leaves) {
  using Gap = std::pair<double, std::size_t>;  // what is between a leaf and the next one
  const std::size_t n = leaves.size();
  std::vector<std::size_t> next(n), before(n);
  std::vector<bool> gone(n);
  std::priority_queue<Gap, std::vector<Gap>, std::greater<>> gaps;
  const auto gap = [&](std::size_t i) {
    const Leaf &a = leaves[i], &b = leaves[next[i]];
    return Gap{wedge(a, b) + (a.use.upwards == b.use.upwards ? 10 : 0), i};
  };
  for (std::size_t i = 0; i < n; ++i) next[i] = (i + 1) % n, before[i] = (i + n - 1) % n;
  for (std::size_t i = 0; i < n; ++i) gaps.push(gap(i));
  std::vector<LeafPair> pairs;
  for (std::size_t left = n; left > 3 && !gaps.empty();) {
    const Gap least = gaps.top();
    gaps.pop();
    const std::size_t i = least.second, k = next[i];
    if (gone[i] || gap(i) != least) continue;  // its neighbour has been taken
    pairs.push_back({leaves[i].use, leaves[k].use});
    gone[i] = gone[k] = true;
    next[before[i]] = next[k];
    before[next[k]] = before[i];
    gaps.push(gap(before[i]));
    left -= 2;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (!gone[i]) leaves[kept++] = leaves[i];
  leaves.resize(kept);
  return pairs;
}

std::vector<LeafPair> paired(std::vector<Leaf> leaves) {
  std::vector<LeafPair> pairs;
  if (in_turn(leaves)) {
    const std::size_t first = leaves[0].use.upwards ? 1 : 0;
    for (std::size_t i = first; i < first + leaves.size(); i += 2)
      pairs.push_back({leaves[i % leaves.size()].use, leaves[(i + 1) % leaves.size()].use});
    return pairs;
  }
  if (leaves.size() > 3) pairs = nearest_taken(leaves);
  if (leaves.size() >= 2) pairs.push_back(flattest(leaves));
  return pairs;
}

/// Corners of triangles (3 triangle + corner) that share a vertex after all.
class CornerGroups {
 public:
  CornerGroups(const TriMesh& mesh, const std::vector<std::array<int, 2>>& cuts)
      : m_mesh(mesh), m_groups(3 * mesh.triangles.size()) {
    const EdgeTable edges(mesh);
    edges.for_each([&](std::span<const EdgeUse> uses) {
      if (uses.size() == 2 && !std::binary_search(cuts.begin(), cuts.end(), std::array{uses[0].low, uses[0].high}))
        join({uses[0], uses[1]});
      if (uses.size() < 3) return;
      ++crowded;
      for (const LeafPair& pair : paired(around_edge(mesh, uses))) {
        join(pair);
        pairs.push_back(pair);
      }
    });
  }

  int crowded = 0;
  std::vector<LeafPair> pairs;  ///< at crowded edges

  /// Every group gets a vertex; the first of a vertex's groups keeps it. How many are new.
  int number(TriMesh& out) {
    std::vector<bool> taken(m_mesh.positions.size());
    std::vector<int> vertex(3 * m_mesh.triangles.size(), -1);
    for (int c = 0; c < int(vertex.size()); ++c) {
      const int root = m_groups.root(c), own = m_mesh.triangles[c / 3][c % 3];
      if (root == c) {
        vertex[c] = taken[own] ? int(out.positions.size()) : own;
        if (taken[own]) out.positions.push_back(m_mesh.positions[own]);
        taken[own] = true;
      }
      out.triangles[c / 3][c % 3] = vertex[c] = vertex[root];
    }
    return int(out.positions.size() - m_mesh.positions.size());
  }

 private:
  const TriMesh& m_mesh;
  Groups m_groups;

  void join(const LeafPair& pair) {
    for (const int v : {pair[0].low, pair[0].high})
      m_groups.join(3 * pair[0].triangle + corner_of(m_mesh.triangles[pair[0].triangle], v),
                    3 * pair[1].triangle + corner_of(m_mesh.triangles[pair[1].triangle], v));
  }
};

/// Pairs that still have both ends in common with others get a vertex of their own in the middle of their edge.
void split_pairs(TriMesh& mesh, const std::vector<LeafPair>& pairs) {
  const EdgeTable edges(mesh);
  std::vector<bool> crowded(mesh.triangles.size());
  for (int t = 0; t < int(crowded.size()); ++t)
    for (int k = 0; k < 3; ++k)
      if (edges.across(t, k) == EdgeTable::kCrowded) crowded[t] = true;
  std::vector<bool> done(mesh.triangles.size());
  for (const LeafPair& pair : pairs) {
    const int s = pair[0].triangle, t = pair[1].triangle;
    if (!crowded[s] || !crowded[t] || done[s] || done[t]) continue;
    if (edges.across(s, pair[0].side) != EdgeTable::kCrowded) continue;
    const int a = mesh.triangles[s][pair[0].side], b = mesh.triangles[s][(pair[0].side + 1) % 3];
    const int middle = int(mesh.positions.size());
    mesh.positions.push_back(0.5 * (mesh.positions[a] + mesh.positions[b]));
    for (const int f : {s, t}) {
      auto half = mesh.triangles[f];
      half[corner_of(half, a)] = middle;
      mesh.triangles[f][corner_of(mesh.triangles[f], b)] = middle;
      mesh.triangles.push_back(half);
      done[f] = true;
    }
  }
}

}  // namespace

Repaired parted_along(const TriMesh& mesh, const std::vector<std::array<int, 2>>& cuts) {
  Repaired out{mesh, {}, {}};
  std::erase_if(out.mesh.triangles, corner_twice);
  int fresh = 0, crowded = 0;
  for (int round = 0; round < 8; ++round) {  // an edge of a split pair may be crowded, too
    const TriMesh before = out.mesh;
    CornerGroups groups(before, cuts);
    fresh += groups.number(out.mesh);
    if (round == 0) crowded = groups.crowded;
    if (groups.crowded == 0) break;
    split_pairs(out.mesh, groups.pairs);
  }
  out.tell("parted", crowded, "edge with more than two triangles parted", "edges with more than two triangles parted");
  out.tell("parted", fresh, "vertex doubled where surfaces only touch", "vertices doubled where surfaces only touch");
  return out;
}

Repaired parted(const TriMesh& mesh) { return parted_along(mesh, {}); }

}  // namespace trocar::geometry
