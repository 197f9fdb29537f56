#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include <trocar/studies/link_pairs.hpp>
#include <trocar/studies/shape_distance.hpp>

namespace trocar::studies {

using namespace kinematics;

namespace {

constexpr double kApart = std::numeric_limits<double>::infinity();
constexpr double kNearJoint = 2;      // of the greater thickness of two shapes: the joint is there
constexpr double kDrawnSlack = 0.05;  // of the smaller one
constexpr double kLeastSlack = 1e-6;  // [m]
constexpr std::size_t kMostPieces = 8;

/// Parts: bodies that nothing moves against each other have one number, that of the first of them.
std::vector<int> parts_of(const Mechanism& m) {
  std::vector<int> part(m.bodies.size());
  for (std::size_t b = 0; b < m.bodies.size(); ++b)
    part[b] = b > 0 && m.bodies[b].motion == Motion::none ? part[std::size_t(m.bodies[b].parent)] : int(b);
  return part;
}

using Joints = std::map<std::pair<int, int>, std::vector<PartJoint>>;

/// Of parts, by their numbers. Bodies without mass between a joint's freedoms are the joint, not parts.
Joints joints_of(const Mechanism& m, const std::vector<int>& part, const std::vector<int>& link_of) {
  Joints all;
  const auto join = [&all](int a, int b, const PartJoint& by) {
    if (a != b) all[{std::min(a, b), std::max(a, b)}].push_back(by);
  };
  for (std::size_t b = 1; b < m.bodies.size(); ++b) {
    if (link_of[b] < 0) continue;
    PartJoint by{int(b), m.bodies[b].motion == Motion::turn, m.bodies[b].motion == Motion::slide, -1};
    int parent = m.bodies[b].parent;
    for (; link_of[std::size_t(parent)] < 0; parent = m.bodies[std::size_t(parent)].parent) {
      by.axis = false;
      by.slides = by.slides || m.bodies[std::size_t(parent)].motion == Motion::slide;
    }
    join(part[b], part[std::size_t(parent)], by);
  }
  for (std::size_t c = 0; c < m.closures.size(); ++c) {
    const Closure& closure = m.closures[c];
    join(part[std::size_t(closure.a.body)], part[std::size_t(closure.b.body)], {0, false, false, int(c)});
  }
  return all;
}

double thickness(const BodyShape& s) {
  return s.kind == ShapeKind::box ? 0.5 * std::min({s.to.x, s.to.y, s.to.z}) : s.radius;
}

/// A joint in space: a point, or with `axis` the line through it.
struct JointPlace {
  Vec3d at, axis;
  bool line = false;

  /// From the joint to a point, without what is along the line.
  Vec3d to(Vec3d p) const { return flat(p - at); }
  Vec3d flat(Vec3d v) const { return line ? v - dot(v, axis) * axis : v; }
};

JointPlace place_of(const PartJoint& j, const Mechanism& m, const Pose& pose) {
  if (j.closure >= 0) return {place(m.closures[std::size_t(j.closure)].b, pose).p, {}, false};
  return {pose.frames[std::size_t(j.body)].p, pose.axes[std::size_t(j.body)], j.axis};
}

/// Pieces of a rod, as shares of its length.
struct Pieces {
  std::array<std::pair<double, double>, kMostPieces> of = {{{0, 1}}};
  std::size_t count = 1;

