#include "interpenetration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <ostream>
#include <utility>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/objects/object_kinds.hpp>
#include <trocar/tissue/tets/cuttable_skin.hpp>

namespace trocar {
namespace {

using Kind = BodySurface::Kind;

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr double kLeast = 1e-9;  // depth that counts [m]

struct Box3 {
  Vec3d low{kFar, kFar, kFar}, high{-kFar, -kFar, -kFar};

  void add(Vec3d p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  void add(const Box3& b) { add(b.low), add(b.high); }
  void grow(double by) { low -= Vec3d{by, by, by}, high += Vec3d{by, by, by}; }
  bool meets(const Box3& o, double margin) const {
    return low.x <= o.high.x + margin && o.low.x <= high.x + margin && low.y <= o.high.y + margin &&
           o.low.y <= high.y + margin && low.z <= o.high.z + margin && o.low.z <= high.z + margin;
  }
  bool has(Vec3d p, double margin) const {
    return p.x >= low.x - margin && p.x <= high.x + margin && p.y >= low.y - margin && p.y <= high.y + margin &&
           p.z >= low.z - margin && p.z <= high.z + margin;
  }
  double distance2(Vec3d p) const {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      const double off = std::max({low[k] - p[k], p[k] - high[k], 0.0});
      sum += off * off;
    }
    return sum;
  }
  double size() const { return length(high - low); }
};

/// Halves of halves of boxes.
class Tree {
 public:
  struct Node {
    Box3 box;
    int first = 0, last = 0;  ///< of order()
    int right = -1;           ///< the second half, the first is the next node; -1: a leaf
  };

  void build(std::vector<Box3> boxes) {
    m_boxes = std::move(boxes);
    m_order.resize(m_boxes.size());
    std::iota(m_order.begin(), m_order.end(), 0);
    m_nodes.clear();
    if (!m_order.empty()) grow(0, int(m_order.size()));
  }
  bool empty() const { return m_nodes.empty(); }
  const std::vector<Node>& nodes() const { return m_nodes; }
  const Node& node(int n) const { return m_nodes[size_t(n)]; }
  int item(int k) const { return m_order[size_t(k)]; }
  const Box3& box(int i) const { return m_boxes[size_t(i)]; }

 private:
  std::vector<Box3> m_boxes;
  std::vector<int> m_order;
  std::vector<Node> m_nodes;

  int grow(int first, int last) {
    const int number = int(m_nodes.size());
    m_nodes.push_back({{}, first, last, -1});
    Box3 box, middles;
    for (int k = first; k < last; ++k) {
      box.add(m_boxes[size_t(item(k))]);
      middles.add(middle(item(k)));
    }
    m_nodes[size_t(number)].box = box;
    if (last - first <= 4) return number;
    const Vec3d extent = middles.high - middles.low;
    const int axis = extent.x >= extent.y ? (extent.x >= extent.z ? 0 : 2) : (extent.y >= extent.z ? 1 : 2);
    const int half = (first + last) / 2;
    std::nth_element(m_order.begin() + first, m_order.begin() + half, m_order.begin() + last,
                     [&](int a, int b) { return middle(a)[axis] < middle(b)[axis]; });
    grow(first, half);
    const int right = grow(half, last);
    m_nodes[size_t(number)].right = right;
    return number;
  }
  Vec3d middle(int i) const { return 0.5 * (m_boxes[size_t(i)].low + m_boxes[size_t(i)].high); }
};

/// f(i, j) for all items of both whose boxes are no further apart than the margin.
template <class F>
void each_pair(const Tree& a, int m, const Tree& b, int n, double margin, F& f) {
  const Tree::Node &p = a.node(m), &q = b.node(n);
  if (!p.box.meets(q.box, margin)) return;
  if (p.right < 0 && q.right < 0) {
    for (int k = p.first; k < p.last; ++k)
      for (int l = q.first; l < q.last; ++l)
        if (a.box(a.item(k)).meets(b.box(b.item(l)), margin)) f(a.item(k), b.item(l));
  } else if (q.right < 0 || (p.right >= 0 && p.box.size() > q.box.size())) {
    each_pair(a, m + 1, b, n, margin, f);
    each_pair(a, p.right, b, n, margin, f);
  } else {
    each_pair(a, m, b, n + 1, margin, f);
    each_pair(a, m, b, q.right, margin, f);
  }
}
template <class F>
void each_pair(const Tree& a, const Tree& b, double margin, F&& f) {
  if (!a.empty() && !b.empty()) each_pair(a, 0, b, 0, margin, f);
}
/// Of one tree: every pair once.
template <class F>
void each_pair_within(const Tree& t, int n, double margin, F& f) {
  const Tree::Node& p = t.node(n);
  if (p.right < 0) {
    for (int k = p.first; k < p.last; ++k)
      for (int l = k + 1; l < p.last; ++l)
        if (t.box(t.item(k)).meets(t.box(t.item(l)), margin)) f(t.item(k), t.item(l));
    return;
  }
  each_pair_within(t, n + 1, margin, f);
  each_pair_within(t, p.right, margin, f);
  each_pair(t, n + 1, t, p.right, margin, f);
}

struct Near {
  double distance = kFar;
  int triangle = -1;
  Vec3d point, weights;
};

/// An edge through a triangle.
struct Crossing {
  int edge = 0, triangle = 0;
  double t = 0;  ///< on the edge, 0 .. 1
  Vec3d place;
};

/// What goes together when some links are left out.
class Pieces {
 public:
  explicit Pieces(size_t points) : m_parent(points) { std::iota(m_parent.begin(), m_parent.end(), 0); }
  int of(int i) {
    while (m_parent[size_t(i)] != i) i = m_parent[size_t(i)] = m_parent[size_t(m_parent[size_t(i)])];
    return i;
  }
  void join(int i, int j) { m_parent[size_t(of(i))] = of(j); }

 private:
  std::vector<int> m_parent;
};

/// A surface with what is asked of it.
class Shape {
 public:
  explicit Shape(const BodySurface& surface) : s(surface) {
    std::vector<Box3> boxes;
    for (const auto& t : s.triangles) {
      Box3 box;
      for (const int v : t) box.add(at(v));
      boxes.push_back(box);
    }
    for (const BodySurface::Capsule& c : s.capsules) {
      Box3 box;
      box.add(at(c.a)), box.add(at(c.b));
      box.grow(c.radius);
      boxes.push_back(box);
    }
    tree.build(std::move(boxes));
    if (!tree.empty()) bounds = tree.node(0).box;
    if (s.kind != Kind::tube) index();
  }

