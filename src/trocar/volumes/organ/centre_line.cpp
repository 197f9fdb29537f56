#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <queue>

#include <trocar/core/require.hpp>
#include <trocar/volumes/organ/centre_line.hpp>
#include <trocar/volumes/segment/distance.hpp>

namespace trocar::volumes {
namespace {

constexpr float kFar = 1e30f;

/// A label's voxels, how far from the wall each is, and ways through them.
class Lumen {
 public:
  Lumen(const Labels& labels, int label) : m_grid(labels.grid), m_set(voxels_of(labels, label, Index3{1, 1, 1})) {
    core::require(!m_set.box.empty(), "no voxel has this label");
    m_depth = squared_distance(m_set, m_grid.spacing, true, true);
    for (float& d : m_depth) d = std::sqrt(d);
    m_size = m_set.size();
    find_steps();
  }

  std::size_t count() const { return m_set.in.size(); }
  bool has(std::size_t voxel) const { return m_set.in[voxel] != 0; }
  float depth(std::size_t voxel) const { return m_depth[voxel]; }
  Vec3d patient(std::size_t voxel) const { return m_grid.to_patient(index_of(voxel)); }
  double least_spacing() const { return m_grid.least_spacing(); }
  bool inside(Vec3d lps_mm) const {
    const Index3 at = m_grid.nearest(lps_mm);
    std::array<std::size_t, 3> in_box{};
    for (std::size_t a = 0; a < 3; ++a) {
      const int i = at[a] - m_set.box.low[a];
      if (i < 0 || i >= m_size[a]) return false;
      in_box[a] = std::size_t(i);
    }
    return has(in_box[0] + std::size_t(m_size[0]) * (in_box[1] + std::size_t(m_size[1]) * in_box[2]));
  }

  std::size_t nearest(Vec3d lps_mm) const {
    std::size_t best = count();
    double least = 1e300;
    for (std::size_t v = 0; v < count(); ++v) {
      if (!has(v)) continue;
      const Vec3d off = patient(v) - lps_mm;
      if (dot(off, off) < least) least = dot(off, off), best = v;
    }
    return best;
  }

  /// Calls f(neighbour, millimetres) for the up to 26 neighbours of a voxel in the label.
  template <class F>
  void each_neighbour(std::size_t voxel, F&& f) const {
    const std::size_t nx = std::size_t(m_size[0]), ny = std::size_t(m_size[1]);
    const int at[] = {int(voxel % nx), int(voxel / nx % ny), int(voxel / nx / ny)};
    for (const Step& s : m_steps) {
      bool there = true;
      for (std::size_t a = 0; a < 3; ++a) there = there && at[a] + s.by[a] >= 0 && at[a] + s.by[a] < m_size[a];
      if (!there) continue;
      const std::size_t next = std::size_t(std::ptrdiff_t(voxel) + s.offset);
      if (has(next)) f(next, s.millimetres);
    }
  }

