#include <algorithm>
#include <cmath>

#include <trocar/view/anatomy/bowel_loops.hpp>
#include <trocar/view/anatomy/gut_line.hpp>
#include <trocar/view/anatomy/omentum_lobe.hpp>
#include <trocar/view/base/looks.hpp>
#include <trocar/view/base/relief.hpp>
#include <trocar/view/bodies/cavity.hpp>

namespace trocar::view {
namespace {

constexpr double kRadius = 0.0105;   // [m] of small bowel
constexpr double kFloor = 0.35;      // cosine between up and the normal of what counts as a floor
constexpr double kEnd = 0.016;       // [m] of the large bowel's end around its last vertex
constexpr double kLoopBack = 0.012;  // [m] that its continuation begins inside it

/// A place on the border and across it.
struct Edge {
  Vec3d at, out, up;
};

/// The longest run of the border that is a floor.
std::vector<Edge> floor_of(const sim::Model& model, const tissue::Skin& wall) {
  const Vec3d up = -normalised(model.gravity, Vec3d{0, 0, -1});
  std::vector<Edge> best;
  for (const std::vector<int>& loop : border_loops(wall)) {
    std::vector<Edge> run;
    for (std::size_t i = 0; i < 2 * loop.size(); ++i) {
      const int v = loop[i % loop.size()], next = loop[(i + 1) % loop.size()];
      const Vec3d n = vec_cast<double>(wall.rest_normal[std::size_t(v)]);
      const Vec3d a = vec_cast<double>(wall.rest[std::size_t(v)]), b = vec_cast<double>(wall.rest[std::size_t(next)]);
      if (dot(n, up) > kFloor)
        run.push_back({a, normalised(cross(b - a, n)), n});
      else
        run.clear();
      if (run.size() > best.size() && run.size() <= loop.size()) best = run;
    }
  }
  return best;
}

/// The floor's border as a scale: how far along it, from the large bowel's side, and how far in from it.
class Floor {
 public:
  Floor(std::vector<Edge> edges, const WallSurface& walls, Vec3d first) : m_edges(std::move(edges)), m_walls(&walls) {
    if (length(m_edges.back().at - first) < length(m_edges.front().at - first))
      std::reverse(m_edges.begin(), m_edges.end());
    m_way = {0};
    for (std::size_t i = 1; i < m_edges.size(); ++i)
      m_way.push_back(m_way.back() + length(m_edges[i].at - m_edges[i - 1].at));
  }

  double length_of() const { return m_way.back(); }

  /// @param t 0 at the large bowel's side, 1 at the other. @param in [m] from the border; negative: beyond it
  /// @param high [m] above the floor
  Vec3d at(double t, double in, double high) const {
    const double s = std::clamp(t, 0.0, 1.0) * m_way.back();
    const auto i =
        std::min(std::size_t(std::upper_bound(m_way.begin(), m_way.end(), s) - m_way.begin()) - 1, m_edges.size() - 2);
    const double w = (s - m_way[i]) / std::max(m_way[i + 1] - m_way[i], 1e-9);
    const Edge &a = m_edges[i], &b = m_edges[i + 1];
    const Vec3d out = normalised((1 - w) * a.out + w * b.out), up = normalised((1 - w) * a.up + w * b.up);
    const Vec3d p = (1 - w) * a.at + w * b.at - in * out;
    const WallSurface::Place floor = m_walls->nearest(p);
    if (in <= 0 || !floor.there) return p + high * up;
    return floor.point + high * floor.normal;
  }
  Vec3d up_at(double t) const { return m_edges[std::size_t(t * double(m_edges.size() - 1))].up; }

