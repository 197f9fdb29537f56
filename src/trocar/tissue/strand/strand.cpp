// One tick of a strand: assemble, prescribe, factor, solve, report.
//
//   (M (1 + dt gamma) + dt C + dt^2 K) v' = M v + dt (f(x) + f_ext),   x' = x + dt v'
//
// which is backward Euler for the equation of motion [KCM99 eq.1] with the forces linearised about x.
#include <algorithm>
#include <cmath>

#include <trocar/core/field_hash.hpp>
#include <trocar/tissue/strand/strand.hpp>
#include <trocar/tissue/strand/strand_band.hpp>

namespace trocar::tissue {
namespace {

void push(std::vector<double>& rhs, int node, Vec3d impulse) {
  for (int axis = 0; axis < 3; ++axis) rhs[3 * node + axis] += impulse[axis];
}
Vec3d at(const std::vector<double>& a, int node) { return {a[3 * node], a[3 * node + 1], a[3 * node + 2]}; }

/// Masses, weight, drag against space.
void add_inertia(const StrandModel& m, const StrandState& s, StrandWork& w) {
  const double dt = m.tick, one[1] = {1};
  for (int i = 0; i < m.nodes; ++i) {
    add_term(w.matrix, i, one, 1, isotropic(m.mass[i] * (1 + dt * m.gamma)));
    push(w.rhs, i, m.mass[i] * (s.v[i] + dt * m.gravity));
  }
}

/// Length of rest of an element [m].
double rest_of(const StrandModel& m, const StrandState& s, int e) {
  return s.shrunk.empty() ? m.rest_length[e] : s.shrunk[e] * m.rest_length[e];
}

/// Tension EA shape(strain) [KCM99 eq.5]. The slope is the larger of now and a tick ahead, so that a strand that is
/// being jerked tight meets its later stiffness; slack elements have no sideways stiffness.
void add_stretch(const StrandModel& m, const StrandState& s, StrandWork& w) {
  const double dt = m.tick, c[2] = {-1, 1};
  for (int e = 0; e + 1 < m.nodes; ++e) {
    if (!s.alive[e]) continue;
    const Vec3d d = s.x[e + 1] - s.x[e], dv = s.v[e + 1] - s.v[e];
    const double r = length(d), l = rest_of(m, s, e), stiffness = m.stretch[e] * s.scale[e];
    const Vec3d t = r > 1e-30 ? d / r : Vec3d{1, 0, 0};
    const double strain = r / l - 1, ahead = length(d + dt * dv) / l - 1;
    const double slope_now = m.law.slope(strain), slope_ahead = m.law.slope(ahead);
    const double slope = slope_now > slope_ahead ? slope_now : slope_ahead;
    const double tension = stiffness * m.law.shape(strain);
    const double sideways = tension > 0 ? tension / r : 0;
    add_term(w.matrix, e, c, 2,
             along(stiffness / l * (dt * dt * slope + dt * m.damping_time), t) + across(dt * dt * sideways, t));
    push(w.rhs, e, (dt * tension) * t);
    push(w.rhs, e + 1, (-dt * tension) * t);
  }
}

bool bends(const StrandState& s, int i) { return s.alive[i - 1] && s.alive[i]; }
double bend_stiffness(const StrandModel& m, const StrandState& s, int i) {
  return m.bend[i] * 0.5 * (s.scale[i - 1] + s.scale[i]);
}
/// The node nearest to `first` in [first, last] that is prescribed: its place among the prescribed nodes, or -1.
int holder_in(const StrandModel& m, int first, int last) {
  for (std::size_t k = 0; k < m.prescribed_nodes.size(); ++k)
    if (m.prescribed_nodes[k] >= first && m.prescribed_nodes[k] <= last) return int(k);
  return -1;
}

/// Directions of the chain at its inner nodes.
void find_directions(const StrandModel& m, const StrandState& s, std::vector<Vec3d>& direction) {
  for (int i = 1; i + 1 < m.nodes; ++i) direction[i] = chain_direction(s.x, i, m.tangent_rest[i]);
}

/// Drawn bend of node i in the frame of direction t and director d.
Vec3d bend_in_frame(const StrandModel& m, int i, Vec3d t, Vec3d d) {
  const Vec3d b = m.bend_rest[i], r = m.director_rest[i];
  return dot(b, r) * d + dot(b, cross(m.tangent_rest[i], r)) * cross(t, d);
}

/// bend[i] = R_i b_i for the inner nodes of one connected piece, first .. last (nodes). Directors go without twist from
/// the held node outwards; in a loose piece from its first node, then all spin by the one angle that brings the bends
/// closest to what they are.
void turn_bends(const StrandModel& m, const StrandState& s, std::span<const StrandEnd> ends, int first, int last,
                const std::vector<Vec3d>& direction, std::vector<Vec3d>& bend) {
  if (last - first < 2) return;
  const int k = holder_in(m, first, last);
  const int held = k < 0 ? first : m.prescribed_nodes[k];
  const int base = held < first + 1 ? first + 1 : (held > last - 1 ? last - 1 : held);
  Vec3d drawn_t = m.tangent_rest[base], drawn_d = m.director_rest[base];
  if (k >= 0 && !ends.empty() && ends[k].turned) drawn_t = ends[k].turn * drawn_t, drawn_d = ends[k].turn * drawn_d;
  const Vec3d base_t = direction[base], base_d = carried(drawn_t, base_t, drawn_d);

  double aligned = 0, across_it = 0;
  const auto visit = [&](int i, Vec3d t, Vec3d d) {
    bend[i] = bend_in_frame(m, i, t, d);
    const Vec3d now = bend_stiffness(m, s, i) * second_difference(s.x, i);
    aligned += dot(now, bend[i]);
    across_it += dot(now, cross(t, bend[i]));
  };
  visit(base, base_t, base_d);
  for (int step : {1, -1}) {
    Vec3d t = base_t, d = base_d;
    for (int i = base + step; i > first && i < last; i += step) {
      const Vec3d next = direction[i];
      d = carried(t, next, d);
      t = next;
      visit(i, t, d);
    }
  }
  const double size = std::sqrt(aligned * aligned + across_it * across_it);
  if (k >= 0 || !(size > 1e-18)) return;
  for (int i = first + 1; i < last; ++i)
    bend[i] = (aligned / size) * bend[i] + (across_it / size) * cross(direction[i], bend[i]);
}

void turn_all_bends(const StrandModel& m, const StrandState& s, std::span<const StrandEnd> ends,
                    const std::vector<Vec3d>& direction, std::vector<Vec3d>& bend) {
  for (Vec3d& b : bend) b = {};
  for (int first = 0; first < m.nodes;) {
    int last = first;
    while (last + 1 < m.nodes && s.alive[last]) ++last;
    turn_bends(m, s, ends, first, last, direction, bend);
    first = last + 1;
  }
}

/// What the bend at node i differs from its rest by, across the chain.
Vec3d bend_error(const StrandState& s, int i, Vec3d t, Vec3d bend) {
  const Vec3d q = second_difference(s.x, i) - bend;
  return q - dot(q, t) * t;
}

void add_bending(const StrandModel& m, const StrandState& s, std::span<const StrandEnd> ends, StrandWork& w) {
  const double dt = m.tick;
  find_directions(m, s, w.direction);
  turn_all_bends(m, s, ends, w.direction, w.bend_now);
  for (int i = 1; i + 1 < m.nodes; ++i) {
    if (!bends(s, i)) continue;
    const Vec3d t = w.direction[i];
    const double k = bend_stiffness(m, s, i);
    add_term(w.matrix, i - 1, kBendStencil, 3, across(k * (dt * dt + dt * m.damping_time), t));
    const Vec3d impulse = (-dt * k) * bend_error(s, i, t, w.bend_now[i]);
    for (int j = 0; j < 3; ++j) push(w.rhs, i - 1 + j, kBendStencil[j] * impulse);
  }
}

bool is_zero(Vec3d a) { return a.x == 0 && a.y == 0 && a.z == 0; }

void add_foundation(const StrandModel& m, const StrandState& s, const StrandGround& ground, StrandWork& w) {
  const double dt = m.tick, one[1] = {1};
  for (int i = 0; i < m.nodes; ++i) {
    const double k = m.foundation[i] * s.foundation_scale[i];
    if (!(k > 0)) continue;
    const Vec3d u = s.x[i] - m.foundation_point[i] - ground.x;
    const double more = m.stiffening * dot(u, u);
    add_term(w.matrix, i, one, 1,
             isotropic(k * (dt * dt * (1 + more) + dt * m.foundation_damping_time)) +
                 along(2 * k * dt * dt * m.stiffening, u));
    push(w.rhs, i, (-dt * k * (1 + more)) * u);
    if (!is_zero(ground.v)) push(w.rhs, i, (dt * k * m.foundation_damping_time) * ground.v);
  }
}

bool usable(const StrandModel& m, const StrandLoad& l) {
  const double sum = std::fabs(l.f0.x) + std::fabs(l.f0.y) + std::fabs(l.f0.z) + std::fabs(l.x0.x) + std::fabs(l.x0.y) +
                     std::fabs(l.x0.z) + std::fabs(l.dir.x) + std::fabs(l.dir.y) + std::fabs(l.dir.z);
  return l.element >= 0 && l.element + 1 < m.nodes && l.w >= 0 && l.w <= 1 && l.k >= 0 && l.d >= 0 && l.k < 1e12 &&
         l.d < 1e12 && sum < 1e12;
}
Vec3d projected(const StrandLoad& l, Vec3d u) { return is_zero(l.dir) ? u : dot(l.dir, u) * l.dir; }

StepReport add_loads(const StrandModel& m, std::span<const StrandLoad> loads, const StrandState& s, StrandWork& w) {
  const double dt = m.tick;
  StepReport report;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const StrandLoad& l = loads[i];
    if (!usable(m, l)) {
      report = report | StepReport{StepReport::kBadLoad, int(i)};
      continue;
    }
    const int e = l.element;
    const double c[2] = {1 - l.w, l.w}, q = dt * (l.d + dt * l.k);
    const Vec3d p = c[0] * s.x[e] + c[1] * s.x[e + 1];
    add_term(w.matrix, e, c, 2, is_zero(l.dir) ? isotropic(q) : along(q, l.dir));
    const Vec3d impulse = dt * (l.f0 + l.k * projected(l, l.x0 - p));
    push(w.rhs, e, c[0] * impulse);
    push(w.rhs, e + 1, c[1] * impulse);
  }
  return report;
}

/// Force each load exerted, at the velocities found.
void report_loads(const StrandModel& m, std::span<const StrandLoad> loads, const StrandState& before,
                  const std::vector<double>& v, std::span<Vec3d> reactions) {
  if (reactions.empty()) return;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const StrandLoad& l = loads[i];
    reactions[i] = {};
    if (!usable(m, l)) continue;
    const int e = l.element;
    const Vec3d speed = (1 - l.w) * at(v, e) + l.w * at(v, e + 1);
    const Vec3d p = (1 - l.w) * before.x[e] + l.w * before.x[e + 1] + m.tick * speed;
    reactions[i] = l.f0 + projected(l, l.k * (l.x0 - p) - l.d * speed);
  }
}