  struct Ways {
    std::vector<float> cost;         // kFar where there is no way
    std::vector<std::int64_t> from;  // the voxel before; -1 at the start
  };
  /// Cheapest ways from a voxel to all others.
  /// @param central  a millimetre costs the more the nearer the wall is; else all cost the same
  Ways ways(std::size_t start, bool central, const Progress& progress = {}) const {
    Ways out{std::vector<float>(count(), kFar), std::vector<std::int64_t>(count(), -1)};
    using Entry = std::pair<float, std::size_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    out.cost[start] = 0;
    open.push({0.0f, start});
    std::size_t done = 0;
    while (!open.empty()) {
      const float cost = open.top().first;
      const std::size_t voxel = open.top().second;
      open.pop();
      if (cost > out.cost[voxel]) continue;
      if (++done % 200'000 == 0) tell(progress, std::min(1.0, double(done) / double(count())));
      each_neighbour(voxel, [&](std::size_t next, double mm) {
        const double per_mm = central ? dearness(next) : 1;
        const float reached = cost + float(mm * per_mm);
        if (reached >= out.cost[next]) return;
        out.cost[next] = reached;
        out.from[next] = std::int64_t(voxel);
        open.push({reached, next});
      });
    }
    return out;
  }

  /// The middle is often between voxels: towards those neighbours that are as deep.
  CentrePoint point(std::size_t voxel) const {
    const double least = m_grid.least_spacing(), near = 0.25 * least;
    const Vec3d here = patient(voxel);
    Vec3d shift;
    double weights = near;
    each_neighbour(voxel, [&](std::size_t next, double) {
      const double weight = std::max(0.0, double(m_depth[next]) - double(m_depth[voxel]) + near);
      shift += weight * (patient(next) - here);
      weights += weight;
    });
    shift = shift / weights;
    // The wall is between the last voxel inside and the first one outside; the middle is deeper than the voxel.
    const double radius = double(m_depth[voxel]) - 0.5 * least + std::min(length(shift), 0.75 * least);
    return {scene_from_patient(here + shift), 1e-3 * std::max(radius, 0.25 * least)};
  }

 private:
  struct Step {
    std::array<int, 3> by{};
    std::ptrdiff_t offset = 0;
    double millimetres = 0;
  };
  const Grid& m_grid;
  VoxelSet m_set;
  Index3 m_size{};
  std::vector<float> m_depth;  // [mm]
  std::vector<Step> m_steps;

  Vec3d index_of(std::size_t voxel) const {
    const std::size_t nx = std::size_t(m_size[0]), ny = std::size_t(m_size[1]);
    return {double(voxel % nx) + m_set.box.low[0], double(voxel / nx % ny) + m_set.box.low[1],
            double(voxel / nx / ny) + m_set.box.low[2]};
  }
  void find_steps() {
    for (int k = -1; k <= 1; ++k)
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
          if (i == 0 && j == 0 && k == 0) continue;
          const Vec3d mm = m_grid.step() * Vec3d{double(i), double(j), double(k)};
          m_steps.push_back(
              {{i, j, k}, i + std::ptrdiff_t(m_size[0]) * (j + std::ptrdiff_t(m_size[1]) * k), length(mm)});
        }
  }
  double dearness(std::size_t voxel) const {
    const double deep = double(m_depth[voxel]) / m_grid.least_spacing();
    return 1 / (deep * deep);
  }
};

/// What hangs together with a voxel and is near it.
class Surroundings {
 public:
  explicit Surroundings(const Lumen& lumen) : m_lumen(lumen), m_mark(lumen.count(), 0) {}

  /// Calls f(voxel) for this one and all within `reach` [mm] that ways within it lead to: a neighbouring branch that
  /// only lies beside is not among them.
  template <class F>
  void each(std::size_t centre, double reach, F&& f) {
    const Vec3d middle = m_lumen.patient(centre);
    std::vector<std::size_t> open{centre};
    m_mark[centre] = ++m_turn;
    while (!open.empty()) {
      const std::size_t voxel = open.back();
      open.pop_back();
      f(voxel);
      m_lumen.each_neighbour(voxel, [&](std::size_t n, double) {
        if (m_mark[n] == m_turn || length(m_lumen.patient(n) - middle) > reach) return;
        m_mark[n] = m_turn;
        open.push_back(n);
      });
    }
  }

  /// From the wall of an end to the middle line. The rim of a flat end, where a vessel was cut, leads to the middle of
  /// that end; along a vessel, which widens slowly, nothing leads on.
  std::size_t middle_near(std::size_t voxel) {
    constexpr double kWidens = 0.25;  // a millimetre of radius in four of length is no vessel but an end
    while (true) {
      const double depth = double(m_lumen.depth(voxel));
      const Vec3d here = m_lumen.patient(voxel);
      std::size_t best = voxel;
      each(voxel, depth + 2 * m_lumen.least_spacing(), [&](std::size_t v) {
        const bool steep = double(m_lumen.depth(v)) - depth >= kWidens * length(m_lumen.patient(v) - here);
        if (steep && m_lumen.depth(v) > m_lumen.depth(best)) best = v;
      });
      if (best == voxel) return voxel;
      voxel = best;
    }
  }