 private:
  std::vector<Edge> m_edges;
  std::vector<double> m_way;
  const WallSurface* m_walls;
};

/// Where a large bowel's skin ends: the end's middle, its way out of there, its radius.
struct GutEnd {
  Vec3d middle, onward;
  double radius = 0;
};

/// The skin's vertex nearest to the border.
Vec3d tip_at(const tissue::Skin& skin, const std::vector<Edge>& edges) {
  Vec3d tip{};
  double nearest = 1;
  for (const Vec3f& v : skin.rest)
    for (const Edge& e : edges)
      if (const double d = length(vec_cast<double>(v) - e.at); d < nearest) {
        nearest = d;
        tip = vec_cast<double>(v);
      }
  return tip;
}

/// Its vertex farthest from there: the other end.
Vec3d tip_beyond(const tissue::Skin& skin, Vec3d first) {
  Vec3d tip = first;
  for (const Vec3f& v : skin.rest)
    if (length(vec_cast<double>(v) - first) > length(tip - first)) tip = vec_cast<double>(v);
  return tip;
}

GutEnd end_at(const tissue::Skin& skin, Vec3d tip) {
  const auto mean = [&](double from, double to) {
    Vec3d sum{};
    int count = 0;
    for (const Vec3f& v : skin.rest) {
      const Vec3d p = vec_cast<double>(v);
      if (length(p - tip) < from || length(p - tip) > to) continue;
      sum += p;
      ++count;
    }
    return count > 0 ? (1.0 / count) * sum : tip;
  };
  GutEnd end;
  const Vec3d last = mean(0, kEnd), before = mean(2 * kEnd, 3 * kEnd);
  end.onward = normalised(last - before);
  for (const Vec3f& v : skin.rest) {
    const Vec3d d = vec_cast<double>(v) - last;
    const double along = dot(d, end.onward);
    if (std::fabs(along) < 0.006) end.radius = std::max(end.radius, length(d - along * end.onward));
  }
  end.middle = last;
  return end;
}

/// Continues from the large bowel's end over the border and is lost under the peritoneum there.
GutLine large_bowel(const GutEnd& end, const Floor& floor) {
  const Vec3d up = floor.up_at(0.3);
  const Vec3d away = normalised(end.onward - 0.25 * up);
  const Vec3d knots[] = {end.middle - kLoopBack * end.onward,    end.middle,
                         end.middle + 0.02 * end.onward,         end.middle + 0.042 * away,
                         end.middle + 0.065 * away - 0.012 * up, end.middle + 0.085 * away - 0.05 * up};
  GutLine line;
  line.points = line_through(knots);
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    const double along = kGutStep * double(i) - kLoopBack;  // inside its end first, then around it, as the next bulge
    line.radius.push_back(end.radius * (0.8 + 0.18 * smooth(-0.6 * kLoopBack, 0.004, along)) *
                          (1 + 0.07 * std::sin(6.283 * along / 0.027 - 0.4)));
    line.hold.push_back(1);
  }
  return line;
}

/// At its other end the rectum continues behind the womb and down below the floor of the pouch.
GutLine rectum(const GutEnd& end, Vec3d up) {
  const Vec3d away = normalised(end.onward - dot(end.onward, up) * up, end.onward);
  const Vec3d knots[] = {end.middle - kLoopBack * end.onward,    end.middle,
                         end.middle + 0.012 * end.onward,        end.middle + 0.026 * away - 0.006 * up,
                         end.middle + 0.036 * away - 0.022 * up, end.middle + 0.04 * away - 0.05 * up};
  GutLine line;
  line.points = line_through(knots);
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    const double along = kGutStep * double(i) - kLoopBack;
    line.radius.push_back(end.radius * (0.8 + 0.18 * smooth(-0.6 * kLoopBack, 0.004, along)));
    line.hold.push_back(1);
  }
  return line;
}

/// From beyond the border in and out again, each leg beside the one before, then back over them, into the pouch as far
/// as it stays clear of where blood gathers, and out.
GutLine small_bowel(const Floor& floor) {
  constexpr double low = 0.9 * kRadius, high = 2.5 * kRadius;
  struct Knot {
    double t, in, high;
  };
  constexpr Knot knots[] = {{0.50, -0.055, -0.03}, {0.50, -0.030, low},  {0.51, 0.004, low},   {0.53, 0.028, low},
                            {0.575, 0.044, low},   {0.63, 0.034, low},   {0.64, 0.014, low},   {0.65, -0.010, low},
                            {0.69, -0.026, low},   {0.74, -0.012, low},  {0.745, 0.020, low},  {0.755, 0.034, low},
                            {0.79, 0.045, low},    {0.86, 0.050, low},   {0.95, 0.046, low},   {1.0, 0.040, 0.020},
                            {0.96, 0.050, high},   {0.90, 0.058, high},  {0.84, 0.052, high},  {0.80, 0.032, high},
                            {0.75, 0.016, high},   {0.68, 0.006, high},  {0.61, -0.008, high}, {0.58, -0.030, high},
                            {0.56, -0.055, 0.01},  {0.55, -0.075, -0.03}};
  std::vector<Vec3d> places;
  for (const Knot& k : knots) places.push_back(floor.at(k.t, k.in, k.high));
  GutLine line;
  line.points = line_through(places);
  const std::size_t n = line.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    line.radius.push_back(kRadius * (1 + 0.08 * std::sin(0.11 * double(i))));
    line.hold.push_back(smooth(0.045, 0.015, kGutStep * double(std::min(i, n - 1 - i))));
  }
  return line;
}