  const BodySurface& s;
  Tree tree;                              ///< of triangles or capsules
  Box3 bounds;                            ///< without thickness
  std::vector<int> vertices;              ///< points that a triangle uses
  std::vector<std::array<int, 2>> edges;  ///< lower point first
  std::vector<std::array<int, 3>> own;    ///< (triangles) edges that are looked at with it; -1: with another triangle
  std::vector<int> border_edges;          ///< those that have one triangle
  std::vector<Vec3d> normal;              ///< (points) outward, weighted by angles, not unit
  std::vector<std::vector<int>> around;   ///< (points) triangles

  Vec3d at(int point) const { return s.points[size_t(point)]; }
  std::array<Vec3d, 3> corners(int t) const {
    const auto& v = s.triangles[size_t(t)];
    return {at(v[0]), at(v[1]), at(v[2])};
  }
  Vec3d area_vector(int t) const {
    const auto [a, b, c] = corners(t);
    return cross(b - a, c - a);
  }

  /// @param enough  it need not be nearer: any triangle within this will do [m]
  template <class Counts>
  Near nearest(Vec3d p, double enough, Counts&& counts) const {
    Near best;
    double best2 = kFar;
    const double enough2 = enough > 0 ? enough * enough : 0;
    std::array<std::pair<double, int>, 64> waiting;
    int count = 0;
    if (!tree.empty()) waiting[size_t(count++)] = {tree.node(0).box.distance2(p), 0};
    while (count > 0 && best2 > enough2) {
      const auto [far2, n] = waiting[size_t(--count)];
      if (far2 >= best2) continue;
      const Tree::Node& node = tree.node(n);
      if (node.right < 0) {
        for (int k = node.first; k < node.last; ++k) {
          const int t = tree.item(k);
          if (tree.box(t).distance2(p) >= best2) continue;
          const auto [a, b, c] = corners(t);
          const auto foot = geometry::closest_on_triangle(p, a, b, c);
          if (foot.distance2 >= best2 || !counts(t, foot.point)) continue;
          best2 = foot.distance2;
          best = {0, t, foot.point, foot.weights};
        }
        continue;
      }
      const double left2 = tree.node(n + 1).box.distance2(p), right2 = tree.node(node.right).box.distance2(p);
      const std::pair<double, int> left{left2, n + 1}, right{right2, node.right};
      waiting[size_t(count++)] = left2 < right2 ? right : left;
      waiting[size_t(count++)] = left2 < right2 ? left : right;
    }
    best.distance = std::sqrt(best2);
    return best;
  }
  Near nearest(Vec3d p, double enough = 0) const {
    return nearest(p, enough, [](int, Vec3d) { return true; });
  }

  /// Generalised winding number; far triangles together as a dipole [Barill et al. 2018].
  double winding(Vec3d p) const { return tree.empty() ? 0 : solid_angle(0, p) / (4 * std::numbers::pi); }
  bool encloses(Vec3d p) const { return bounds.has(p, 0) && winding(p) >= 0.5; }

  /// To the border of an open surface [m]; far where it has none.
  double to_border(Vec3d p) const {
    double best2 = kFar;
    for (const int e : border_edges) {
      const Vec3d a = at(edges[size_t(e)][0]), b = at(edges[size_t(e)][1]);
      best2 = std::min(best2, geometry::distance2(p, a + geometry::closest_on_segment(p, a, b) * (b - a)));
    }
    return std::sqrt(best2);
  }

  int edge_of(int a, int b) const {
    const std::array<int, 2> e{std::min(a, b), std::max(a, b)};
    return int(std::lower_bound(edges.begin(), edges.end(), e) - edges.begin());
  }

 private:
  struct Dipole {
    Vec3d area{0, 0, 0}, middle{0, 0, 0};
    double radius = 0;
  };
  std::vector<Dipole> m_dipoles;  ///< (nodes of the tree)

  void index() {
    for (const auto& t : s.triangles)
      for (size_t k = 0; k < 3; ++k) {
        const int a = t[k], b = t[(k + 1) % 3];
        edges.push_back({std::min(a, b), std::max(a, b)});
        vertices.push_back(a);
      }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    std::vector<int> uses(edges.size(), 0);
    own.assign(s.triangles.size(), {-1, -1, -1});
    around.resize(s.points.size());
    normal.assign(s.points.size(), Vec3d{0, 0, 0});
    for (size_t i = 0; i < s.triangles.size(); ++i) {
      const auto& t = s.triangles[i];
      const Vec3d out = normalised(area_vector(int(i)), Vec3d{0, 0, 0});
      for (size_t k = 0; k < 3; ++k) {
        const int e = edge_of(t[k], t[(k + 1) % 3]);
        if (uses[size_t(e)]++ == 0) own[i][k] = e;
        around[size_t(t[k])].push_back(int(i));
        const Vec3d u = at(t[(k + 1) % 3]) - at(t[k]), w = at(t[(k + 2) % 3]) - at(t[k]);
        normal[size_t(t[k])] += std::atan2(length(cross(u, w)), dot(u, w)) * out;
      }
    }
    for (size_t e = 0; e < edges.size(); ++e) {
      if (uses[e] == 1) border_edges.push_back(int(e));
    }
    m_dipoles.resize(tree.nodes().size());
    for (size_t n = 0; n < m_dipoles.size(); ++n) {
      const Tree::Node& node = tree.nodes()[n];
      Dipole& d = m_dipoles[n];
      double weight = 0;
      for (int k = node.first; k < node.last; ++k) {
        const Vec3d area = 0.5 * area_vector(tree.item(k));
        const auto [a, b, c] = corners(tree.item(k));
        d.area += area;
        d.middle += length(area) / 3 * (a + b + c);
        weight += length(area);
      }
      d.middle = weight > 0 ? d.middle / weight : 0.5 * (node.box.low + node.box.high);
      const Vec3d l = d.middle - node.box.low, h = node.box.high - d.middle;
      d.radius = length(Vec3d{std::max(l.x, h.x), std::max(l.y, h.y), std::max(l.z, h.z)});
    }
  }

