#include <algorithm>
#include <cmath>

#include <trocar/numerics/quat.hpp>
#include <trocar/tissue/elastostatic/elastostatic.hpp>
#include <trocar/tissue/elastostatic/field_kernels.hpp>

namespace trocar::tissue {
namespace {

constexpr double kRoot3 = 1.7320508075688772;

Quatd turn_of(const OrganFrame& f) noexcept { return {f.w, f.x, f.y, f.z}; }
Vec3d displaced(std::span<const float> u, int slot) noexcept {
  const float* p = u.data() + 3 * slot;
  return {double(p[0]), double(p[1]), double(p[2])};
}
Vec3d to_world(const ElastostaticModel& m, const OrganFrame& f, Vec3d from_centre) noexcept {
  return m.centre + f.shift + rotate(turn_of(f), from_centre);
}

/// Those whose turn it is, of every so many.
void place_inner(const ElastostaticModel& m, const ElastostaticState& s, std::size_t first, std::size_t every,
                 std::span<NodeState> rows) noexcept {
  for (std::size_t i = first; i < m.inner.size(); i += every) {
    const InnerNode& inner = m.inner[i];
    Vec3d u{0, 0, 0};
    for (std::size_t k = 0; k < inner.slot.size(); ++k) u += double(inner.weight[k]) * displaced(s.u, inner.slot[k]);
    const Vec3d x = to_world(m, s.frame, inner.rest - m.centre + u) - m.origin;
    rows[std::size_t(inner.row)] = {float(x.x), float(x.y), float(x.z), 0, 0, 0};
  }
}

/// The nearest kept nodes, by the inverse square of their distance.
InnerNode inner_node(const ElastostaticModel& m, const DrawnOrgan& organ, std::size_t node) {
  InnerNode out;
  out.node = std::int32_t(node);
  out.row = organ.row_of_node[node];
  out.rest = organ.points[node];
  if (!organ.held.empty() && organ.held[node] == kHeld) return out;
  std::vector<std::pair<double, std::int32_t>> near;
  for (std::size_t i = 0; i < m.rest.size(); ++i) {
    const Vec3d way = m.rest[i] - out.rest;
    near.emplace_back(dot(way, way), std::int32_t(i));
  }
  const std::size_t count = std::min(near.size(), out.slot.size());
  std::partial_sort(near.begin(), near.begin() + std::ptrdiff_t(count), near.end());
  double sum = 0;
  for (std::size_t k = 0; k < count; ++k) sum += 1 / near[k].first;
  for (std::size_t k = 0; k < count; ++k) {
    out.slot[k] = near[k].second;
    out.weight[k] = float(1 / (near[k].first * sum));
  }
  return out;
}

/// A tick of one organ.
class Tick {
 public:
  Tick(const ElastostaticModel& model, std::span<const NodeLoad> loads, std::span<const std::int32_t> point,
       CarriedBy carried, ElastostaticState& state, ElastostaticWork& work) noexcept
      : m(model), m_loads(loads), m_point(point), m_carried(carried), s(state), w(work) {}

  StepReport make(std::span<Vec3f> reactions, std::span<NodeState> rows) noexcept {
    if (rests()) return m_report;
    m_before = s.frame;
    if (!m.floats()) s.frame.shift = m_carried.shift;
    gather();
    go_without_hands();
    balance();
    report(reactions);
    write(rows);
    return m_report;
  }

 private:
  bool rests() const noexcept {
    const Vec3d way = s.frame.shift - m_carried.shift;
    return s.still && m_loads.empty() && way.x == 0 && way.y == 0 && way.z == 0;
  }

  Vec3d local(Vec3d v) const noexcept { return rotate(conjugate(turn_of(s.frame)), v); }
  /// The displacement that puts a node at a place in the world.
  Vec3d displacement_to(Vec3d place, Vec3d rest) const noexcept {
    return local(place - m.centre - s.frame.shift) - (rest - m.centre);
  }

  void bad(int load) noexcept {
    m_report.flags |= StepReport::kBadLoad;
    if (m_report.first_bad < 0) m_report.first_bad = load;
  }

