// Springs that heat has made shorter and stiffer.
#include <algorithm>
#include <cmath>

#include <trocar/tissue/network/network_scars.hpp>

namespace trocar::tissue {
namespace {

/// What nodes are as hard to move as with the second springs.
void add_inertia(const LoadedBody& m, std::span<const ScarredSpring> springs, std::vector<double>& inertia) noexcept {
  std::copy_n(m.mass.begin(), m.nodes, inertia.begin());
  for (const ScarredSpring& s : springs) {
    const double more = 0.5 * m.dt * m.dt * s.k * (s.stiff - 1);
    inertia[std::size_t(s.a)] += more;
    inertia[std::size_t(s.b)] += more;
  }
}

Vec3f shared(Vec3f from, Vec3f to, float share) noexcept { return from + share * (to - from); }

}  // namespace

/// From here on the body's nodes are as heavy as they are to move.
ScarredSprings::ScarredSprings(LoadedBody& body, std::span<const ScarredSpring> springs, ScarWork& scratch) noexcept
    : m(body), m_springs(springs) {
  if (springs.empty()) return;
  add_inertia(body, springs, scratch.inertia);
  std::size_t count = 0;
  for (int i = 0; i < body.nodes; ++i) {
    const double mass = body.mass[std::size_t(i)], inertia = scratch.inertia[std::size_t(i)];
    if (inertia > mass) scratch.nodes[count++] = {i, body.row_of_node[std::size_t(i)], float(mass / inertia), {}};
  }
  m_nodes = std::span(scratch.nodes).first(count);
  body.mass = scratch.inertia;
}

void ScarredSprings::mark(const std::vector<NodeState>& nodes) noexcept {
  for (ScarredNode& n : m_nodes) n.before = speed(nodes[std::size_t(n.row)]);
}

void ScarredSprings::ease(std::vector<NodeState>& nodes) const noexcept {
  for (const ScarredNode& n : m_nodes) {
    NodeState& now = nodes[std::size_t(n.row)];
    const Vec3f v = shared(n.before, speed(now), n.share);
    now.vx = v.x, now.vy = v.y, now.vz = v.z;
  }
}

void ScarredSprings::apply(const NodeState* in, NodeState* out) const noexcept {
  for (const ScarredNode& n : m_nodes)
    move_to(out[n.row], in[n.row], shared(speed(in[n.row]), speed(out[n.row]), n.share), float(m.dt));
  for (const ScarredSpring& s : m_springs) pull(s, in, out);
  for (const ScarredNode& n : m_nodes) move_to(out[n.row], in[n.row], speed(out[n.row]), float(m.dt));
}

/// A spring shorter than a quarter of l has no direction: nothing.
void ScarredSprings::pull(const ScarredSpring& s, const NodeState* in, NodeState* out) const noexcept {
  const int a = m.row_of_node[std::size_t(s.a)], b = m.row_of_node[std::size_t(s.b)];
  const Vec3d apart = vec_cast<double>(place(in[b]) - place(in[a]));
  const double now = length(apart);
  if (!(s.k > 0) || now < 0.25 * s.l) return;
  const double force = s.k * (s.stiff - 1) * now - s.k * (s.stiff * s.share - 1) * s.l;
  const Vec3d impulse = (m.dt * force / now) * apart;
  push(s.a, impulse, out[a]);
  push(s.b, -impulse, out[b]);
}

void ScarredSprings::push(int node, Vec3d impulse, NodeState& out) const noexcept {
  const Vec3d change = impulse / (m.mass[std::size_t(node)] * (1 + m.dt * m.gamma));
  const int held = m.fixed[std::size_t(node)];
  if (!(held & kHeldX)) out.vx = float(double(out.vx) + change.x);
  if (!(held & kHeldY)) out.vy = float(double(out.vy) + change.y);
  if (!(held & kHeldZ)) out.vz = float(double(out.vz) + change.z);
}

}  // namespace trocar::tissue