  double solid_angle(int n, Vec3d p) const {
    constexpr double kFarAway = 2.5;
    const Dipole& d = m_dipoles[size_t(n)];
    const Vec3d off = d.middle - p;
    const double far2 = dot(off, off);
    if (far2 > kFarAway * kFarAway * d.radius * d.radius) return dot(d.area, off) / (far2 * std::sqrt(far2));
    const Tree::Node& node = tree.node(n);
    if (node.right >= 0) return solid_angle(n + 1, p) + solid_angle(node.right, p);
    double sum = 0;
    for (int k = node.first; k < node.last; ++k) {
      auto [a, b, c] = corners(tree.item(k));
      a -= p, b -= p, c -= p;
      const double la = length(a), lb = length(b), lc = length(c);
      // [Van Oosterom & Strackee 1983]
      sum += 2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
    }
    return sum;
  }
};

/// The deepest place of a pair so far.
struct Deepest {
  double depth = 0;
  Vec3d place{0, 0, 0};
  int crossings = 0;

  void note(double d, Vec3d at) {
    if (d > depth) depth = d, place = at;
  }
};

/// Crossings of the first one's edges with the second one's triangles, where a triangle of each is near the other.
void cross_edges(const Shape& a, int i, const Shape& b, int j, double h, std::vector<Crossing>& out, Deepest& deepest) {
  const auto [p, q, r] = b.corners(j);
  for (size_t k = 0; k < 3; ++k) {
    const int e = a.own[size_t(i)][k];
    if (e < 0) continue;
    const auto& ends = a.edges[size_t(e)];
    const Vec3d from = a.at(ends[0]), to = a.at(ends[1]);
    const auto hit = geometry::ray_triangle(from, to - from, p, q, r);
    if (hit.hit && hit.t <= 1) {
      out.push_back({e, j, hit.t, from + hit.t * (to - from)});
      deepest.note(h, out.back().place);
    } else if (h > 0) {
      const auto near = geometry::closest_segment_triangle(from, to, p, q, r);
      if (near.distance2 < h * h) deepest.note(h - std::sqrt(near.distance2), near.on_triangle);
    }
  }
}

/// Places of `other` inside of the closed one.
void into_closed(const Shape& closed, const Shape& other, double h, std::vector<Crossing>& crossings,
                 Deepest& deepest) {
  const auto look = [&](Vec3d p) {
    if (!closed.bounds.has(p, 0)) return;
    const double enough = deepest.depth - h;
    const Near near = closed.nearest(p, enough);
    if (near.distance > enough && closed.encloses(p)) deepest.note(near.distance + h, p);
  };
  for (const int v : other.vertices) look(other.at(v));
  std::sort(crossings.begin(), crossings.end(),
            [](const Crossing& x, const Crossing& y) { return x.edge != y.edge ? x.edge < y.edge : x.t < y.t; });
  for (size_t first = 0, last = 0; first < crossings.size(); first = last) {
    while (last < crossings.size() && crossings[last].edge == crossings[first].edge) ++last;
    const auto& ends = other.edges[size_t(crossings[first].edge)];
    const Vec3d a = other.at(ends[0]), b = other.at(ends[1]);
    for (size_t k = first; k <= last; ++k) {
      const double from = k == first ? 0 : crossings[k - 1].t, to = k == last ? 1 : crossings[k].t;
      if ((to - from) * length(b - a) < kLeast) continue;
      for (const double w : {0.25, 0.5, 0.75}) look(a + (from + w * (to - from)) * (b - a));
    }
  }
}

/// The place of a piece of a body that is furthest from what divides the body.
struct Far {
  double distance = 0;  ///< [m]
  Vec3d place{0, 0, 0};
};

/// How far the pieces of a body that a sheet or a wall divides reach from it.
class Reach {
 public:
  /// @param points  of the body, that are looked at
  Reach(const Shape& sheet, Kind kind, const BodySurface& body, std::span<const int> points, Pieces& pieces)
      : m_sheet(sheet), m_kind(kind), m_body(body), m_pieces(pieces), m_far(body.points.size()) {
    for (const int v : points) {
      const Vec3d p = body.points[size_t(v)];
      Far& far = m_far[size_t(pieces.of(v))];
      const double d = sheet.nearest(p).distance;
      if (d > far.distance) far = {d, p};
    }
  }

  /// Of the piece beyond a crossing, of a link from point a to point b: that behind a wall; of a sheet the one that
  /// reaches less.
  const Far& beyond(int a, int b, int triangle) const {
    const Far &at_a = m_far[size_t(m_pieces.of(a))], &at_b = m_far[size_t(m_pieces.of(b))];
    if (m_kind != Kind::wall) return at_a.distance < at_b.distance ? at_a : at_b;
    const Vec3d way = m_body.points[size_t(b)] - m_body.points[size_t(a)];
    return dot(way, m_sheet.area_vector(triangle)) < 0 ? at_b : at_a;
  }

 private:
  const Shape& m_sheet;
  Kind m_kind;
  const BodySurface& m_body;
  Pieces& m_pieces;
  std::vector<Far> m_far;  ///< (points) of the piece that is named by it
};

/// Crossings of two surfaces that divide neither: both would be apart where it is drawn back by as much as crossings
/// are away from its border.
class BorderCrossing {
 public:
  void add(const Shape& a, const Shape& b, Vec3d place, double h) {
    const double of_a = a.to_border(place), of_b = b.to_border(place);
    if (of_a > m_a.distance) m_a = {of_a, place};
    if (of_b > m_b.distance) m_b = {of_b, place};
    m_h = std::max(m_h, h);
  }
  void note(Deepest& deepest) const {
    const Far& less = m_a.distance < m_b.distance ? m_a : m_b;
    if (less.distance > 0 && less.distance < kFar) deepest.note(less.distance + m_h, less.place);
  }