  /// Known forces by node, and points of the springs among the loads.
  void gather() noexcept {
    no_forces();
    w.terms.clear();
    w.points.clear();
    w.first_load.clear();
    std::int32_t last = -1;
    for (int i = 0; i < int(m_loads.size()); ++i) {
      const NodeLoad& load = m_loads[std::size_t(i)];
      const bool inside = load.node < 0 || load.node >= int(m.slot.size()) || m.slot[std::size_t(load.node)] < 0;
      const float sum = load.f0.x + load.f0.y + load.f0.z + load.k + load.d + load.x0.x + load.x0.y + load.x0.z;
      if (inside || !std::isfinite(sum)) {
        bad(i);
        continue;
      }
      const std::int32_t slot = m.slot[std::size_t(load.node)];
      add_force(slot, local(vec_cast<double>(load.f0)));
      if (!(load.k > 0) && !(load.d > 0)) continue;
      if (w.points.empty() || m_point[std::size_t(i)] != last) begin_point(i, load);
      last = m_point[std::size_t(i)];
      w.terms.push_back({slot, load.k > 0 ? load.k : load.d});  // becomes a share of their sum
      LoadPoint& p = w.points.back();
      ++p.count;
      p.want += double(w.terms.back().weight) * vec_cast<double>(load.x0);
    }
    for (std::size_t i = 0; i < w.points.size(); ++i) settle_point(w.points[i], m_loads[std::size_t(w.first_load[i])]);
  }

  void begin_point(int load, const NodeLoad& first) noexcept {
    LoadPoint p;
    p.first = int(w.terms.size());
    p.dir = local(vec_cast<double>(first.dir));
    p.one_sided = first.k > 0 && p.along();
    w.points.push_back(p);
    w.first_load.push_back(load);
  }

  /// Shares, and where its spring and its dashpot together want it.
  void settle_point(LoadPoint& p, const NodeLoad& first) noexcept {
    double sum = 0, k = 0, d = 0;
    for (int t = p.first; t < p.first + p.count; ++t) sum += double(w.terms[std::size_t(t)].weight);
    const double scale = sum / double(w.terms[std::size_t(p.first)].weight);
    k = double(first.k) * scale, d = double(first.d) * scale;
    Vec3d rest{0, 0, 0}, was{0, 0, 0};
    for (int t = p.first; t < p.first + p.count; ++t) {
      PointTerm& term = w.terms[std::size_t(t)];
      term.weight = float(double(term.weight) / sum);
      rest += double(term.weight) * m.rest[std::size_t(term.slot)];
      was += double(term.weight) * displaced(s.u, term.slot);
    }
    const double held = d / m.tick, all = k + held;
    const Vec3d to = k > 0 ? displacement_to(p.want / sum, rest) : Vec3d{0, 0, 0};
    p.want = (k / all) * to + (held / all) * was;
    p.give = 1 / all;
  }

  void no_forces() noexcept {
    w.loaded.clear();
    std::fill(w.is_loaded.begin(), w.is_loaded.end(), std::uint8_t(0));
  }
  void add_force(int slot, Vec3d f) noexcept {
    if (f.x == 0 && f.y == 0 && f.z == 0) return;
    float* const begin = w.force.data() + 3 * slot;
    if (!w.is_loaded[std::size_t(slot)]) {
      w.is_loaded[std::size_t(slot)] = 1;
      w.loaded.push_back(slot);
      std::fill_n(begin, 3, 0.0f);
    }
    begin[0] += float(f.x), begin[1] += float(f.y), begin[2] += float(f.z);
  }