/// The omentum hangs over the floor's border in two tongues; between them the pouch stays open.
LobeOutline lobe_outline(const Floor& floor) {
  struct Knot {
    double t, in;
  };
  constexpr Knot knots[] = {{0.10, -0.03}, {0.16, 0.010}, {0.21, 0.026}, {0.26, 0.028}, {0.34, 0.019}, {0.46, 0.004},
                            {0.62, 0.004}, {0.70, 0.016}, {0.78, 0.036}, {0.86, 0.042}, {0.93, 0.022}, {1.0, -0.02}};
  constexpr double root = -0.045, step = 0.0016;  // [m]
  LobeOutline outline;
  const auto columns = std::size_t(floor.length_of() / step);
  for (std::size_t i = 0, k = 0; i < columns; ++i) {
    const double t = knots[0].t + (1 - knots[0].t) * double(i) / double(columns - 1);
    while (k + 2 < std::size(knots) && knots[k + 1].t < t) ++k;
    const double in = knots[k].in + (knots[k + 1].in - knots[k].in) * smooth(knots[k].t, knots[k + 1].t, t);
    outline.border.push_back(floor.at(t, in, 0));
    outline.root.push_back(floor.at(t, root, 0));
  }
  return outline;
}

/// Everything that it may lie on.
std::vector<Vec3d> ground_of(const sim::Model& model, const tissue::Skin& large, const BowelLoops& loops,
                             const WallSurface& walls) {
  std::vector<Vec3d> points;
  const auto take = [&](const std::vector<Vec3f>& from) {
    for (const Vec3f& p : from) points.push_back(vec_cast<double>(p));
  };
  take(large.rest);
  take(model.walls.front().skin.rest);
  take(walls.cavity().positions);
  take(loops.small.positions);
  take(loops.large.positions);
  return points;
}

}  // namespace

BowelLoops bowel_loops(const sim::Model& model, const WallSurface& walls) {
  BowelLoops loops;
  const auto large = std::find_if(model.solids.begin(), model.solids.end(), [&](const sim::SolidModel& s) {
    return look(model, s.look).has(Look::Generator::bowel_loops);
  });
  if (model.walls.empty() || large == model.solids.end()) return loops;
  const std::vector<Edge> edges = floor_of(model, model.walls.front().skin);
  if (edges.size() < 8) return loops;
  const GutEnd end = end_at(large->fine, tip_at(large->fine, edges));
  const Floor floor(edges, walls, end.middle);
  std::vector<GutLine> lines{large_bowel(end, floor), small_bowel(floor)};
  std::vector<Vec3d> bodies;
  for (std::size_t i = 0; i < large->fine.rest.size(); i += 2) bodies.push_back(vec_cast<double>(large->fine.rest[i]));
  settle(lines, bodies, walls);
  const Vec3d up = -normalised(model.gravity, Vec3d{0, 0, -1});
  loops.large = gut(lines[0], up, 1);
  const MeshBuffer other = gut(rectum(end_at(large->fine, tip_beyond(large->fine, end.middle)), up), up, 3);
  append(loops.large, other, Mat3f::identity(), {});
  loops.large.rest.insert(loops.large.rest.end(), other.rest.begin(), other.rest.end());
  loops.large.normals.insert(loops.large.normals.end(), other.normals.begin(), other.normals.end());
  loops.small = gut(lines[1], up, 2);
  loops.omentum = omentum_lobe(lobe_outline(floor), ground_of(model, large->fine, loops, walls), up);
  return loops;
}

}  // namespace trocar::view