 private:
  const Lumen& m_lumen;
  std::vector<int> m_mark;
  int m_turn = 0;
};

/// A line goes on straight from its last point to the wall of its end.
void extend(std::vector<CentrePoint>& line, const Lumen& lumen) {
  const CentrePoint last = line.back();
  std::size_t from = line.size() - 1;
  while (from > 0 && length(last.at - line[from].at) < last.radius) --from;
  const Vec3d way = last.at - line[from].at;
  if (length(way) == 0) return;
  const double step = 1e-3 * lumen.least_spacing();
  for (double on = step; on <= 3 * last.radius; on += step) {
    const Vec3d at = last.at + on / length(way) * way;
    if (!lumen.inside(patient_from_scene(at))) return;
    line.push_back({at, last.radius});
  }
}

/// Voxels from the end back to the start, or to the first that is `reached`.
std::vector<std::size_t> way_back(const Lumen::Ways& ways, std::size_t end,
                                  const std::function<bool(std::size_t)>& reached) {
  std::vector<std::size_t> out{end};
  while (ways.from[out.back()] >= 0 && !reached(out.back())) out.push_back(std::size_t(ways.from[out.back()]));
  return out;
}

/// Steps from voxel to voxel become a line; ends stay.
void straighten(std::vector<CentrePoint>& line) {
  for (int pass = 0; pass < 4; ++pass) {
    const std::vector<CentrePoint> before = line;
    for (std::size_t i = 1; i + 1 < line.size(); ++i)
      line[i].at = 0.25 * (before[i - 1].at + 2.0 * before[i].at + before[i + 1].at);
  }
}

std::size_t farthest(const Lumen& lumen, const Lumen::Ways& ways) {
  std::size_t best = 0;
  float most = -1;
  for (std::size_t v = 0; v < lumen.count(); ++v)
    if (lumen.has(v) && ways.cost[v] < kFar && ways.cost[v] > most) most = ways.cost[v], best = v;
  return best;
}

/// How thick the lumen is near an end: the greatest depth within a way of some voxels.
float thickness_near(const Lumen& lumen, std::size_t end, float within_mm) {
  const Lumen::Ways ways = lumen.ways(end, false);
  float out = 0;
  for (std::size_t v = 0; v < lumen.count(); ++v)
    if (ways.cost[v] <= within_mm) out = std::max(out, lumen.depth(v));
  return out;
}

std::size_t choose_root(const Lumen& lumen) {
  std::size_t deepest = 0;
  for (std::size_t v = 0; v < lumen.count(); ++v)
    if (lumen.has(v) && (!lumen.has(deepest) || lumen.depth(v) > lumen.depth(deepest))) deepest = v;
  const std::size_t a = farthest(lumen, lumen.ways(deepest, false));
  const Lumen::Ways from_a = lumen.ways(a, false);
  const std::size_t b = farthest(lumen, from_a);
  const float near = 0.2f * from_a.cost[b];
  return thickness_near(lumen, b, near) > thickness_near(lumen, a, near) ? b : a;
}

class TreeBuilder {
 public:
  TreeBuilder(const Lumen& lumen, Surroundings& around, std::size_t root, const TreeOptions& options)
      : m_lumen(lumen),
        m_around(around),
        m_options(options),
        m_plain(lumen.ways(root, false, part(options.progress, 0, 0.3))),
        m_central(lumen.ways(root, true, part(options.progress, 0.3, 0.6))),
        m_point(lumen.count(), -1),
        m_covered(lumen.count()) {
    m_tree.points.push_back(lumen.point(root));
    m_tree.parent.push_back(-1);
    m_point[root] = 0;
    cover(root);
  }