  void add_fields() noexcept {
    if (!m.floats()) return;
    const Mat3d r = to_mat3(conjugate(turn_of(s.frame)));  // R^T
    double factor[kFrameFields];
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        factor[3 * row + column] = r.m[row][column] - (row == column ? 1.0 : 0.0);
    const Vec3d away = local(m_carried.shift - s.frame.shift), falls = local(m.gravity) - m.gravity;
    for (int k = 0; k < 3; ++k) factor[9 + k] = away[k], factor[12 + k] = falls[k];
    for (int i = 0; i < kFrameFields; ++i)
      if (factor[i] != 0) add_column(m.frame_fields.data() + std::ptrdiff_t(i) * m.stride, factor[i]);
  }
  void no_columns() noexcept {
    w.column.clear();
    w.factor.clear();
  }
  void add_column(const float* column, double factor) noexcept {
    w.column.push_back(column);
    w.factor.push_back(float(factor));
  }
  void add_forces() noexcept {
    for (const std::int32_t slot : w.loaded)
      for (int axis = 0; axis < 3; ++axis)
        if (const float f = w.force[std::size_t(3 * slot + axis)]; f != 0)
          add_column(m.view().column(slot, axis), double(f));
  }
  void add_up(std::vector<float>& to) noexcept {
    field_kernels().add_columns(m.stride, int(w.column.size()), w.column.data(), w.factor.data(), to.data());
  }

  /// Where everything goes that no spring or hand holds: u' = (1 - s) u + s C f.
  void go_without_hands() noexcept {
    std::fill(w.start.begin(), w.start.end(), 0.0f);
    no_columns();
    add_fields();
    add_forces();
    add_up(w.start);
    float way = 0;
    for (std::size_t i = 0; i < w.start.size(); ++i) way = std::max(way, std::fabs(w.start[i] - s.u[i]));
    const double most = kRoot3 * double(way);  // along one axis; at most that in space
    m_share = kShare;
    while (m_share * most > kQuickestReturn && m_share > 1e-4) m_share *= 0.5;
    if (m_loads.empty() && !m.floats() && most < kAsDrawn) m_share = 1;
    const float share = float(m_share);
    for (std::size_t i = 0; i < w.next.size(); ++i) w.next[i] = s.u[i] + share * (w.start[i] - s.u[i]);
  }

  /// What holds, pushes and rubs.
  void balance() noexcept {
    w.now.clear();
    for (const LoadPoint& p : w.points) {
      Vec3d now{0, 0, 0};
      for (int t = p.first; t < p.first + p.count; ++t)
        now += double(w.terms[std::size_t(t)].weight) * displaced(w.next, w.terms[std::size_t(t)].slot);
      w.now.push_back(now);
    }
    if (solve(m.view(), m_share, w.terms, w.now, w.points, w.load_case) < int(w.points.size()))
      m_report.flags |= StepReport::kBadLoad;
    no_forces();
    for (const LoadPoint& p : w.points)
      for (int t = p.first; t < p.first + p.count; ++t)
        add_force(w.terms[std::size_t(t)].slot, (m_share * double(w.terms[std::size_t(t)].weight)) * p.force);
    no_columns();
    add_forces();
    add_up(w.next);
  }

  /// A point's force by its shares, and each load's constant part.
  void report(std::span<Vec3f> reactions) const noexcept {
    const Quatd turn = turn_of(s.frame);
    for (std::size_t i = 0; i < m_loads.size(); ++i) reactions[i] = m_loads[i].f0;
    for (std::size_t i = 0; i < w.points.size(); ++i) {
      const LoadPoint& p = w.points[i];
      std::size_t load = std::size_t(w.first_load[i]);
      for (int t = p.first; t < p.first + p.count; ++load) {
        const NodeLoad& l = m_loads[load];
        if (!(l.k > 0) && !(l.d > 0)) continue;
        reactions[load] += vec_cast<float>(double(w.terms[std::size_t(t++)].weight) * rotate(turn, p.force));
      }
    }
  }

  struct Rigid {
    Vec3d shift{0, 0, 0}, turn{0, 0, 0};
    Vec3d at(Vec3d from_centre) const noexcept { return shift + cross(turn, from_centre); }
  };
  Rigid rigid_part() const noexcept {
    Rigid rigid;
    Vec3d moment{0, 0, 0};
    for (int i = 0; i < m.nodes(); ++i) {
      const Vec3d u = displaced(w.next, i);
      rigid.shift += u;
      moment += cross(m.rest[std::size_t(i)] - m.centre, u);
    }
    rigid.shift = rigid.shift / double(m.nodes());
    rigid.turn = m.inverse_inertia * moment;
    return rigid;
  }

