// Seeded trials of an instrument that is driven across or into a body, at up to 2 m/s, from any side: does the body end
// up on the other side of it? The answer does not come from the contact's own tests: every edge of the body (a strand's
// elements, the edges of a skin's or fold's triangles) is followed through each tick with all points in a straight
// line, and each passage through the instrument's axis is counted with its sign; in the end the sum must be zero, and
// the axis must not pierce a triangle. Passages within 2.5 mm of the tip do not count: there what was run into slips
// off. Of surfaces that are stabbed the piercing alone counts: they may come back over the tip.
#pragma once

#include <string>
#include <vector>

#include <trocar/core/random.hpp>
#include <trocar/geometry/surfaces/nearest.hpp>

#include "../sim/small_scene.hpp"

namespace trocar::trials {

enum class Kind { organ, cells, strand, fold };

inline const char* name(Kind kind) {
  constexpr const char* names[] = {"organ of a lattice", "organ of tetrahedra", "strand", "fold"};
  return names[int(kind)];
}

/// On springs, so that all of it can give way.
inline scene::Solid floating(scene::Solid s) {
  s.anchors = {{s.sections[1].centre, 0.1, 300, {}}};
  return s;
}

/// A hook with a foot instead of the grasper.
inline void take_hook(scene::Instrument& i) {
  i.kind = interactions::ToolKind::hook;
  i.jaw_length = 0.012;
  i.jaw_thickness = 0.0012;
  i.opening = 0;
  i.foot = 0.0026;
}

enum class With { grasper, hook };

/// One body of that kind and the instrument; a fold comes with the tube it hangs on and the organ it grows from.
inline scene::Description description(Kind kind, With with) {
  scene::Description d = small::description();
  d.walls.clear();
  d.solids.clear();
  d.strands.clear();
  d.membranes.clear();
  d.vessels.clear();
  if (kind == Kind::organ) d.solids = {floating(small::organ())};
  if (kind == Kind::cells) {
    d.solids = {small::bar()};
    d.solids[0].tissue = "flesh";
    d.solids[0].cell = 0.006;
    for (scene::Section& s : d.solids[0].sections) s.across = {0, 0.007, 0}, s.deep = {0, 0, 0.007};
    d.solids = {floating(d.solids[0])};
  }
  if (kind == Kind::strand) d.strands = {small::cord()};
  if (kind == Kind::fold) {
    scene::Solid slab = small::organ();
    slab.name = "slab";
    slab.sections.clear();
    for (double x : {-0.002, 0.010, 0.024, 0.036})
      slab.sections.push_back({{x, 0.001, -0.0205}, {0, 0.012, 0}, {0, 0, 0.006}, 2});
    d.solids = {floating(small::organ()), floating(slab)};
    d.strands = {small::tube()};
    d.membranes = {small::fold()};
    d.membranes[0].base_on = {"organ", "slab"};
  }
  d.placements.resize(1);
  d.instruments.resize(1);
  if (with == With::hook) take_hook(d.instruments[0]);
  d.ports = {d.ports.front(), d.ports.back()};
  return d;
}

/// The edges of a body and its triangles.
struct Frame {
  std::vector<std::array<int, 2>> edges;
  std::vector<std::array<int, 3>> triangles;
};

inline void add_triangles(const std::vector<std::array<int, 3>>& triangles, Frame& f) {
  f.triangles = triangles;
  for (const auto& t : triangles)
    for (size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      f.edges.push_back({std::min(a, b), std::max(a, b)});
    }
  std::sort(f.edges.begin(), f.edges.end());
  f.edges.erase(std::unique(f.edges.begin(), f.edges.end()), f.edges.end());
}

/// Do the moving segments a and b pass through each other? +1 or -1 by the sense, 0 if not; an even number of times
/// within one tick counts as none. Both move in straight lines.
struct Segment {
  Vec3d a, b;
};
inline Segment between(const Segment& p, const Segment& q, double share) {
  return {p.a + share * (q.a - p.a), p.b + share * (q.b - p.b)};
}
inline double volume(const Segment& p, const Segment& q) { return dot(cross(p.b - p.a, q.b - q.a), q.a - p.a); }

inline int passage(const Segment& p0, const Segment& p1, const Segment& q0, const Segment& q1) {
  constexpr int kPieces = 8;
  int sum = 0;
  double before = volume(p0, q0);
  for (int i = 1; i <= kPieces; ++i) {
    double low = double(i - 1) / kPieces, high = double(i) / kPieces;
    const double after = volume(between(p0, p1, high), between(q0, q1, high));
    if ((before < 0) == (after < 0)) {
      before = after;
      continue;
    }
    for (int k = 0; k < 30; ++k) {
      const double middle = 0.5 * (low + high);
      const bool same = (volume(between(p0, p1, middle), between(q0, q1, middle)) < 0) == (before < 0);
      (same ? low : high) = middle;
    }
    const Segment p = between(p0, p1, low), q = between(q0, q1, low);
    const auto near = geometry::closest_segments(p.a, p.b, q.a, q.b);
    if (near.distance2 < 1e-14 && (1 - near.s) * length(p.b - p.a) > 0.0025) sum += after < 0 ? -1 : 1;
    before = after;
  }
  return sum;
}

class Trials {
 public:
  explicit Trials(Kind kind, std::uint64_t seed = 1, With with = With::grasper)
      : m_kind(kind),
        m_model(scene::compile(description(kind, with))),
        m_initial(sim::initial_state(m_model)),
        m_work(sim::make_work(m_model)),
        m_seed(seed),
        m_random(seed) {
    // Trials come from all sides: no limit of a trocar may keep the instrument from where it is put.
    for (interactions::ToolModel& t : m_model.hands[0].rack) t.limits.angle = t.limits.roll = 4, t.limits.depth_max = 1;
    if (kind == Kind::strand)
      for (int e = 0; e + 1 < m_model.strand_bodies[0].nodes(); ++e) m_frame.edges.push_back({e, e + 1});
    else
      add_triangles(kind == Kind::fold ? m_model.membranes[0].skin.triangles : m_model.skin(0).triangles, m_frame);
    m_net.resize(m_frame.edges.size());
    if (kind == Kind::fold)
      for (const int node : m_model.membranes[0].sheet.held_nodes)
        if (m_model.membranes[0].sheet.network.rest[size_t(node)].z < -0.008)
          m_held.push_back(m_model.membranes[0].sheet.network.rest[size_t(node)]);
    for (const sim::StrandAnatomy& strand : m_model.strands) {
      const tissue::StrandModel& body = m_model.strand_bodies[size_t(&strand - m_model.strands.data())].model;
      if (strand.start.kind == sim::StrandEndModel::fixed) m_held.push_back(body.rest.front());
      if (strand.end.kind == sim::StrandEndModel::fixed) m_held.push_back(body.rest.back());
    }
  }