/// First and last row of the system that a node's rows touch.
struct RowReach {
  int first, last;
};
RowReach reach_of(const StrandModel& m, int node) {
  const int rows = 3 * m.nodes, low = 3 * node - kStrandBand, high = 3 * node + 2 + kStrandBand;
  return {low > 0 ? low : 0, high < rows ? high : rows - 1};
}
/// Entry (3 node + axis, j) of the matrix as it was before nodes were prescribed, for the k-th of them; j within its
/// reach.
double& saved_entry(StrandWork& w, int k, int axis, const RowReach& reach, int j) {
  return w.saved[std::size_t((3 * k + axis) * kStrandReach + j - reach.first)];
}

void save_prescribed(const StrandModel& m, StrandWork& w) {
  for (int k = 0; k < int(m.prescribed_nodes.size()); ++k) {
    const int p = m.prescribed_nodes[k];
    const RowReach reach = reach_of(m, p);
    for (int axis = 0; axis < 3; ++axis) {
      for (int j = reach.first; j <= reach.last; ++j)
        saved_entry(w, k, axis, reach, j) = band_entry(w.matrix, 3 * p + axis, j);
      w.force[3 * k + axis] = w.rhs[3 * p + axis];
    }
  }
}

/// The row of the untouched system at a prescribed node says what impulse its holder gave.
Vec3d force_on_holder(const StrandModel& m, int k, StrandWork& w) {
  const RowReach reach = reach_of(m, m.prescribed_nodes[k]);
  Vec3d force;
  for (int axis = 0; axis < 3; ++axis) {
    double hold = -w.force[3 * k + axis];
    for (int j = reach.first; j <= reach.last; ++j) hold += saved_entry(w, k, axis, reach, j) * w.rhs[j];
    force[axis] = -hold / m.tick;
  }
  return force;
}