  /// Takes out what is between two shares.
  void cut(double from, double to) noexcept {
    Pieces left;
    left.count = 0;
    const auto keep = [&left](double a, double b) {
      if (b >= a && left.count < kMostPieces) left.of[left.count++] = {a, b};
    };
    for (std::size_t i = 0; i < count; ++i) {
      if (from > of[i].second || to < of[i].first) {
        keep(of[i].first, of[i].second);
        continue;
      }
      if (from > of[i].first) keep(of[i].first, from);
      if (to < of[i].second) keep(to, of[i].second);
    }
    *this = left;
  }
};

/// A rod without what is within a radius of a joint.
void cut_at(Pieces& pieces, const PlacedShape& rod, const JointPlace& joint, double radius) noexcept {
  const Vec3d w = joint.to(rod.a), d = joint.flat(rod.b - rod.a);
  // |w + t d|^2 < radius^2
  const double a = dot(d, d), half_b = dot(w, d), c = dot(w, w) - radius * radius;
  if (!(a > 1e-18)) {
    if (c < 0) pieces.cut(0, 1);
    return;
  }
  const double root = half_b * half_b - a * c;
  if (!(root > 0)) return;
  pieces.cut((-half_b - std::sqrt(root)) / a, (-half_b + std::sqrt(root)) / a);
}

PlacedShape piece(const PlacedShape& rod, std::pair<double, double> share) noexcept {
  PlacedShape out = rod;
  out.a = rod.a + share.first * (rod.b - rod.a);
  out.b = rod.a + share.second * (rod.b - rod.a);
  return out;
}

/// Of two shapes of neighbours, off their joints. Boxes are whole.
double gap_off_joints(const LinkPair& pair, std::pair<int, int> shapes, const Mechanism& m, const Pose& pose) noexcept {
  const BodyShape &one = m.shapes[std::size_t(shapes.first)], &other = m.shapes[std::size_t(shapes.second)];
  const PlacedShape a = placed(one, pose), b = placed(other, pose);
  const double radius = kNearJoint * std::max(thickness(one), thickness(other));
  Pieces of_a, of_b;
  for (const PartJoint& j : pair.joints) {
    if (j.slides) continue;
    const JointPlace joint = place_of(j, m, pose);
    if (!a.box) cut_at(of_a, a, joint, radius);
    if (!b.box) cut_at(of_b, b, joint, radius);
  }
  double least = kApart;
  for (std::size_t i = 0; i < of_a.count; ++i)
    for (std::size_t k = 0; k < of_b.count; ++k)
      least = std::min(least, clearance(a.box ? a : piece(a, of_a.of[i]), b.box ? b : piece(b, of_b.of[k])));
  return least;
}

}  // namespace

LinkPairs::LinkPairs(const Mechanism& m, std::span<const std::pair<int, int>> ignored) {
  const std::vector<int> part = parts_of(m);
  std::vector<int> link_of(m.bodies.size(), -1);
  for (std::size_t l = 0; l < m.links.size(); ++l) link_of[std::size_t(m.link_body[l])] = int(l);
  const Joints joints = joints_of(m, part, link_of);
  const auto is_ignored = [&ignored](int a, int b) {
    return std::any_of(ignored.begin(), ignored.end(), [&](const std::pair<int, int>& p) {
      return (p.first == a && p.second == b) || (p.first == b && p.second == a);
    });
  };
  for (std::size_t i = 0; i < m.shapes.size(); ++i)
    for (std::size_t k = i + 1; k < m.shapes.size(); ++k) {
      const int a = m.shapes[i].body, b = m.shapes[k].body;
      const int first = link_of[std::size_t(a)], second = link_of[std::size_t(b)];
      const int pa = part[std::size_t(a)], pb = part[std::size_t(b)];
      if (pa == pb || is_ignored(first, second)) continue;
      auto found = std::find_if(m_pairs.begin(), m_pairs.end(),
                                [&](const LinkPair& p) { return p.first == first && p.second == second; });
      if (found == m_pairs.end()) {
        const auto joined = joints.find({std::min(pa, pb), std::max(pa, pb)});
        m_pairs.push_back({first, second, {}, joined == joints.end() ? std::vector<PartJoint>() : joined->second, 0});
        found = m_pairs.end() - 1;
      }
      found->shapes.emplace_back(int(i), int(k));
    }
  for (LinkPair& p : m_pairs)
    if (p.neighbours()) {
      p.drawn = m_drawn;
      m_drawn += int(p.shapes.size());
    }
}

std::vector<double> LinkPairs::drawn(const Mechanism& m, const Pose& pose) const {
  std::vector<double> out;
  for (const LinkPair& p : m_pairs)
    if (p.neighbours())
      for (const std::pair<int, int>& s : p.shapes) out.push_back(gap_off_joints(p, s, m, pose));
  return out;
}

double LinkPairs::gap(const LinkPair& pair, const Mechanism& m, const Pose& pose,
                      std::span<const double> drawn) const noexcept {
  double least = kApart;
  for (std::size_t s = 0; s < pair.shapes.size(); ++s) {
    const auto [i, k] = pair.shapes[s];
    if (!pair.neighbours()) {
      least =
          std::min(least, clearance(placed(m.shapes[std::size_t(i)], pose), placed(m.shapes[std::size_t(k)], pose)));
    } else {
      const double as_drawn = drawn[std::size_t(pair.drawn) + s];
      least = std::min(least, gap_off_joints(pair, pair.shapes[s], m, pose) - std::min(0.0, as_drawn));
    }
  }
  return least;
}

double LinkPairs::slack(const LinkPair& pair, const Mechanism& m) const noexcept {
  double thinnest = kApart;
  for (const auto& [i, k] : pair.shapes)
    thinnest = std::min({thinnest, thickness(m.shapes[std::size_t(i)]), thickness(m.shapes[std::size_t(k)])});
  return std::max(kLeastSlack, kDrawnSlack * thinnest);
}

const LinkPair* LinkPairs::of(int first, int second) const noexcept {
  for (const LinkPair& p : m_pairs)
    if (p.first == first && p.second == second) return &p;
  return nullptr;
}

}  // namespace trocar::studies