  /// What happened in one trial.
  struct Result {
    bool passed = false;      ///< the body is on the other side, or pierced
    bool sank = false;        ///< at some time on the way
    bool touched = false;     ///< they met
    std::uint32_t flags = 0;  ///< of the steps
    double speed = 0;
    bool stab = false;
    std::string what;
  };

  /// One trial: a random place of the body, direction, kind of motion, speed. Each number is a trial of its own.
  Result trial(int number, double lowest_speed = 0.3, double highest_speed = 2.0) {
    m_random = core::Random(core::Random(m_seed + 0x100000000ull * std::uint64_t(number)).next());
    for (;;) {
      Motion m = draw(lowest_speed, highest_speed);
      if (clear(m) && meets(m) && possible(m)) return run(m);
    }
  }

 private:
  struct Motion {
    Vec3d end, way;  ///< where the tip comes to, and its direction
    Vec3d port;
    double speed = 0, roll = 0, far = 0;
    bool stab = false;
  };

  std::vector<Vec3d> points(const sim::State& s) const {
    if (m_kind == Kind::strand) return s.strands[0].x;
    std::vector<Vec3d> p;
    if (m_kind == Kind::fold) {
      const tissue::NodeView nodes = view_of(m_model.membranes[0].sheet.network, s.membranes[0].network);
      for (int v = 0; v < m_model.membranes[0].skin.size(); ++v)
        p.push_back(tissue::skin_point(nodes, m_model.membranes[0].skin, v));
    } else {
      const tissue::NodeView nodes = sim::nodes_of(m_model, s, 0);
      for (int v = 0; v < m_model.skin(0).size(); ++v) p.push_back(tissue::skin_point(nodes, m_model.skin(0), v));
    }
    return p;
  }