/// How that changes as the holder moves: what is left of the node's own block when all free nodes are eliminated,
/// K_pp - K_pf K_ff^-1 K_fp. With L D L^T = K_ff only L y = K_fp has to be solved, from the first row where K_fp is.
Mat3d tangent_at_holder(const StrandModel& m, int k, StrandWork& w) {
  const int p = m.prescribed_nodes[k], rows = 3 * m.nodes;
  const RowReach reach = reach_of(m, p);
  std::fill(w.columns.begin() + 3 * reach.first, w.columns.end(), 0.0);
  for (int axis = 0; axis < 3; ++axis)
    for (int j = reach.first; j <= reach.last; ++j)
      if (!m.prescribed[j / 3]) w.columns[3 * j + axis] = saved_entry(w, k, axis, reach, j);
  numerics::band_forward(rows, kStrandBand, w.matrix.data(), w.columns.data(), 3, reach.first);
  Sym3 gone;
  for (int j = reach.first; j < rows; ++j) {
    const double* const y = w.columns.data() + 3 * j;
    gone = gone + along(1 / w.matrix[numerics::band_at(kStrandBand, j, j)], {y[0], y[1], y[2]});
  }
  const double eliminated[3][3] = {
      {gone.xx, gone.xy, gone.xz}, {gone.xy, gone.yy, gone.yz}, {gone.xz, gone.yz, gone.zz}};
  Mat3d tangent;
  for (int axis = 0; axis < 3; ++axis)
    for (int other = 0; other < 3; ++other)
      tangent.m[axis][other] =
          (saved_entry(w, k, axis, reach, 3 * p + other) - eliminated[axis][other]) / (m.tick * m.tick);
  return tangent;
}

