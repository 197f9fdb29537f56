// One tick of a sheet: borders on their way, bending as impulses, stretch in the network's sub-steps.
#include <algorithm>
#include <cmath>

#include <trocar/core/field_hash.hpp>
#include <trocar/tissue/base/float4.hpp>
#include <trocar/tissue/membrane/membrane.hpp>
#include <trocar/tissue/network/network_scars.hpp>

namespace trocar::tissue {
namespace {

const NodeState& row_of(const MembraneModel& m, const MembraneState& s, int node) {
  return s.network.nodes[std::size_t(m.network.row_of_node[std::size_t(node)])];
}

typedef double Double2 __attribute__((vector_size(16), may_alias));

struct Place {
  Float4 x, v;
};
Place place_at(const NodeState& n) noexcept { return {load4(&n.x), load4(&n.vx)}; }

struct Double4 {
  Double2 xy{0, 0}, z{0, 0};
};
void add(RowForce& to, double c, const Double4& pull, Double4& sum) noexcept {
  Double2* const all = reinterpret_cast<Double2*>(&to);
  const Double2 xy = c * pull.xy, z = c * pull.z;
  all[0] += xy, all[1] += z;
  sum.xy += xy, sum.z += z;
}

/// Forces of bending and of its damping on all rows. Differences from the stencil's first node: no digits are lost,
/// and the sum of the forces is exactly zero but for rounding.
void bending_forces(const MembraneModel& m, const MembraneState& s, std::vector<RowForce>& force) noexcept {
  std::fill(force.begin(), force.end(), RowForce{});
  const float tau = float(m.bending_damping_time);
  const NodeState* const nodes = s.network.nodes.data();
  const int* const row_of_node = m.network.row_of_node.data();
  for (std::size_t b = 0; b < m.bends.size(); ++b) {
    if (s.torn[b]) continue;
    const BendStencil& e = m.bends[b];
    const Place o = place_at(nodes[row_of_node[e.node[0]]]);
    Float4 q{};
    for (std::size_t j = 1; j < std::size_t(e.count); ++j) {
      const Place n = place_at(nodes[row_of_node[e.node[j]]]);
      q += e.c[j] * ((n.x - o.x) + tau * (n.v - o.v));
    }
    const double k = -double(e.k);
    const Double4 pull{{k * double(q[0]), k * double(q[1])}, {k * double(q[2]), 0}};
    Double4 back;
    for (std::size_t j = 1; j < std::size_t(e.count); ++j)
      add(force[std::size_t(row_of_node[e.node[j]])], double(e.c[j]), pull, back);
    Double4 unused;
    add(force[std::size_t(row_of_node[e.node[0]])], -1, back, unused);
  }
}

/// v += dt (f / m - gamma v) on the nodes that are free.
void kick(const MembraneModel& m, MembraneState& s, const std::vector<RowForce>& force, double dt) noexcept {
  const double keep = 1 / (1 + dt * m.gamma);
  for (int i = 0; i < m.nodes(); ++i) {
    if (m.network.fixed[std::size_t(i)] == kHeld) continue;
    const double w = dt / m.network.mass[std::size_t(i)];
    const std::size_t row = std::size_t(m.network.row_of_node[std::size_t(i)]);
    const RowForce& f = force[row];
    NodeState& n = s.network.nodes[row];
    n.vx = float(keep * (double(n.vx) + w * f.x));
    n.vy = float(keep * (double(n.vy) + w * f.y));
    n.vz = float(keep * (double(n.vz) + w * f.z));
  }
}

/// Volume, its gradient, and how what is enclosed presses with its weight.
EnclosedVolume look_inside(const MembraneModel& m, const MembraneState& s, MembraneWork& w) noexcept {
  for (int i = 0; i < m.nodes(); ++i) w.place[std::size_t(i)] = position(m.network, s.network, i);
  return enclosed_volume(m.triangles, w.place, w.gradient, (s.enclosure.left * m.enclosure.density) * m.network.gravity,
                         w.weight);
}

/// v += dt f / m at a free node.
void push(const MembraneModel& m, MembraneState& s, int i, Vec3d impulse) noexcept {
  const Vec3d change = impulse / m.network.mass[std::size_t(i)];
  NodeState& n = s.network.nodes[std::size_t(m.network.row_of_node[std::size_t(i)])];
  n.vx = float(double(n.vx) + change.x);
  n.vy = float(double(n.vy) + change.y);
  n.vz = float(double(n.vz) + change.z);
}

/// One impulse of what is enclosed: of its weight, which presses on the wall while its inertia is the nodes', and of
/// its pressure as it is at the end of the step.
void press(const MembraneModel& m, MembraneState& s, MembraneWork& w, double dt) noexcept {
  const EnclosedVolume inside = look_inside(m, s, w);
  double rate = 0, give = 0;
  for (int i = 0; i < m.nodes(); ++i) {
    const std::size_t at = std::size_t(i);
    const bool free = m.network.fixed[at] != kHeld;
    if (free) push(m, s, i, dt * (w.weight[at] - m.contents[at] * m.network.gravity));
    const Vec3d g = w.gradient[at];
    rate += dot(g, velocity(m.network, s.network, i));
    if (free) give += dot(g, g) / m.network.mass[at];
  }
  press_step(m.enclosure, inside.volume, rate, give, dt, s.enclosure);
  for (int i = 0; i < m.nodes(); ++i)
    if (m.network.fixed[std::size_t(i)] != kHeld)
      push(m, s, i, (dt * s.enclosure.pressure) * w.gradient[std::size_t(i)]);
}

bool encloses(const MembraneModel& m) noexcept { return m.enclosure.kind != Enclosure::none; }

}  // namespace

void border_pulls(const MembraneModel& m, const MembraneState& s, MembraneWork& w,
                  std::span<BorderPull> pulls) noexcept {
  bending_forces(m, s, w.force);
  if (encloses(m)) look_inside(m, s, w);
  for (std::size_t h = 0; h < m.held_nodes.size(); ++h) {
    const int i = m.held_nodes[h];
    const NodeState& o = row_of(m, s, i);
    BorderPull p;
    const RowForce& bending = w.force[std::size_t(m.network.row_of_node[std::size_t(i)])];
    p.force = {bending.x, bending.y, bending.z};
    if (encloses(m)) p.force += s.enclosure.pressure * w.gradient[std::size_t(i)] + w.weight[std::size_t(i)];
    p.k = m.border_bending[h];
    p.d = m.border_bending[h] * m.bending_damping_time;
    for (int k = m.border_first[h]; k < m.border_first[h + 1]; ++k) {
      const BorderSpring& e = m.border_spring[std::size_t(k)];
      const double scale = double(spring_scale(m.network, s.network, e.spring));
      if (!(scale > 0)) continue;
      const NodeState& n = row_of(m, s, e.other);
      const Vec3d r{double(n.x - o.x), double(n.y - o.y), double(n.z - o.z)};
      const Vec3d v{double(n.vx - o.vx), double(n.vy - o.vy), double(n.vz - o.vz)};
      const double now = length(r);
      if (!(now > 1e-12)) continue;
      const double strain = now / e.rest - 1;
      const Vec3d direction = r / now;
      p.force += (scale * (e.stiffness * m.law.shape(strain) + e.damping * dot(v, direction))) * direction;
      p.k += scale * e.stiffness / e.rest * m.law.slope(strain);
      p.d += scale * e.damping;
    }
    pulls[h] = p;
  }
}

StepReport advance(const MembraneModel& m, std::span<const Vec3d> targets, std::span<const NodeLoad> loads,
                   std::span<Vec3f> reactions, MembraneState& s, MembraneWork& w,
                   std::span<const ScarredSpring> springs) noexcept {
  for (std::size_t h = 0; h < m.held_nodes.size(); ++h) {
    const int i = m.held_nodes[h];
    const Vec3d way = targets.empty() ? Vec3d{} : targets[h] - position(m.network, s.network, i);
    set_velocity(m.network, s.network, i, way / m.tick);
  }
  StepReport report;
  for (Vec3f& r : reactions) r = {};
  const double dt = m.tick / m.bend_steps;
  const float share = 1.0f / float(m.bend_steps);
  const bool several = m.bend_steps > 1 && reactions.size() <= w.reaction.size();
  LoadedBody body = loaded_body(m.network);
  ScarredSprings scars(body, springs, w.network.scars);
  for (int step = 0; step < m.bend_steps; ++step) {
    scars.mark(s.network.nodes);
    bending_forces(m, s, w.force);
    kick(m, s, w.force, dt);
    if (encloses(m)) press(m, s, w, dt);
    scars.ease(s.network.nodes);
    const std::span<Vec3f> part = several ? std::span<Vec3f>(w.reaction.data(), reactions.size()) : reactions;
    report = report | advance(m.network, loads, part, s.network, w.network, nullptr, Hands::off, springs);
    if (!several) continue;
    for (std::size_t i = 0; i < reactions.size(); ++i) reactions[i] += share * part[i];
  }
  for (std::size_t h = 0; h < m.held_nodes.size() && !targets.empty(); ++h)
    set_position(m.network, s.network, m.held_nodes[h], targets[h]);
  return report;
}

void tear_bends(const MembraneModel& m, std::span<const std::uint8_t> parted, MembraneState& s) noexcept {
  for (std::size_t b = 0; b < m.bends.size(); ++b)
    for (int k = m.bend_first[b]; k < m.bend_first[b + 1]; ++k)
      if (parted[std::size_t(m.bend_triangle[std::size_t(k)])]) s.torn[b] = 1;
  if (!encloses(m)) return;
  for (std::uint8_t each : parted)
    if (each) s.enclosure.leaking = 1;
}

EnclosedVolume enclosed_volume(const MembraneModel& m, const MembraneState& s) {
  std::vector<Vec3d> x;
  for (int i = 0; i < m.nodes(); ++i) x.push_back(position(m.network, s.network, i));
  return enclosed_volume(m.triangles, x, {});
}

MembraneEnergy energy(const MembraneModel& m, const MembraneState& s) {
  const NetworkEnergy n = energy(m.network, s.network);
  MembraneEnergy e{n.kinetic, n.elastic, 0, n.gravity};
  for (std::size_t b = 0; b < m.bends.size(); ++b) {
    if (s.torn[b]) continue;
    const BendStencil& t = m.bends[b];
    const Vec3d o = position(m.network, s.network, t.node[0]);
    Vec3d q{0, 0, 0};
    for (std::int32_t j = 1; j < t.count; ++j)
      q += double(t.c[std::size_t(j)]) * (position(m.network, s.network, t.node[std::size_t(j)]) - o);
    e.bending += 0.5 * double(t.k) * dot(q, q);
  }
  if (encloses(m) && !s.enclosure.leaking) e.pressure = pressure_energy(m.enclosure, enclosed_volume(m, s).volume);
  return e;
}

void add_to_hash(core::Hasher& h, const MembraneState& s) noexcept { core::add_fields(h, s); }

void add_to_hash(core::Hasher& h, const MembraneModel& m) noexcept { core::add_fields(h, m); }

}  // namespace trocar::tissue
