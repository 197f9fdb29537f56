#include <algorithm>
#include <cmath>

#include <trocar/scene/mechanisms/linkage_works.hpp>

namespace trocar::scene {
namespace {

using interactions::LinkageWorks;
using kinematics::Frame;
using kinematics::Mechanism;

constexpr double kStill = 1e-9;       // [m] of a body that the handle does not move
constexpr double kShownRod = 0.06;    // [m] behind the hinge: more of a rod is in the shaft
constexpr double kShaftEnd = 0.0098;  // [m] behind the hinge where the mechanism draws no shaft

/// A mechanism's axis is -z; what is drawn goes along z.
Vec3d forwards(Vec3d v) { return {v.x, v.y, -v.z}; }
Mat3d forwards(const Mat3d& r) {
  Mat3d out = r;
  for (int k = 0; k < 2; ++k) out.m[2][k] = -r.m[2][k], out.m[k][2] = -r.m[k][2];
  return out;
}

class Works {
 public:
  Works(const Mechanism& m, std::span<const kinematics::Pose> poses, int upper, int lower, double jaw_length)
      : m_m(m), m_poses(poses) {
    const Frame tips[2] = {place(m.frames[std::size_t(upper)], poses.back()),
                           place(m.frames[std::size_t(lower)], poses.back())};
    m_hinge = -0.5 * (tips[0].p.z + tips[1].p.z) - jaw_length;
    m_jaw[0] = jaw_of(m.frames[std::size_t(upper)].body);
    m_jaw[1] = jaw_of(m.frames[std::size_t(lower)].body);
  }

  LinkageWorks found() {
    m_out.shaft_end = kShaftEnd;
    for (int body = 0; body < int(m_m.bodies.size()); ++body) {
      if (which_jaw(body) >= 0) continue;
      if (still(body))
        note_shaft(body);
      else
        add(body);
    }
    for (const kinematics::Closure& c : m_m.closures) {
      add_tail(c.a.body, c.b);
      add_tail(c.b.body, c.a);
    }
    return std::move(m_out);
  }

 private:
  /// The body that turns, of one that may be fixed on it.
  int jaw_of(int body) const {
    while (body > 0 && m_m.bodies[std::size_t(body)].motion == kinematics::Motion::none)
      body = m_m.bodies[std::size_t(body)].parent;
    return body;
  }
  int which_jaw(int body) const {
    const int turns = jaw_of(body);
    return turns == m_jaw[0] ? 0 : turns == m_jaw[1] ? 1 : -1;
  }
  bool still(int body) const {
    const Frame &a = m_poses.front().frames[std::size_t(body)], &b = m_poses.back().frames[std::size_t(body)];
    return length(a.p - b.p) < kStill && length(kinematics::turn_between(a.r, b.r)) < 1e-6;
  }
  Vec3d drawn(Vec3d p) const { return forwards(p) - Vec3d{0, 0, m_hinge}; }

  /// The shaft is what does not move and continues behind.
  void note_shaft(int body) {
    for (const kinematics::BodyShape& s : m_m.shapes) {
      if (s.body != body || s.kind == kinematics::ShapeKind::box) continue;
      const Frame& f = m_poses.front().frames[std::size_t(body)];
      const double first = drawn(f * s.from).z, last = drawn(f * s.to).z;
      if (std::min(first, last) < -kShownRod) m_out.shaft_end = std::clamp(-std::max(first, last), 0.002, 0.04);
    }
  }

  void add(int body) {
    LinkageWorks::Part part;
    for (const kinematics::BodyShape& s : m_m.shapes)
      if (s.body == body && s.kind != kinematics::ShapeKind::box)
        part.rods.push_back({forwards(s.from), forwards(s.to), s.radius});
    for (const kinematics::Closure& c : m_m.closures)
      for (const kinematics::BodyFrame* end : {&c.a, &c.b})
        if (end->body == body) part.pins.push_back(forwards(end->local.p));
    if (part.rods.empty()) return;
    const Frame& begins = m_poses.front().frames[std::size_t(body)];
    const auto at_handle = [&](const kinematics::BodyShape& s) {  // behind all that shows
      return s.body != body || std::max(drawn(begins * s.from).z, drawn(begins * s.to).z) < -kShownRod;
    };
    if (std::all_of(m_m.shapes.begin(), m_m.shapes.end(), at_handle)) return;
    for (const kinematics::Pose& pose : m_poses) {
      const Frame& f = pose.frames[std::size_t(body)];
      part.at.push_back({forwards(f.r), drawn(f.p)});
    }
    m_out.parts.push_back(std::move(part));
  }

  /// Where `other` takes hold of a jaw, in that jaw's frame.
  void add_tail(int body, const kinematics::BodyFrame& other) {
    const int jaw = which_jaw(body);
    if (jaw < 0 || which_jaw(other.body) >= 0) return;
    const auto on_jaw = [&](std::size_t k) {
      const Frame now = m_poses[k].frames[std::size_t(m_jaw[jaw])];
      const Frame closed = m_poses.back().frames[std::size_t(m_jaw[jaw])];
      return drawn(closed * (kinematics::inverse(now) * place(other, m_poses[k]).p));
    };
    m_out.tails.push_back({jaw, on_jaw(0), on_jaw(m_poses.size() - 1)});
  }

  const Mechanism& m_m;
  std::span<const kinematics::Pose> m_poses;
  double m_hinge = 0;  ///< from the mechanism's origin ahead [m]
  int m_jaw[2] = {};   ///< bodies
  LinkageWorks m_out;
};

}  // namespace

std::shared_ptr<const interactions::LinkageWorks> works_of(const Mechanism& m, std::span<const kinematics::Pose> poses,
                                                           int upper, int lower, double jaw_length) {
  return std::make_shared<const LinkageWorks>(Works(m, poses, upper, lower, jaw_length).found());
}

}  // namespace trocar::scene