void report_ends(const StrandModel& m, std::span<StrandReaction> reactions, StrandWork& w) {
  const int held = reactions.empty() ? 0 : int(m.prescribed_nodes.size());
  for (int k = 0; k < held; ++k) reactions[k] = {force_on_holder(m, k, w), tangent_at_holder(m, k, w)};
}

}  // namespace

StepReport advance(const StrandModel& m, std::span<const StrandEnd> ends, std::span<const StrandLoad> loads,
                   std::span<StrandReaction> end_reactions, std::span<Vec3d> load_reactions, StrandState& s,
                   StrandWork& w, const StrandGround& ground) noexcept {
  const double dt = m.tick;
  const int rows = 3 * m.nodes;
  for (double& a : w.matrix) a = 0;
  for (double& a : w.rhs) a = 0;
  add_inertia(m, s, w);
  add_stretch(m, s, w);
  add_bending(m, s, ends, w);
  add_foundation(m, s, ground, w);
  StepReport report = add_loads(m, loads, s, w);

  save_prescribed(m, w);
  for (std::size_t k = 0; k < m.prescribed_nodes.size(); ++k) {
    const int p = m.prescribed_nodes[k];
    prescribe(w.matrix, w.rhs, m.nodes, p, ends.empty() ? Vec3d{} : (ends[k].x - s.x[p]) / dt);
  }
  const int lost = numerics::band_factor(rows, kStrandBand, w.matrix.data());
  if (lost >= 0) {
    std::fill(end_reactions.begin(), end_reactions.end(), StrandReaction{});
    std::fill(load_reactions.begin(), load_reactions.end(), Vec3d{});
  }
  if (lost >= 0) return report | StepReport{StepReport::kIndefinite, lost / 3};
  numerics::band_solve(rows, kStrandBand, w.matrix.data(), w.rhs.data());
  report_ends(m, end_reactions, w);
  report_loads(m, loads, s, w.rhs, load_reactions);

  for (int i = 0; i < m.nodes; ++i) {
    s.v[i] = at(w.rhs, i);
    s.x[i] += dt * s.v[i];
    const double size = std::fabs(s.x[i].x) + std::fabs(s.x[i].y) + std::fabs(s.x[i].z) + std::fabs(s.v[i].x) +
                        std::fabs(s.v[i].y) + std::fabs(s.v[i].z);
    if (!(size < 1e6)) report = report | StepReport{StepReport::kNonFinite, i};
  }
  for (std::size_t k = 0; !ends.empty() && k < m.prescribed_nodes.size(); ++k) {
    s.x[m.prescribed_nodes[k]] = ends[k].x;
    s.v[m.prescribed_nodes[k]] = ends[k].v;
  }
  return report;
}

