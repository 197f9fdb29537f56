// Reading and changing a network's State between ticks; its hash.
#include <trocar/core/field_hash.hpp>
#include <trocar/tissue/base/law.hpp>
#include <trocar/tissue/network/network.hpp>

namespace trocar::tissue {
namespace {

NodeState& node_of(const NetworkModel& m, NetworkState& s, int node) { return s.nodes[m.row_of_node[node]]; }
const NodeState& node_of(const NetworkModel& m, const NetworkState& s, int node) {
  return s.nodes[m.row_of_node[node]];
}

struct Placed {
  const HalfEdgePack& pack;
  int lane;
  SpringLaw law;
};
Placed placed(const NetworkModel& m, int spring) {
  const int place = m.place[spring], pack = place / kSlice, lane = place % kSlice;
  SpringLaw law{m.p1, m.p2, m.cap};
  if (!m.law_packs.empty()) {
    const LawPack& l = m.law_packs[pack];
    law = {l.p1[lane], l.p2[lane], l.cap[lane]};
  }
  return {m.packs[pack], lane, law};
}

}  // namespace

Vec3d position(const NetworkModel& m, const NetworkState& s, int node) noexcept {
  const NodeState& n = node_of(m, s, node);
  return m.origin + Vec3d{double(n.x), double(n.y), double(n.z)};
}
Vec3d velocity(const NetworkModel& m, const NetworkState& s, int node) noexcept {
  const NodeState& n = node_of(m, s, node);
  return {double(n.vx), double(n.vy), double(n.vz)};
}
void set_position(const NetworkModel& m, NetworkState& s, int node, Vec3d x) noexcept {
  const Vec3f p = vec_cast<float>(x - m.origin);
  NodeState& n = node_of(m, s, node);
  n.x = p.x, n.y = p.y, n.z = p.z;
}
void set_velocity(const NetworkModel& m, NetworkState& s, int node, Vec3d v) noexcept {
  NodeState& n = node_of(m, s, node);
  n.vx = float(v.x), n.vy = float(v.y), n.vz = float(v.z);
}

double spring_strain(const NetworkModel& m, const NetworkState& s, int spring) noexcept {
  const int a = m.spring_nodes[2 * spring], b = m.spring_nodes[2 * spring + 1];
  const double r = length(position(m, s, b) - position(m, s, a));
  return r / double(m.spring_rest[spring]) - 1;
}

float spring_scale(const NetworkModel& m, const NetworkState& s, int spring) noexcept {
  return s.scale[m.place[spring]];
}

double spring_stiffness(const NetworkModel& m, int spring) noexcept {
  const Placed h = placed(m, spring);
  return double(h.pack.stiffness[h.lane]) / double(m.spring_rest[spring]);
}

void set_spring_scale(const NetworkModel& m, NetworkState& s, int spring, float scale) noexcept {
  const float most = scale < m.max_scale ? scale : m.max_scale;
  const float value = most > 0 ? most : 0;
  s.scale[m.place[spring]] = value;
  ++s.version;
}

std::span<const std::uint8_t> folded_rows(const NetworkModel& m, const NetworkState& s, NetworkWork& w) noexcept {
  return s.open_tets == 0 ? std::span<const std::uint8_t>{} : mark_folded(m.tets, s.tet_phase, w.folded);
}

void cut_spring(const NetworkModel& m, NetworkState& s, int spring) noexcept {
  set_spring_scale(m, s, spring, 0);
  const int a = m.spring_nodes[2 * spring], row_b = m.row_of_node[m.spring_nodes[2 * spring + 1]];
  for (int i = m.tet_begin[a]; i < m.tet_begin[a + 1]; ++i) {
    const int t = m.tet_of_node[i];
    const int* r = m.tets[t].row;
    if (r[0] != row_b && r[1] != row_b && r[2] != row_b && r[3] != row_b) continue;
    if (s.tet_phase[t] != 0 && s.tet_phase[t] != kGone) --s.open_tets;
    s.tet_phase[t] = kGone;
  }
}

NetworkEnergy energy(const NetworkModel& m, const NetworkState& s) noexcept {
  NetworkEnergy e;
  for (int i = 0; i < m.nodes; ++i) {
    const Vec3d v = velocity(m, s, i);
    e.kinetic += 0.5 * m.mass[i] * dot(v, v);
    e.gravity -= m.mass[i] * dot(m.gravity, position(m, s, i));
  }
  for (int k = 0; k < m.springs; ++k) {
    const Placed h = placed(m, k);
    const double l = double(m.spring_rest[k]);
    e.elastic +=
        double(spring_scale(m, s, k)) * double(h.pack.stiffness[h.lane]) * l * h.law.energy(spring_strain(m, s, k));
  }
  return e;
}

void add_to_hash(core::Hasher& h, const NetworkState& s) noexcept { core::add_fields(h, s); }

void add_to_hash(core::Hasher& h, const NetworkModel& m) noexcept { core::add_fields(h, m); }

}  // namespace trocar::tissue
