// The network's sub-step once more, plainly: one loop over nodes, one over their springs, in float or double. In float
// it gives the kernels' bits (a test says so); in double it is what physics is validated against.
//
//   ReferenceNetwork<double> reference(description, build(description, tick));
//   reference.step(dt);
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <trocar/tissue/base/law.hpp>
#include <trocar/tissue/network/network.hpp>

namespace trocar::tissue {

template <class Real>
class ReferenceNetwork {
 public:
  struct Node {
    Vec3<Real> x, v;
  };

  /// Takes the order of nodes and springs from the model, all figures from the description. Positions are relative to
  /// the model's origin.
  ReferenceNetwork(const NetworkDescription& d, const NetworkModel& m)
      : m_gamma(d.global_damping), m_gravity(d.gravity) {
    m_nodes.resize(m.rows);
    m_edges.resize(m.rows);
    m_rows = m.row_of_node;
    for (int i = 0; i < m.nodes; ++i) {
      Node& n = m_nodes[m.row_of_node[i]];
      n.x = vec_cast<Real>(m.rest[i] - m.origin);
      for (int axis = 0; axis < 3; ++axis) m_masses.push_back(m.fixed[i] & (1 << axis) ? 0 : m.mass[i]);
    }
    // Each row adds up the springs that it evaluates, then those that are evaluated at their other ends; both by the
    // rows of their other ends.
    for (const bool source : {true, false}) add_edges(d, m, source);
  }

  Node& node(int i) { return m_nodes[m_rows[i]]; }
  const Node& node(int i) const { return m_nodes[m_rows[i]]; }

  /// v += dt a, then x += dt v                                                            [KCM99 eq.3]
  void step(double dt) {
    m_next = m_nodes;
    const double decay = 1 / (1 + dt * m_gamma);
    for (std::size_t i = 0; i < m_rows.size(); ++i) {
      const int r = m_rows[i];
      const Vec3<Real> f = force(r);
      Node& n = m_next[r];
      for (int axis = 0; axis < 3; ++axis) {
        const double mass = m_masses[3 * i + axis];
        const Real w = mass > 0 ? Real(dt / (mass * (1 + dt * m_gamma))) : Real(0);
        const Real g = mass > 0 ? Real(dt * m_gravity[axis] * decay) : Real(0);
        n.v[axis] = flushed(Real(decay) * n.v[axis] + (w * f[axis] + g));
        n.x[axis] = n.x[axis] + Real(dt) * n.v[axis];
      }
    }
    m_nodes.swap(m_next);
  }

  /// -g_i: the sum of the springs' and dampers' forces at a row                            [KCM99 eq.2]
  Vec3<Real> force(int row) const {
    Vec3<Real> f{};
    for (const Edge& e : m_edges[row]) {
      const Vec3<Real> d = m_nodes[e.other].x - m_nodes[row].x, dv = m_nodes[e.other].v - m_nodes[row].v;
      const Real r2 = (d.x * d.x + d.y * d.y) + d.z * d.z;
      const Real r = std::sqrt(r2 > Real(1e-24f) ? r2 : Real(1e-24f));
      const Real inv_r = std::min(Real(1) / r, Real(2) * e.inv_rest), strain = r * e.inv_rest - Real(1);
      const Real a = std::fabs(strain), am = a < e.law.cap ? a : e.law.cap;
      const Real shape = (am + am * am * (e.law.p1 + e.law.p2 * am)) + e.cap_slope * (a - am);  // [KCM99 eq.5]
      const Real rate = ((dv.x * d.x + dv.y * d.y) + dv.z * d.z) * inv_r;
      const Real q = (e.stiffness * std::copysign(shape, strain) + e.damping * rate) * inv_r;
      f.x = f.x + q * d.x, f.y = f.y + q * d.y, f.z = f.z + q * d.z;
    }
    return f;
  }
  int row_of(int node) const { return m_rows[node]; }

 private:
  struct Edge {
    int other = 0;
    Real inv_rest = 0, stiffness = 0, damping = 0;
    SpringLawT<Real> law;
    Real cap_slope = 1;
  };
  void add_edges(const NetworkDescription& d, const NetworkModel& m, bool source) {
    std::vector<std::vector<std::pair<int, int>>> near(m_edges.size());  // (row of the other end, spring)
    for (int s = 0; s < m.springs; ++s) {
      const int a = m.row_of_node[d.springs[s].a], b = m.row_of_node[d.springs[s].b];
      const int reached = int(m.packs[m.place[s] / kSlice].offset[m.place[s] % kSlice] / sizeof(NodeState));
      const int other = source ? reached : a + b - reached;
      near[a + b - other].emplace_back(other, s);
    }
    for (std::size_t row = 0; row < near.size(); ++row) {
      std::sort(near[row].begin(), near[row].end());
      for (const auto& [other, s] : near[row]) {
        const SpringDescription& e = d.springs[s];
        m_edges[row].push_back({other,
                                Real(1 / e.rest_length),
                                Real(e.k * e.rest_length),
                                Real(e.damping),
                                {Real(e.p1), Real(e.p2), Real(e.cap)},
                                Real(SpringLaw{e.p1, e.p2, e.cap}.cap_slope())});
      }
    }
  }
  static Real flushed(Real a) { return (a + Real(1e-15f)) - Real(1e-15f); }

  std::vector<Node> m_nodes, m_next;
  std::vector<std::vector<Edge>> m_edges;
  std::vector<int> m_rows;
  std::vector<double> m_masses;
  double m_gamma;
  Vec3d m_gravity;
};

}  // namespace trocar::tissue