  CentreTree build() {
    // Ends in the order of their distance from the root: sorted once, covered ones passed over.
    std::vector<std::size_t> by_distance;
    for (std::size_t v = 0; v < m_lumen.count(); ++v)
      if (m_lumen.has(v) && m_plain.cost[v] < kFar) by_distance.push_back(v);
    std::stable_sort(by_distance.begin(), by_distance.end(),
                     [&](std::size_t a, std::size_t b) { return m_plain.cost[a] > m_plain.cost[b]; });
    int branches = 0;
    for (std::size_t i = 0; i < by_distance.size() && branches < m_options.most_branches; ++i) {
      if (i % 10'000 == 0) tell(m_options.progress, 0.6 + 0.4 * double(i) / double(by_distance.size()));
      if (m_covered[by_distance[i]]) continue;
      branches += branch(by_distance[i]) ? 1 : 0;
    }
    if (!m_options.root_mm) extend_root();
    return std::move(m_tree);
  }

 private:
  const Lumen& m_lumen;
  Surroundings& m_around;
  const TreeOptions& m_options;
  Lumen::Ways m_plain, m_central;
  std::vector<int> m_point;  // of voxels in the tree, or -1
  std::vector<bool> m_covered;
  CentreTree m_tree;

  std::vector<CentrePoint> m_first;  // the first branch, from the root on

  /// What belongs to the branch at this voxel: a little more than the ball that fits there.
  void cover(std::size_t centre) {
    m_around.each(centre, 1.5 * double(m_lumen.depth(centre)) + 2, [&](std::size_t v) { m_covered[v] = true; });
  }

  /// From an end to the tree, where it is long enough; covered in any case.
  bool branch(std::size_t end) {
    const auto in_tree = [&](std::size_t v) { return m_point[v] >= 0; };
    const std::size_t middle = m_around.middle_near(end);
    const std::vector<std::size_t> voxels = way_back(m_central, middle, in_tree);
    double way = double(m_lumen.depth(middle));
    for (std::size_t i = 1; i < voxels.size(); ++i)
      way += length(m_lumen.patient(voxels[i]) - m_lumen.patient(voxels[i - 1]));
    // What the root covers may hold the other end of a short vessel.
    const bool is_new = !m_covered[middle] || m_tree.points.size() == 1;
    const bool is_branch = is_new && way >= m_options.least_branch_mm + double(m_lumen.depth(voxels.back()));
    if (is_branch) grow(voxels);
    for (const std::size_t v : way_back(m_central, end, in_tree)) cover(v);
    for (const std::size_t v : voxels) cover(v);
    return is_branch;
  }

  void grow(const std::vector<std::size_t>& voxels) {
    std::vector<CentrePoint> line;
    line.push_back(m_tree.points[std::size_t(m_point[voxels.back()])]);
    for (std::size_t i = voxels.size() - 1; i-- > 0;) line.push_back(m_lumen.point(voxels[i]));
    straighten(line);
    extend(line, m_lumen);
    if (m_first.empty()) m_first = line;
    int parent = m_point[voxels.back()];
    for (std::size_t i = 1; i < line.size(); ++i) {
      const int point = int(m_tree.points.size());
      if (i < voxels.size()) m_point[voxels[voxels.size() - 1 - i]] = point;
      m_tree.points.push_back(line[i]);
      m_tree.parent.push_back(parent);
      parent = point;
    }
    m_tree.ends.push_back(parent);
  }

  /// The root's own end: the points from its wall on come before all others.
  void extend_root() {
    if (m_first.empty()) return;
    std::vector<CentrePoint> back(m_first.rbegin(), m_first.rend());
    const std::size_t was = back.size();
    extend(back, m_lumen);
    const int more = int(back.size() - was);
    CentreTree out;
    for (std::size_t i = back.size(); i-- > was;) {
      out.parent.push_back(int(out.points.size()) - 1);
      out.points.push_back(back[i]);
    }
    for (std::size_t i = 0; i < m_tree.points.size(); ++i) {
      out.points.push_back(m_tree.points[i]);
      out.parent.push_back(i == 0 ? more - 1 : m_tree.parent[i] + more);
    }
    for (const int end : m_tree.ends) out.ends.push_back(end + more);
    m_tree = std::move(out);
  }
};

}  // namespace

std::vector<CentrePoint> centre_line(const Labels& labels, int label, Vec3d from_mm, Vec3d to_mm) {
  const Lumen lumen(labels, label);
  const std::size_t from = lumen.nearest(from_mm), to = lumen.nearest(to_mm);
  const Lumen::Ways ways = lumen.ways(from, true);
  core::require(ways.cost[to] < kFar, "both places must be in one part of the label");
  std::vector<std::size_t> voxels = way_back(ways, to, [](std::size_t) { return false; });
  std::reverse(voxels.begin(), voxels.end());
  std::vector<CentrePoint> out;
  for (const std::size_t v : voxels) out.push_back(lumen.point(v));
  straighten(out);
  return out;
}

CentreTree centre_tree(const Labels& labels, int label, const TreeOptions& options) {
  const Lumen lumen(labels, label);
  Surroundings around(lumen);
  const std::size_t root = around.middle_near(options.root_mm ? lumen.nearest(*options.root_mm) : choose_root(lumen));
  return TreeBuilder(lumen, around, root, options).build();
}

}  // namespace trocar::volumes