 private:
  Far m_a, m_b;
  double m_h = 0;
};

/// A body that a sheet or a wall goes through.
/// @param ends       of a link of the body: an edge, or a tube's axis
/// @param thickness  of a link, its radius
/// @param crossings  of links
template <class Ends, class Thickness>
void divide(const Shape& sheet, Kind kind, const Shape& body, size_t links, Ends&& ends, Thickness&& thickness,
            std::span<const int> points, bool closed, const std::vector<Crossing>& crossings, Deepest& deepest) {
  if (crossings.empty()) return;
  std::vector<std::uint8_t> crossed(links, 0);
  for (const Crossing& c : crossings) crossed[size_t(c.edge)] = 1;
  Pieces pieces(body.s.points.size());
  for (size_t e = 0; e < links; ++e)
    if (!crossed[e]) pieces.join(ends(e)[0], ends(e)[1]);
  const Reach reach(sheet, kind, body.s, points, pieces);
  BorderCrossing border;
  for (const Crossing& c : crossings) {
    const std::array<int, 2> link = ends(size_t(c.edge));
    const double h = thickness(size_t(c.edge));
    if (pieces.of(link[0]) != pieces.of(link[1])) {
      const Far& far = reach.beyond(link[0], link[1], c.triangle);
      deepest.note(far.distance + h, far.place);
    } else if (!closed) {
      border.add(body, sheet, c.place, h);
    }
  }
  border.note(deepest);
}

void divide_mesh(const Shape& sheet, Kind kind, const Shape& body, Kind body_kind, double h,
                 const std::vector<Crossing>& crossings, Deepest& deepest) {
  divide(
      sheet, kind, body, body.edges.size(), [&](size_t e) { return body.edges[e]; }, [h](size_t) { return h; },
      body.vertices, body_kind == Kind::closed, crossings, deepest);
}

/// A sheet with what crossings divide it into.
class DividedSheet {
 public:
  DividedSheet(const Shape& sheet, const std::vector<Crossing>& crossings)
      : s(sheet), pieces(sheet.s.points.size()), far(sheet.s.points.size()) {
    std::vector<std::uint8_t> crossed(s.edges.size(), 0);
    for (const Crossing& c : crossings) crossed[size_t(c.edge)] = 1;
    for (size_t e = 0; e < s.edges.size(); ++e)
      if (!crossed[e]) pieces.join(s.edges[e][0], s.edges[e][1]);
  }
  /// @param distance  of a vertex from what divides the sheet
  template <class Distance>
  void measure(Distance&& distance) {
    for (const int v : s.vertices) {
      Far& own = far[size_t(pieces.of(v))];
      const double d = distance(v);
      if (d > own.distance && d < kFar) own = {d, s.at(v)};
    }
  }
  /// Where the points are of several pieces, of the one that reaches least, if that is less than `least`.
  void take_least(std::span<const int> points, Far& least) {
    bool several = false;
    for (const int v : points) several = several || pieces.of(v) != pieces.of(points[0]);
    for (const int v : points)
      if (several && far[size_t(pieces.of(v))].distance < least.distance) least = far[size_t(pieces.of(v))];
  }

  const Shape& s;
  Pieces pieces;
  std::vector<Far> far;  ///< (points) of the piece that is named by it
};

/// Either of the sheets that is divided there could be drawn back.
void sheets_cross(DividedSheet& of_edges, DividedSheet& of_triangles, double h, const std::vector<Crossing>& crossings,
                  BorderCrossing& border, Deepest& deepest) {
  for (const Crossing& c : crossings) {
    Far least{kFar, c.place};
    of_edges.take_least(of_edges.s.edges[size_t(c.edge)], least);
    of_triangles.take_least(of_triangles.s.s.triangles[size_t(c.triangle)], least);
    if (least.distance < kFar)
      deepest.note(least.distance + h, least.place);
    else
      border.add(of_edges.s, of_triangles.s, c.place, h);
  }
}

void sheet_on_sheet(const Shape& a, const Shape& b, double h, const std::vector<Crossing>& of_a,
                    const std::vector<Crossing>& of_b, Deepest& deepest) {
  if (of_a.empty() && of_b.empty()) return;
  DividedSheet divided_a(a, of_a), divided_b(b, of_b);
  divided_a.measure([&](int v) { return b.nearest(a.at(v)).distance; });
  divided_b.measure([&](int v) { return a.nearest(b.at(v)).distance; });
  BorderCrossing border;
  sheets_cross(divided_a, divided_b, h, of_a, border, deepest);
  border.note(deepest);
  border = {};
  sheets_cross(divided_b, divided_a, h, of_b, border, deepest);
  border.note(deepest);
}

void mesh_on_mesh(const Shape& a, Kind kind_a, const Shape& b, Kind kind_b, Deepest& deepest) {
  const double h = a.s.half_thickness + b.s.half_thickness;
  std::vector<Crossing> of_a, of_b;  // edges of a through b, edges of b through a
  each_pair(a.tree, b.tree, h, [&](int i, int j) {
    cross_edges(a, i, b, j, h, of_a, deepest);
    cross_edges(b, j, a, i, h, of_b, deepest);
  });
  deepest.crossings = int(of_a.size() + of_b.size());
  if (kind_a == Kind::sheet && kind_b == Kind::sheet) return sheet_on_sheet(a, b, h, of_a, of_b, deepest);
  if (kind_a == Kind::closed) into_closed(a, b, h, of_b, deepest);
  if (kind_b == Kind::closed) into_closed(b, a, h, of_a, deepest);
  if (kind_a != Kind::closed && kind_b != Kind::wall) divide_mesh(a, kind_a, b, kind_b, h, of_b, deepest);
  if (kind_b != Kind::closed && kind_a != Kind::wall) divide_mesh(b, kind_b, a, kind_a, h, of_a, deepest);
}

/// f(place, radius) along the axes of a tube.
template <class F>
void each_axis_point(const BodySurface& tube, F&& f) {
  for (const BodySurface::Capsule& c : tube.capsules) {
    const Vec3d a = tube.points[size_t(c.a)], b = tube.points[size_t(c.b)];
    const double step = std::max(c.radius, 0.0005);
    const int parts = c.a == c.b ? 1 : std::clamp(int(std::ceil(length(b - a) / step)), 1, 256);
    for (int k = 0; k <= parts; ++k) f(a + (double(k) / parts) * (b - a), c.radius);
  }
}

/// A place of the tube inside of the closed one, and the one of its surface that is deeper.
void tube_into_closed(const Shape& closed, const Shape& tube, double h, Deepest& deepest) {
  each_axis_point(tube.s, [&](Vec3d p, double radius) {
    if (!closed.bounds.has(p, 0)) return;
    const double enough = deepest.depth - h - radius;
    const Near near = closed.nearest(p, enough);
    if (near.distance <= enough || !closed.encloses(p)) return;
    deepest.note(near.distance + h, p);
    const Vec3d q = p + radius * normalised(p - near.point, Vec3d{0, 0, 0});
    if (closed.encloses(q)) deepest.note(closed.nearest(q).distance + h, q);
  });
}

void divide_tube(const Shape& sheet, Kind kind, const Shape& tube, double h, const std::vector<Crossing>& crossings,
                 Deepest& deepest) {
  const auto& capsules = tube.s.capsules;
  std::vector<int> points;
  for (const BodySurface::Capsule& c : capsules) points.push_back(c.a), points.push_back(c.b);
  divide(
      sheet, kind, tube, capsules.size(),
      [&](size_t e) {
        return std::array<int, 2>{capsules[e].a, capsules[e].b};
      },
      [&](size_t e) { return capsules[e].radius + h; }, points, false, crossings, deepest);
}

void tube_on_mesh(const Shape& tube, const Shape& mesh, Kind kind, Deepest& deepest) {
  const double h = mesh.s.half_thickness + tube.s.half_thickness;
  std::vector<Crossing> crossings;
  each_pair(tube.tree, mesh.tree, h, [&](int i, int j) {
    const BodySurface::Capsule& c = tube.s.capsules[size_t(i)];
    const auto [p, q, r] = mesh.corners(j);
    const auto near = geometry::closest_segment_triangle(tube.at(c.a), tube.at(c.b), p, q, r);
    deepest.note(c.radius + h - std::sqrt(near.distance2), near.on_triangle);
    if (c.a != c.b && !(near.distance2 > 0)) crossings.push_back({i, j, near.s, near.on_segment});
  });
  deepest.crossings = int(crossings.size());
  if (kind == Kind::closed) tube_into_closed(mesh, tube, h, deepest);
  if (kind != Kind::closed) divide_tube(mesh, kind, tube, h, crossings, deepest);
}

void capsule_on_capsule(const Shape& a, const BodySurface::Capsule& p, const Shape& b, const BodySurface::Capsule& q,
                        double h, Deepest& deepest) {
  const auto near = geometry::closest_segments(a.at(p.a), a.at(p.b), b.at(q.a), b.at(q.b));
  const double overlap = p.radius + q.radius - std::sqrt(near.distance2);
  deepest.note(std::min(std::max(p.radius, q.radius), overlap) + h, 0.5 * (near.on_first + near.on_second));
}

void tube_on_tube(const Shape& a, const Shape& b, Deepest& deepest) {
  const double h = a.s.half_thickness + b.s.half_thickness;
  each_pair(a.tree, b.tree, h, [&](int i, int j) {
    capsule_on_capsule(a, a.s.capsules[size_t(i)], b, b.s.capsules[size_t(j)], h, deepest);
  });
}

void tube_on_itself(const Shape& a, Deepest& deepest) {
  const auto& capsules = a.s.capsules;
  std::vector<double> arc(capsules.size() + 1, 0);  // where each begins; a gap is endless
  for (size_t e = 0; e < capsules.size(); ++e) {
    if (e > 0 && capsules[e].a != capsules[e - 1].b) arc[e] += 1e6;
    arc[e + 1] = arc[e] + length(a.at(capsules[e].b) - a.at(capsules[e].a));
  }
  auto look = [&](int i, int j) {
    const size_t first = size_t(std::min(i, j)), last = size_t(std::max(i, j));
    const BodySurface::Capsule &p = capsules[first], &q = capsules[last];
    const auto near = geometry::closest_segments(a.at(p.a), a.at(p.b), a.at(q.a), a.at(q.b));
    const double from = arc[first] + near.s * length(a.at(p.b) - a.at(p.a));
    const double to = arc[last] + near.t * length(a.at(q.b) - a.at(q.a));
    if (to - from > 2 * (p.radius + q.radius)) capsule_on_capsule(a, p, a, q, 0, deepest);
  };
  if (!a.tree.empty()) each_pair_within(a.tree, 0, 0, look);
}

bool share_point(const std::array<int, 3>& t, const std::array<int, 3>& u) {
  for (const int v : t)
    if (v == u[0] || v == u[1] || v == u[2]) return true;
  return false;
}

/// Edges of a surface through triangles of it that are no neighbours.
std::vector<Crossing> crossings_within(const Shape& a) {
  std::vector<Crossing> out;
  Deepest unused;
  auto look = [&](int i, int j) {
    if (share_point(a.s.triangles[size_t(i)], a.s.triangles[size_t(j)])) return;
    cross_edges(a, i, a, j, 0, out, unused);
    cross_edges(a, j, a, i, 0, out, unused);
  };
  if (!a.tree.empty()) each_pair_within(a.tree, 0, 0, look);
  return out;
}

/// One piece of a surface that passes through itself: what crossings bound it.
struct OwnPiece {
  std::vector<int> vertices;
  std::vector<Vec3d> rim;