void cut_element(StrandState& s, int element) noexcept { s.alive[element] = 0; }

double element_strain(const StrandModel& m, const StrandState& s, int e) noexcept {
  return s.alive[e] ? length(s.x[e + 1] - s.x[e]) / rest_of(m, s, e) - 1 : 0;
}

StrandEnergy energy(const StrandModel& m, const StrandState& s) {
  StrandEnergy total;
  for (int i = 0; i < m.nodes; ++i) {
    total.kinetic += 0.5 * m.mass[i] * dot(s.v[i], s.v[i]);
    total.gravity -= m.mass[i] * dot(m.gravity, s.x[i]);
    const Vec3d u = s.x[i] - m.foundation_point[i];
    const double u2 = dot(u, u);
    total.foundation += 0.5 * m.foundation[i] * s.foundation_scale[i] * u2 * (1 + 0.5 * m.stiffening * u2);
  }
  for (int e = 0; e + 1 < m.nodes; ++e)
    if (s.alive[e])
      total.stretch += m.stretch[e] * s.scale[e] * rest_of(m, s, e) * m.law.energy(element_strain(m, s, e));
  std::vector<Vec3d> bend(m.nodes), direction(m.nodes);
  find_directions(m, s, direction);
  turn_all_bends(m, s, {}, direction, bend);
  for (int i = 1; i + 1 < m.nodes; ++i) {
    if (!bends(s, i)) continue;
    const Vec3d q = bend_error(s, i, direction[i], bend[i]);
    total.bending += 0.5 * bend_stiffness(m, s, i) * dot(q, q);
  }
  return total;
}

void add_to_hash(core::Hasher& h, const StrandState& s) noexcept { core::add_fields(h, s); }

void add_to_hash(core::Hasher& h, const StrandModel& m) noexcept { core::add_fields(h, m); }

}  // namespace trocar::tissue
