// One impulse of the volume force as a plain loop over cells that adds to their corners: what every kernel must give,
// to the bit.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <trocar/tissue/network/volume_force.hpp>

namespace trocar::tissue::test {

struct CellNow {
  float volume6 = 0;
  Vec3f by[4];

  CellNow(std::span<const NodeState> nodes, const TetRest& t) noexcept {
    const auto at = [&](int i) {
      const NodeState& n = nodes[std::size_t(t.row[i])];
      return Vec3f{n.x, n.y, n.z};
    };
    const Vec3f a = at(1) - at(0), b = at(2) - at(0), c = at(3) - at(0);
    by[1] = cross(b, c), by[2] = cross(c, a), by[3] = cross(a, b);
    by[0] = -(by[1] + by[2] + by[3]);
    volume6 = dot(a, by[1]);
  }
};

/// @param weight  of the sub-step `weight_dt`
class VolumeReference {
 public:
  VolumeReference(std::span<const TetRest> cells, std::span<const std::uint8_t> phase, const Bulk& bulk,
                  std::span<const RowPack> weight, double weight_dt)
      : m_cells(cells), m_phase(phase), m_bulk(bulk), m_weight(weight), m_weight_dt(weight_dt) {}

  void push(double dt, std::span<NodeState> nodes) {
    sum_volumes(nodes);
    settle_pressures();
    m_force.assign(rows(), {});
    for (std::size_t t = 0; t < m_cells.size(); ++t)
      if (!gone(t)) push_corners(float(dt), nodes, m_cells[t]);
    const float times = float(dt / m_weight_dt);
    for (std::size_t row = 0; row < rows(); ++row) {
      const RowPack& w = m_weight[row / kSlice];
      NodeState& n = nodes[row];
      n.vx += times * w.wx[row % kSlice] * m_force[row].x;
      n.vy += times * w.wy[row % kSlice] * m_force[row].y;
      n.vz += times * w.wz[row % kSlice] * m_force[row].z;
    }
  }

 private:
  std::size_t rows() const { return m_weight.size() * kSlice; }
  bool gone(std::size_t cell) const { return !m_phase.empty() && m_phase[cell] == kGone; }
  float lightness(int row) const {
    const RowPack& w = m_weight[std::size_t(row) / kSlice];
    const int lane = row % kSlice;
    return std::max({w.wx[lane], w.wy[lane], w.wz[lane]}) / float(m_weight_dt);
  }

  void sum_volumes(std::span<const NodeState> nodes) {
    m_drawn.assign(rows(), 0), m_volume.assign(rows(), 0), m_answer.assign(rows(), 0);
    for (std::size_t t = 0; t < m_cells.size(); ++t) {
      const TetRest& c = m_cells[t];
      for (const int row : c.row) m_drawn[std::size_t(row)] += c.rest6 / 24;
      const CellNow cell(nodes, c);
      float answer = 0;
      for (int i = 0; i < 4; ++i) answer += lightness(c.row[i]) * dot(cell.by[i], cell.by[i]);
      for (const int row : c.row) {
        m_volume[std::size_t(row)] += (gone(t) ? c.rest6 : cell.volume6) / 24;
        m_answer[std::size_t(row)] += gone(t) ? 0 : answer;
      }
    }
  }

  void settle_pressures() {
    const float bound = 0.5f * m_bulk.most_answer;
    m_pressure.assign(rows(), 0);
    for (std::size_t row = 0; row < std::min(rows(), m_bulk.built.size()); ++row) {
      if (!(m_drawn[row] > 0.75f * m_bulk.built[row])) continue;
      const float j = std::min(std::max(m_volume[row] / m_drawn[row], 0.5f), 2.0f);
      const float gives = m_answer[row] / m_drawn[row];
      const float soft = gives > bound && bound > 0 ? bound / gives : 1;
      m_pressure[row] = soft * float(m_bulk.kappa) * (j - 1);
    }
  }

  void push_corners(float dt, std::span<const NodeState> nodes, const TetRest& c) {
    const CellNow cell(nodes, c);
    const auto p = [&](int i) { return m_pressure[std::size_t(c.row[i])]; };
    const float ratio = cell.volume6 / c.rest6;
    const float share =
        std::max(std::min({(ratio - 0.2f) / (0.5f - 0.2f), (4.0f - ratio) / (4.0f - 2.0f), 1.0f}), 0.0f);
    float most2 = 0;
    for (int i = 0; i < 4; ++i) {
      const float w = lightness(c.row[i]);
      most2 = std::max(most2, w * w * dot(cell.by[i], cell.by[i]));
    }
    float push = -(share * ((p(0) + p(1)) + (p(2) + p(3)))) / 24;
    const float speed = std::fabs(push) * (dt * std::sqrt(most2));
    if (speed > 0.5f) push = push * (0.5f / speed);
    for (int i = 0; i < 4; ++i) m_force[std::size_t(c.row[i])] += push * cell.by[i];
  }

  std::span<const TetRest> m_cells;
  std::span<const std::uint8_t> m_phase;
  const Bulk& m_bulk;
  std::span<const RowPack> m_weight;
  double m_weight_dt;
  std::vector<float> m_drawn, m_volume, m_answer, m_pressure;
  std::vector<Vec3f> m_force;
};

}  // namespace trocar::tissue::test