  /// To the nearest crossing: both parts pass through it, so neither is further away.
  double to_rim(Vec3d p) const {
    double best2 = kFar;
    for (const Vec3d& q : rim) best2 = std::min(best2, geometry::distance2(p, q));
    return std::sqrt(best2);
  }
};

std::vector<OwnPiece> own_pieces(const Shape& a, const std::vector<Crossing>& crossings, Pieces& pieces) {
  std::vector<std::uint8_t> crossed(a.edges.size(), 0);
  for (const Crossing& c : crossings) crossed[size_t(c.edge)] = 1;
  for (size_t e = 0; e < a.edges.size(); ++e)
    if (!crossed[e]) pieces.join(a.edges[e][0], a.edges[e][1]);
  std::vector<OwnPiece> out(a.s.points.size());
  for (const int v : a.vertices) out[size_t(pieces.of(v))].vertices.push_back(v);
  for (const Crossing& c : crossings) {
    const auto& t = a.s.triangles[size_t(c.triangle)];
    std::vector<int> at;
    for (const int v : {a.edges[size_t(c.edge)][0], a.edges[size_t(c.edge)][1], t[0], t[1], t[2]})
      at.push_back(pieces.of(v));
    std::sort(at.begin(), at.end());
    at.erase(std::unique(at.begin(), at.end()), at.end());
    for (const int p : at) out[size_t(p)].rim.push_back(c.place);
  }
  return out;
}

/// Is the winding number not 0 right outside of a piece? Most of its vertices decide.
bool is_inside_another(const Shape& a, const OwnPiece& piece) {
  constexpr double kOutside = 2e-6;  // [m]
  constexpr size_t kMost = 33;
  int inside = 0, all = 0;
  const size_t step = std::max<size_t>(1, piece.vertices.size() / kMost);
  for (size_t k = 0; k < piece.vertices.size(); k += step) {
    const int v = piece.vertices[k];
    const double w = a.winding(a.at(v) + kOutside * normalised(a.normal[size_t(v)], Vec3d{0, 0, 0}));
    ++all, inside += std::fabs(w) >= 0.5;
  }
  return 2 * inside > all;
}

void closed_on_itself(const Shape& a, Deepest& deepest) {
  const std::vector<Crossing> crossings = crossings_within(a);
  deepest.crossings = int(crossings.size());
  Pieces pieces(a.s.points.size());
  const std::vector<OwnPiece> own = own_pieces(a, crossings, pieces);
  const auto filled = std::count_if(own.begin(), own.end(), [](const OwnPiece& p) { return !p.vertices.empty(); });
  if (filled < 2) return;
  for (const OwnPiece& piece : own) {
    if (piece.vertices.empty() || !is_inside_another(a, piece)) continue;
    for (const int v : piece.vertices) {
      const Vec3d p = a.at(v);
      const double rim = piece.to_rim(p);
      if (rim <= deepest.depth) continue;
      const int own_piece = pieces.of(v);
      const Near near = a.nearest(p, deepest.depth, [&](int t, Vec3d) {
        for (const int u : a.s.triangles[size_t(t)])
          if (pieces.of(u) == own_piece) return false;  // also the other side of the same part
        return true;
      });
      if (std::min(rim, near.distance) < kFar) deepest.note(std::min(rim, near.distance), p);
    }
  }
}

void sheet_on_itself(const Shape& a, Deepest& deepest) {
  const std::vector<Crossing> crossings = crossings_within(a);
  deepest.crossings = int(crossings.size());
  if (crossings.empty()) return;
  DividedSheet divided(a, crossings);
  divided.measure([&](int v) {
    const auto of_another = [&](int t, Vec3d) {
      for (const int u : a.s.triangles[size_t(t)])
        if (divided.pieces.of(u) == divided.pieces.of(v)) return false;
      return true;
    };
    double least = a.nearest(a.at(v), 0, of_another).distance;
    for (const Crossing& c : crossings) least = std::min(least, length(c.place - a.at(v)));
    return least;
  });
  BorderCrossing border;
  sheets_cross(divided, divided, 0, crossings, border, deepest);
  border.note(deepest);
}

void on_itself(const Shape& a, Deepest& deepest) {
  if (a.s.kind == Kind::tube)
    tube_on_itself(a, deepest);
  else if (a.s.kind == Kind::closed)
    closed_on_itself(a, deepest);
  else if (a.s.kind == Kind::sheet)
    sheet_on_itself(a, deepest);
}

bool names(const std::vector<int>& list, int other) { return std::find(list.begin(), list.end(), other) != list.end(); }

/// As the other one meets it: from inside, a closed membrane is a sheet.
Kind kind_for(const BodySurface& s, int own, const BodySurface& other) {
  return other.inside == own ? Kind::sheet : s.kind;
}

void one_on_other(const Shape& a, int i, const Shape& b, int j, Deepest& deepest) {
  const Kind kind_a = kind_for(a.s, i, b.s), kind_b = kind_for(b.s, j, a.s);
  if (a.s.body.is(BodyKind::wall) && b.s.body.is(BodyKind::wall)) return;  // they do not move
  if (!a.bounds.meets(b.bounds, a.s.half_thickness + b.s.half_thickness)) return;
  if (kind_a == Kind::tube && kind_b == Kind::tube)
    tube_on_tube(a, b, deepest);
  else if (kind_a == Kind::tube)
    tube_on_mesh(a, b, kind_b, deepest);
  else if (kind_b == Kind::tube)
    tube_on_mesh(b, a, kind_a, deepest);
  else
    mesh_on_mesh(a, kind_a, b, kind_b, deepest);
}

// Surfaces of a scene

/// Numbers of surfaces: organs, membranes, strands, walls, rigid objects, fat, bags, sutures, instruments.
struct Numbers {
  explicit Numbers(const sim::Model& m)
      : membranes(m.organs()),
        strands(membranes + int(m.membranes.size())),
        walls(strands + int(m.strands.size())),
        rigid(walls + int(m.walls.size())),
        fat(rigid + int(m.objects.rigid.list.size())),
        bags(fat + int(m.fat.size())),
        sutures(bags + int(m.objects.bags.list.size())),
        instruments(sutures + int(m.objects.sutures.list.size())) {}