  /// Of the displacements beside a rigid motion, over the organ's size [rad].
  double bend(const Rigid& beside) const noexcept {
    double most = 0;
    for (int i = 0; i < m.nodes(); ++i) {
      const Vec3d u = displaced(w.next, i) - beside.at(m.rest[std::size_t(i)] - m.centre);
      most = std::max(most, dot(u, u));
    }
    return std::sqrt(most) / m.spread;
  }

  /// How far it has turned and bent, now and then.
  void take_its_measure() noexcept {
    if (s.turns != 0) return;
    const Rigid rigid = m.floats() ? Rigid{} : rigid_part();
    s.turn = std::max(length(rigid.turn), bend(rigid));
  }

  /// The rigid part of the displacements goes into the frame of an organ that floats.
  void take_out_rigid_motion() noexcept {
    const Rigid rigid = rigid_part();
    const Quatd by = quat_from_rotation_vector(rigid.turn);
    s.frame.shift += rotate(turn_of(s.frame), rigid.shift);
    const Quatd now = normalised(turn_of(s.frame) * by);
    s.frame.w = now.w, s.frame.x = now.x, s.frame.y = now.y, s.frame.z = now.z;
    for (int i = 0; i < m.nodes(); ++i) {
      const Vec3d r = m.rest[std::size_t(i)] - m.centre;
      const Vec3d u = rotate(conjugate(by), r + displaced(w.next, i) - rigid.shift) - r;
      for (int k = 0; k < 3; ++k) w.next[std::size_t(3 * i + k)] = float(u[k]);
    }
  }

  void write(std::span<NodeState> rows) noexcept {
    const OrganFrame before = m_before;
    const Quatd was = turn_of(before);
    if (m.floats()) take_out_rigid_motion();
    take_its_measure();
    const bool turned = m.floats();
    const Mat3d from_turn = to_mat3(was), to_turn = to_mat3(turn_of(s.frame));
    const Vec3d start = m.centre - m.origin;
    const double per_tick = 1 / m.tick;
    for (int i = 0; i < m.nodes(); ++i) {
      const Vec3d r = m.rest[std::size_t(i)] - m.centre;
      Vec3d from = r + displaced(s.u, i), to = r + displaced(w.next, i);
      if (turned) from = from_turn * from, to = to_turn * to;
      from += before.shift, to += s.frame.shift;
      const Vec3d x = start + to, v = per_tick * (to - from);
      NodeState& n = rows[std::size_t(m.row[std::size_t(i)])];
      n.x = float(x.x), n.y = float(x.y), n.z = float(x.z);
      n.vx = float(v.x), n.vy = float(v.y), n.vz = float(v.z);
      if (m_report.flags & StepReport::kNonFinite || std::isfinite(x.x + x.y + x.z)) continue;
      m_report.flags |= StepReport::kNonFinite;
      m_report.first_bad = m.kept[std::size_t(i)];
    }
    const Vec3d way = s.frame.shift - before.shift;
    s.still = !m.floats() && m_loads.empty() && m_share == 1 && way.x == 0 && way.y == 0 && way.z == 0;
    std::swap(s.u, w.next);
    s.turns = (s.turns + 1) % kInnerTurns;
    place_inner(m, s, s.turns, kInnerTurns, rows);
    // what is still is not placed again
    if (s.still) place_inner_nodes(m, s, rows);
  }