  Vec3d direction() {
    for (;;) {
      const Vec3d d{m_random.uniform(-1, 1), m_random.uniform(-1, 1), m_random.uniform(-1, 1)};
      const double n = length(d);
      if (n > 0.1 && n < 1) return d / n;
    }
  }

  Motion draw(double lowest, double highest) {
    Motion m;
    const std::vector<Vec3d> p = points(m_initial);
    const auto& edge = m_frame.edges[size_t(m_random.next() % m_frame.edges.size())];
    const double w = m_random.uniform();
    const Vec3d place = (1 - w) * p[size_t(edge[0])] + w * p[size_t(edge[1])];
    m.stab = m_random.uniform() < 0.5;
    m.way = direction();
    m.speed = m_random.uniform(lowest, highest);
    m.roll = m_random.uniform(-3, 3);
    const double beyond = 0.004;
    m.far = beyond + 0.018;
    if (m.stab) {
      const double slant = m_random.uniform(0, 0.4);
      const Vec3d axis = normalised(m.way + slant * direction());
      m.end = place + beyond * m.way;
      m.port = m.end - m_random.uniform(0.08, 0.15) * axis;
    } else {
      Vec3d axis = direction();
      axis = normalised(axis - 0.9 * dot(axis, m.way) * m.way);
      m.end = place + beyond * m.way + m_random.uniform(0.003, 0.045) * axis;
      m.port = m.end - m_random.uniform(0.10, 0.16) * axis;
    }
    return m;
  }

  /// A hook's ends a radius before its tip.
  static Segment axis_of(const interactions::ToolShape& s) {
    return {s.part[interactions::kShaft].a, s.has_foot ? s.part[interactions::kJawA].b : s.frame.tip};
  }
  Segment axis_at(const Motion& m, double left) const {
    const kinematics::FulcrumPose pose = kinematics::inverse(m.port, m.end - left * m.way, m.roll);
    const interactions::ToolShape s = interactions::shape_of(m_model.placed(0), pose, 0);
    return axis_of(s);
  }

  /// Is the instrument clear of everything at the start?
  bool clear(const Motion& m) {
    m_model.hands[0].port = m.port;
    for (interactions::ToolModel& t : m_model.hands[0].rack) t.port = m.port;
    const Segment axis = axis_at(m, m.far);
    const auto away = [&](Vec3d p, double far) {
      const double s = geometry::closest_on_segment(p, axis.a, axis.b);
      return length(axis.a + s * (axis.b - axis.a) - p) > far;
    };
    for (const Vec3d& p : points(m_initial))
      if (!away(p, 0.008)) return false;
    for (const tissue::StrandState& s : m_initial.strands)
      for (const Vec3d& p : s.x)
        if (!away(p, 0.008)) return false;
    for (int o = 0; o < m_model.organs(); ++o)
      for (int v = 0; v < m_model.skin(o).size(); ++v)
        if (!away(tissue::skin_point(sim::nodes_of(m_model, m_initial, o), m_model.skin(o), v), 0.008)) return false;
    return true;
  }

  /// Lets the motion end 3 to 10 mm after the instrument's surface meets the body; false where it does not.
  bool meets(Motion& m) {
    const std::vector<Vec3d> p = points(m_initial);
    constexpr int kPlaces = 60;
    for (int i = 0; i <= kPlaces; ++i) {
      const Segment axis = axis_at(m, m.far * (1 - double(i) / kPlaces));
      for (const auto& edge : m_frame.edges) {
        const auto near = geometry::closest_segments(axis.a, axis.b, p[size_t(edge[0])], p[size_t(edge[1])]);
        if (near.distance2 > 0.0025 * 0.0025) continue;
        const double met = m.far * double(i) / kPlaces, further = m_random.uniform(0.003, 0.010);
        m.end += (met + further - m.far) * m.way;
        m.far = met + further;
        return clear(m);
      }
    }
    return false;
  }