  int membranes, strands, walls, rigid, fat, bags, sutures, instruments;

  int of(BodyId body) const {
    const int i = int(body.index());
    switch (body.kind()) {
      case BodyKind::organ:
        return i;
      case BodyKind::membrane:
        return membranes + i;
      case BodyKind::strand:
        return strands + i;
      case BodyKind::rigid:
        return rigid + i;
      case BodyKind::fat:
        return fat + i;
      case BodyKind::bag:
        return bags + i;
      case BodyKind::suture:
        return sutures + i;
      default:
        return -1;
    }
  }
};

void attach(std::vector<BodySurface>& all, int a, int b) {
  if (a >= 0 && b >= 0 && a != b && !names(all[size_t(a)].attached, b)) all[size_t(a)].attached.push_back(b);
}

BodySurface lattice_surface(const sim::Model& model, const sim::State& state, int organ) {
  const sim::SolidModel& solid = model.solids[size_t(organ)];
  const tissue::NodeView nodes = sim::nodes_of(model, state, organ);
  BodySurface s;
  for (int v = 0; v < solid.fine.size(); ++v) s.points.push_back(tissue::skin_point(nodes, solid.fine, v));
  const std::vector<std::uint8_t>& parted = state.parted[size_t(organ)];
  // Where a lattice tears, triangles are drawn out between its parts: nothing is there.
  constexpr double kTimes = 5;
  const double longest = solid.failure_strain > 0 ? kTimes * std::sqrt(3.0) * solid.cell : kFar;
  for (size_t t = 0; t < solid.fine.triangles.size(); ++t) {
    if (t < parted.size() && parted[t]) continue;
    const auto& v = solid.fine.triangles[t];
    const Vec3d a = s.points[size_t(v[0])], b = s.points[size_t(v[1])], c = s.points[size_t(v[2])];
    if (std::max({length(b - a), length(c - b), length(a - c)}) <= longest) s.triangles.push_back(v);
  }
  return s;
}

BodySurface tetrahedral_surface(const tissue::CuttableModel& body, const tissue::CuttableState& state) {
  BodySurface s;
  for (int n = 0; n < state.tets.nodes; ++n) s.points.push_back(tissue::position(body, state, n));
  for (size_t c = 0; c < state.tets.cells.size(); ++c)
    for (size_t f = 0; f < 4; ++f) {
      if (state.tets.across[c][f] >= 0) continue;
      const auto corner = [&](size_t k) { return state.tets.cells[c][size_t(tissue::kFaceCorners[f][k])]; };
      s.triangles.push_back({corner(0), corner(1), corner(2)});
    }
  return s;
}

BodySurface membrane_surface(const sim::MembraneBody& m, const tissue::MembraneState& state,
                             const std::vector<std::uint8_t>& torn) {
  BodySurface s;
  s.kind = m.sheet.closed() ? Kind::closed : Kind::sheet;
  s.half_thickness = 0.5 * m.sheet.thickness;
  const tissue::NodeView nodes = view_of(m.sheet.network, state.network);
  for (int n = 0; n < m.sheet.nodes(); ++n) s.points.push_back(nodes.position(n));
  for (size_t t = 0; t < m.sheet.triangles.size(); ++t)
    if (!torn[t]) s.triangles.push_back(m.sheet.triangles[t]);
  return s;
}

BodySurface strand_surface(const tissue::StrandModel& m, const tissue::StrandState& state) {
  BodySurface s;
  s.kind = Kind::tube;
  s.points = state.x;
  for (int e = 0; e + 1 < m.nodes; ++e)
    if (state.alive[size_t(e)]) s.capsules.push_back({e, e + 1, m.radius[size_t(e)]});
  return s;
}

BodySurface wall_surface(const sim::WallModel& wall) {
  BodySurface s;
  s.kind = Kind::wall;
  std::map<std::array<float, 3>, int> known;  // surfaces that close around an axis have a seam
  std::vector<int> point;
  for (const Vec3f& p : wall.skin.rest) {
    const auto [at, fresh] = known.try_emplace({p.x, p.y, p.z}, int(s.points.size()));
    if (fresh) s.points.push_back(vec_cast<double>(p));
    point.push_back(at->second);
  }
  Vec3d sum{0, 0, 0};
  double area = 0, volume = 0;
  for (const auto& t : wall.skin.triangles) {
    const std::array<int, 3> v{point[size_t(t[0])], point[size_t(t[1])], point[size_t(t[2])]};
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    s.triangles.push_back(v);
    const Vec3d a = s.points[size_t(v[0])] - s.points[0], b = s.points[size_t(v[1])] - s.points[0],
                c = s.points[size_t(v[2])] - s.points[0];
    const Vec3d own = 0.5 * cross(b - a, c - a);
    sum += own, area += length(own), volume += dot(a, cross(b, c)) / 6;
  }
  // All but closed: a peg, a shaft. Some face inwards.
  constexpr double kOpen = 0.1;
  if (length(sum) > kOpen * area) return s;
  s.kind = Kind::closed;
  s.folds = false;
  if (volume < 0)
    for (auto& t : s.triangles) std::swap(t[1], t[2]);
  return s;
}

BodySurface rigid_surface(const interactions::RigidModel& m, const interactions::RigidState& state) {
  BodySurface s;
  s.kind = Kind::tube;
  s.folds = false;
  const int n = int(m.beads.size());
  for (const Vec3d& p : m.beads) s.points.push_back(place_of(state, p));
  const bool pebble = m.pebble.x > 0;  // beads lie about the first
  if (n == 1) s.capsules.push_back({0, 0, m.radius});
  for (int i = 1; i < n; ++i) s.capsules.push_back({pebble ? 0 : i - 1, i, m.radius});
  if (m.closed && n > 2) s.capsules.push_back({n - 1, 0, m.radius});
  return s;
}

BodySurface fat_surface(const tissue::FatModel& m, const tissue::FatState& state) {
  BodySurface s;
  s.kind = Kind::tube;
  s.folds = false;
  for (int i = 0; i < m.lobules(); ++i) {
    s.points.push_back(tissue::position(m, state, i));
    if (!state.lobules[size_t(i)].gone()) s.capsules.push_back({i, i, m.radius});
  }
  return s;
}

BodySurface bag_surface(const interactions::BagModel& m, const interactions::BagState& state) {
  BodySurface s;
  s.kind = Kind::sheet;
  if (!state.there() || state.out != 0) return s;
  s.points = state.x;
  for (const auto& t : m.triangles) s.triangles.push_back({t[0], t[1], t[2]});
  return s;
}

BodySurface suture_surface(const interactions::SutureModel& m, const interactions::SutureState& state) {
  BodySurface s;
  s.kind = Kind::tube;
  if (m.has_thread()) {
    s.points = state.thread.x;
    for (int e = 0; e + 1 < m.thread.nodes; ++e)
      if (state.thread.alive[size_t(e)]) s.capsules.push_back({e, e + 1, 0.5 * m.thread.stuff.diameter});
  }
  if (!m.has_needle()) return s;
  const int first = int(s.points.size());
  for (int i = 0; i < m.needle.beads; ++i) {
    s.points.push_back(suture::needle_point(m.needle, state.needle, m.needle.bead(i)));
    if (i > 0) s.capsules.push_back({first + i - 1, first + i, 0.5 * m.needle.wire});
  }
  s.folds = false;  // the thread is swaged on
  return s;
}

BodySurface instrument_surface(const interactions::ToolShape& shape) {
  BodySurface s;
  s.kind = Kind::tube;
  s.folds = false;
  for (int part = interactions::kShaft; part < interactions::end_of(shape); part = interactions::next(part)) {
    const interactions::Capsule& rod = shape.rod(part);
    const int n = int(s.points.size());
    s.points.push_back(rod.a), s.points.push_back(rod.b);
    s.capsules.push_back({n, n + 1, rod.radius});
  }
  return s;
}

void attach_bodies(const sim::Model& m, const sim::State& state, const Numbers& n, std::vector<BodySurface>& all) {
  for (size_t i = 0; i < m.strands.size(); ++i)
    for (const interactions::StrandEndModel* end : {&m.strands[i].start, &m.strands[i].end})
      if (end->kind == interactions::StrandEndModel::hosted) attach(all, n.strands + int(i), end->organ());
  for (size_t i = 0; i < m.membranes.size(); ++i) {
    const int own = n.membranes + int(i);
    if (m.membranes[i].strand >= 0) attach(all, own, n.strands + m.membranes[i].strand);
    if (m.membranes[i].duct >= 0) attach(all, own, n.strands + m.membranes[i].duct);
    for (const interactions::Attachment& hold : m.membranes[i].holds) attach(all, own, n.of(hold.point.body));
  }
  for (const interactions::BondSet& set : m.bonds)
    for (const interactions::Bond& bond : set.bonds) attach(all, n.of(set.of), n.of(bond.far.body));
  for (size_t i = 0; i < m.objects.sutures.list.size(); ++i) {
    const interactions::SutureState& s = state.objects.sutures[i];
    for (int k = 0; k < s.bite_count; ++k) attach(all, n.sutures + int(i), n.of(s.bites[size_t(k)].body));
  }
  for (size_t h = 0; h < m.hands.size(); ++h)
    for (int k = 0; k < state.tools[h].holds; ++k)
      attach(all, n.instruments + int(h), n.of(state.tools[h].hold[k].at.body));
}

}  // namespace

std::vector<BodySurface> surfaces_of(const sim::Model& m, const sim::State& state) {
  const Numbers n(m);
  std::vector<BodySurface> all;
  const auto add = [&all](BodySurface s, BodyId body, std::string name) {
    s.body = body;
    s.name = std::move(name);
    all.push_back(std::move(s));
  };
  for (size_t i = 0; i < m.solids.size(); ++i)
    add(lattice_surface(m, state, int(i)), BodyId::organ(i), m.solids[i].name);
  for (size_t i = 0; i < m.cuttables.size(); ++i)
    add(tetrahedral_surface(m.cuttables[i].body, state.cuttables[i]), BodyId::organ(m.solids.size() + i),
        m.cuttables[i].name);
  for (size_t i = 0; i < m.membranes.size(); ++i)
    add(membrane_surface(m.membranes[i], state.membranes[i], state.torn[i]), BodyId::membrane(i), m.membranes[i].name);
  for (size_t i = 0; i < m.strands.size(); ++i)
    add(strand_surface(m.strand_bodies[i].model, state.strands[i]), BodyId::strand(i), m.strands[i].name);
  for (const sim::WallModel& wall : m.walls) add(wall_surface(wall), BodyId::wall(), "wall " + wall.name);
  for (size_t i = 0; i < m.objects.rigid.list.size(); ++i) {
    const interactions::RigidModel& rigid = m.objects.rigid.list[i];
    add(rigid_surface(rigid, state.objects.rigid[i]), BodyId(BodyKind::rigid, i), rigid.name);
    if (state.objects.rigid[i].inside()) all.back().inside = n.membranes + rigid.inside;
  }
  for (size_t i = 0; i < m.fat.size(); ++i)
    add(fat_surface(m.fat[i].fat, state.fat[i]), BodyId(BodyKind::fat, i), m.fat[i].name);
  for (size_t i = 0; i < m.objects.bags.list.size(); ++i)
    add(bag_surface(m.objects.bags.list[i], state.objects.bags[i]), BodyId(BodyKind::bag, i),
        m.objects.bags.list[i].name);
  for (size_t i = 0; i < m.objects.sutures.list.size(); ++i)
    add(suture_surface(m.objects.sutures.list[i], state.objects.sutures[i]), BodyId(BodyKind::suture, i),
        m.objects.sutures.list[i].name);
  for (size_t h = 0; h < m.hands.size(); ++h) {
    add(instrument_surface(sim::shape_of(m, state, h)), {}, "instrument " + m.hands[h].name);
    for (int w = n.walls; w < n.rigid; ++w)
      if (all[size_t(w)].kind == Kind::wall) all.back().ignored.push_back(w);
  }
  attach_bodies(m, state, n, all);
  return all;
}

double Interpenetration::depth(int a, int b) const {
  for (const Overlap& o : overlaps)
    if (o.a == std::min(a, b) && o.b == std::max(a, b)) return o.depth;
  return 0;
}

double Interpenetration::depth(const std::string& a, const std::string& b) const {
  for (const Overlap& o : overlaps) {
    const std::string &first = names[size_t(o.a)], &second = names[size_t(o.b)];
    if ((first == a && second == b) || (first == b && second == a)) return o.depth;
  }
  return 0;
}

Interpenetration measure(std::span<const BodySurface> surfaces) {
  Interpenetration out;
  std::vector<Shape> shapes;
  shapes.reserve(surfaces.size());
  for (const BodySurface& s : surfaces) shapes.emplace_back(s), out.names.push_back(s.name);
  for (int i = 0; i < int(shapes.size()); ++i)
    for (int j = i; j < int(shapes.size()); ++j) {
      const Shape &a = shapes[size_t(i)], &b = shapes[size_t(j)];
      if (a.s.empty() || b.s.empty() || names(a.s.ignored, j) || names(b.s.ignored, i)) continue;
      Deepest deepest;
      if (i != j)
        one_on_other(a, i, b, j, deepest);
      else if (a.s.folds)
        on_itself(a, deepest);
      if (deepest.depth > kLeast)
        out.overlaps.push_back(
            {i, j, deepest.depth, deepest.place, deepest.crossings, names(a.s.attached, j) || names(b.s.attached, i)});
    }
  std::sort(out.overlaps.begin(), out.overlaps.end(),
            [](const Overlap& x, const Overlap& y) { return x.depth > y.depth; });
  return out;
}

Interpenetration measure(const sim::Model& model, const sim::State& state) {
  const std::vector<BodySurface> surfaces = surfaces_of(model, state);
  return measure(surfaces);
}

std::vector<Growth> deeper_than(const Interpenetration& now, const Interpenetration& start, double by) {
  std::vector<Growth> out;
  for (const Overlap& o : now.overlaps) {
    const double before = start.depth(o.a, o.b);
    if (o.depth - before > by) out.push_back({o, before});
  }
  std::sort(out.begin(), out.end(),
            [](const Growth& x, const Growth& y) { return x.now.depth - x.before > y.now.depth - y.before; });
  return out;
}

std::string text_of(const Interpenetration& m, const Overlap& o) {
  const std::string& first = m.names[size_t(o.a)];
  std::array<char, 160> rest{};
  std::snprintf(rest.data(), rest.size(), ": %.2f mm at (%.1f, %.1f, %.1f) mm, %d crossings%s", 1e3 * o.depth,
                1e3 * o.place.x, 1e3 * o.place.y, 1e3 * o.place.z, o.crossings, o.attached ? ", attached" : "");
  return first + (o.a == o.b ? " with itself" : " - " + m.names[size_t(o.b)]) + rest.data();
}

std::string text_of(const Interpenetration& m, const Growth& g) {
  std::array<char, 64> before{};
  std::snprintf(before.data(), before.size(), ", %.2f mm at the start", 1e3 * g.before);
  return text_of(m, g.now) + before.data();
}

void print(std::ostream& out, const Interpenetration& measured, double over) {
  for (const Overlap& o : measured.overlaps)
    if (o.depth > over) out << text_of(measured, o) << "\n";
}

}  // namespace trocar