  const ElastostaticModel& m;
  const std::span<const NodeLoad> m_loads;
  const std::span<const std::int32_t> m_point;
  const CarriedBy m_carried;
  ElastostaticState& s;
  ElastostaticWork& w;
  OrganFrame m_before;
  double m_share = kShare;
  StepReport m_report;
};

}  // namespace

std::vector<double> frame_loads(std::span<const Vec3d> points, std::span<const double> mass,
                                std::span<const Anchor> anchors, Vec3d centre) {
  const std::size_t n = 3 * points.size();
  std::vector<double> f(kFrameFields * n, 0.0);
  for (const Anchor& a : anchors)
    for (std::size_t row = 0; row < 3; ++row) {
      const std::size_t at = 3 * std::size_t(a.node) + row;
      for (std::size_t column = 0; column < 3; ++column)
        f[(3 * row + column) * n + at] += a.k * (a.x0 - centre)[int(column)];
      f[(9 + row) * n + at] += a.k;
    }
  for (std::size_t i = 0; i < mass.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) f[(12 + k) * n + 3 * i + k] = mass[i];
  return f;
}

ElastostaticModel make_elastostatic(const DrawnOrgan& organ, std::span<const int> kept,
                                    std::span<const float> compliance, std::span<const float> fields, double tick) {
  ElastostaticModel m;
  m.kept.assign(kept.begin(), kept.end());
  m.slot.assign(organ.points.size(), -1);
  const std::size_t n = kept.size();
  for (std::size_t i = 0; i < n; ++i) {
    m.slot[std::size_t(kept[i])] = std::int32_t(i);
    m.row.push_back(organ.row_of_node[std::size_t(kept[i])]);
    m.rest.push_back(organ.points[std::size_t(kept[i])]);
    m.centre += m.rest.back() / double(n);
  }
  for (std::size_t i = 0; i < organ.points.size(); ++i)
    if (m.slot[i] < 0) m.inner.push_back(inner_node(m, organ, i));
  m.stride = (3 * int(n) + kFieldPack - 1) / kFieldPack * kFieldPack;
  const auto laid_out = [&](std::span<const float> from) {
    std::vector<float> to(from.size() / (3 * n) * std::size_t(m.stride), 0.0f);
    for (std::size_t i = 0; i < from.size(); ++i) to[i / (3 * n) * std::size_t(m.stride) + i % (3 * n)] = from[i];
    return to;
  };
  m.compliance = laid_out(compliance);
  if (!fields.empty()) m.frame_fields = laid_out(fields);
  Mat3d inertia{};
  double squares = 0;
  for (const Vec3d& x : m.rest) {
    const Vec3d r = x - m.centre;
    const double all = dot(r, r);
    squares += all;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) inertia.m[a][b] += (a == b ? all : 0.0) - r[a] * r[b];
  }
  m.inverse_inertia = inverse(inertia);
  m.spread = std::sqrt(squares / double(n));
  m.origin = organ.origin;
  m.gravity = organ.gravity;
  m.tick = tick;
  return m;
}

ElastostaticState rest_state(const ElastostaticModel& m) {
  ElastostaticState s;
  s.u.assign(std::size_t(m.stride), 0.0f);
  return s;
}

ElastostaticWork make_work(const ElastostaticModel& m, int most_loads) {
  ElastostaticWork w;
  w.start.resize(std::size_t(m.stride));
  w.next.resize(std::size_t(m.stride));
  w.force.resize(3 * m.kept.size());
  w.loaded.reserve(m.kept.size());
  w.is_loaded.resize(m.kept.size());
  w.column.reserve(3 * m.kept.size() + kFrameFields);
  w.factor.reserve(3 * m.kept.size() + kFrameFields);
  w.terms.reserve(std::size_t(most_loads));
  w.points.reserve(std::size_t(most_loads));
  w.now.reserve(std::size_t(most_loads));
  w.first_load.reserve(std::size_t(most_loads));
  w.load_case = make_load_case_work(most_loads);
  return w;
}

StepReport advance(const ElastostaticModel& model, std::span<const NodeLoad> loads, std::span<const std::int32_t> point,
                   std::span<Vec3f> reactions, CarriedBy carried, ElastostaticState& state, std::span<NodeState> rows,
                   ElastostaticWork& work) noexcept {
  return Tick(model, loads, point, carried, state, work).make(reactions, rows);
}

void place_inner_nodes(const ElastostaticModel& m, const ElastostaticState& s, std::span<NodeState> rows) noexcept {
  place_inner(m, s, 0, 1, rows);
}

Vec3d place_of(const ElastostaticModel& m, const ElastostaticState& s, int slot) noexcept {
  return to_world(m, s.frame, m.rest[std::size_t(slot)] - m.centre + displaced(s.u, slot));
}

}  // namespace trocar::tissue