  /// What is held in space cannot give way, nor does a fold where it is tied to what carries it.
  bool possible(const Motion& m) const {
    for (int i = 0; i <= 20; ++i) {
      const Segment axis = axis_at(m, m.far * i / 20.0);
      for (const Vec3d& p : m_held) {
        const double s = geometry::closest_on_segment(p, axis.a, axis.b);
        const double least = m_kind == Kind::fold ? 0.007 : 0.010;
        if (geometry::distance2(axis.a + s * (axis.b - axis.a), p) < least * least) return false;
      }
    }
    return true;
  }

  void put(sim::State& s, sim::Input& input, const Motion& m, double left) const {
    const kinematics::FulcrumPose pose = kinematics::inverse(m.port, m.end - left * m.way, m.roll);
    input.tools[0] = sim::tool_input(pose, 1.0f);
    interactions::ToolState& tool = s.tools[0];
    tool.yaw = pose.yaw, tool.pitch = pose.pitch, tool.roll = pose.roll, tool.depth = pose.depth;
    tool.handle = 1;
  }

  Result run(const Motion& m) {
    Result r;
    r.speed = m.speed;
    r.stab = m.stab;
    sim::State s = m_initial;
    sim::Input input = m_model.start;
    s.tools[0].aperture = 0;
    put(s, input, m, m.far);
    interactions::start_here(s.tools[0], {}, s.touches[0]);
    std::fill(m_net.begin(), m_net.end(), 0);
    std::vector<Vec3d> before = points(s);
    Segment axis_before = axis_at(m, m.far);
    const int ticks = int(m.far / (m.speed * sim::kTick)) + 1;
    for (int i = 1; i <= ticks + 90; ++i) {
      const double left = std::max(0.0, m.far - m.speed * sim::kTick * i);
      put(s, input, m, left);
      r.flags |= sim::step(m_model, input, s, m_work).flags;
      const double* f = s.tools[0].contact_force;
      r.touched = r.touched || std::fabs(f[0]) + std::fabs(f[1]) + std::fabs(f[2]) > 0;
      const std::vector<Vec3d> now = points(s);
      const Segment axis = axis_of(m_work.shapes[0]);
      follow_edges(axis_before, axis, before, now, r);
      before = now;
      axis_before = axis;
    }
    judge(axis_before, before, r);
    r.what = std::string(m.stab ? "stab" : "sweep") + " at " + std::to_string(m.speed) + " m/s";
    return r;
  }

  void follow_edges(const Segment& axis0, const Segment& axis1, const std::vector<Vec3d>& x0,
                    const std::vector<Vec3d>& x1, Result& r) {
    for (size_t e = 0; e < m_frame.edges.size(); ++e) {
      const auto [i, j] = m_frame.edges[e];
      const Vec3d p = x0[size_t(i)];
      const double s = geometry::closest_on_segment(p, axis0.a, axis0.b);
      if (geometry::distance2(axis0.a + s * (axis0.b - axis0.a), p) > 0.015 * 0.015) continue;
      const int passed = passage(axis0, axis1, {x0[size_t(i)], x0[size_t(j)]}, {x1[size_t(i)], x1[size_t(j)]});
      if (passed == 0) continue;
      m_net[e] += passed;
      r.sank = true;
    }
  }

  void judge(const Segment& axis, const std::vector<Vec3d>& x, Result& r) const {
    if (!r.stab || m_kind == Kind::strand)
      for (const int net : m_net) r.passed = r.passed || net != 0;
    for (const auto& t : m_frame.triangles) {
      const auto hit =
          geometry::ray_triangle(axis.a, axis.b - axis.a, x[size_t(t[0])], x[size_t(t[1])], x[size_t(t[2])]);
      r.passed = r.passed || (hit.hit && hit.t < 1);
    }
  }

  Kind m_kind;
  sim::Model m_model;
  sim::State m_initial;
  sim::Work m_work;
  std::uint64_t m_seed;
  core::Random m_random;
  Frame m_frame;
  std::vector<int> m_net;
  std::vector<Vec3d> m_held;
};

}  // namespace trocar::trials
