#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <trocar/tissue/base/law.hpp>
#include <trocar/tissue/elastostatic/stiffness.hpp>

namespace trocar::tissue {
namespace {

/// n n^T (along - across) + across I
Mat3d stiffness_along(Vec3d n, double along, double across) {
  return outer((along - across) * n, n) + across * Mat3d::identity();
}

Mat3d without_axes(Mat3d block, std::uint8_t row_held, std::uint8_t column_held) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if ((row_held >> i & 1) || (column_held >> j & 1)) block.m[i][j] = 0;
  return block;
}

void add_product(const Mat3d& block, const double* x, double* y) noexcept {
  const Vec3d q = block * Vec3d{x[0], x[1], x[2]};
  y[0] += q.x, y[1] += q.y, y[2] += q.z;
}

}  // namespace

StiffnessBuilder::StiffnessBuilder(std::span<const Vec3d> points, std::span<const std::uint8_t> held)
    : m_points(points.begin(), points.end()), m_held(held.begin(), held.end()) {
  if (held.empty()) m_held.assign(points.size(), kFree);
  if (m_held.size() != m_points.size()) throw std::invalid_argument("held axes of other than all nodes");
}

void StiffnessBuilder::add(int row, int column, const Mat3d& block) {
  const int n = int(m_points.size());
  if (row < 0 || row >= n || column < 0 || column >= n) throw std::invalid_argument("no such node");
  if (row < column) return m_entries.push_back({column, row, transposed(block)});
  m_entries.push_back({row, column, block});
}

void StiffnessBuilder::add_springs(std::span<const SpringDescription> springs) {
  for (const SpringDescription& e : springs) {
    const Vec3d d = m_points.at(std::size_t(e.b)) - m_points.at(std::size_t(e.a));
    const double r = length(d), strain = r / e.rest_length - 1;
    const SpringLaw law{e.p1, e.p2, e.cap};
    const double tension = e.k * e.rest_length * law.shape(strain);  // [KCM99 eq.5]
    const Mat3d block = stiffness_along(d / r, e.k * law.slope(strain), tension / r);
    add(e.a, e.a, block), add(e.b, e.b, block);
    add(e.a, e.b, -1.0 * block);
  }
}

void StiffnessBuilder::add_anchors(std::span<const Anchor> anchors) {
  for (const Anchor& a : anchors) add(a.node, a.node, a.k * Mat3d::identity());
}

void StiffnessBuilder::add_volume(std::span<const std::array<int, 4>> cells, double kappa) {
  if (!(kappa > 0)) return;
  std::vector<std::vector<std::size_t>> around(m_points.size());
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (const int node : cells[c]) around.at(std::size_t(node)).push_back(c);
  std::vector<Vec3d> change(m_points.size());  // g_a, of the nodes near
  std::vector<int> near;
  for (const auto& own : around) {
    near.clear();
    double volume = 0;
    for (const std::size_t c : own) {
      const auto x = [&](int i) { return m_points[std::size_t(cells[c][std::size_t(i)])]; };
      const Vec3d a = x(1) - x(0), b = x(2) - x(0), o = x(3) - x(0);
      const Vec3d by[3] = {cross(b, o), cross(o, a), cross(a, b)};  // six times dV/dx
      volume += dot(a, by[0]) / 24;
      near.insert(near.end(), cells[c].begin(), cells[c].end());
      change[std::size_t(cells[c][0])] -= (by[0] + by[1] + by[2]) / 24;
      for (std::size_t i = 0; i < 3; ++i) change[std::size_t(cells[c][i + 1])] += by[i] / 24;
    }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    for (std::size_t i = 0; i < near.size(); ++i)
      for (std::size_t j = 0; j <= i; ++j)
        add(near[i], near[j], outer((kappa / volume) * change[std::size_t(near[i])], change[std::size_t(near[j])]));
    for (const int node : near) change[std::size_t(node)] = {};
  }
}

Stiffness StiffnessBuilder::build() const {
  Stiffness k{m_points, m_held, {0}, {}, {}};
  std::vector<int> count(m_points.size() + 1, 0);  // entries by rows, in the order in which they came
  for (const Entry& e : m_entries) ++count[std::size_t(e.row) + 1];
  for (std::size_t i = 1; i < count.size(); ++i) count[i] += count[i - 1];
  std::vector<std::size_t> order(m_entries.size());
  std::vector<int> at(count.begin(), count.end() - 1);
  for (std::size_t i = 0; i < m_entries.size(); ++i) order[std::size_t(at[std::size_t(m_entries[i].row)]++)] = i;
  for (int row = 0; row < k.nodes(); ++row) {
    const auto begin = order.begin() + count[std::size_t(row)], end = order.begin() + count[std::size_t(row) + 1];
    std::sort(begin, end, [&](std::size_t a, std::size_t b) {
      const int p = m_entries[a].column, q = m_entries[b].column;
      return p != q ? p < q : a < b;
    });
    const std::size_t first = k.column.size();
    for (auto i = begin; i != end; ++i) {
      const Entry& e = m_entries[*i];
      if (k.column.size() == first || k.column.back() != e.column) k.column.push_back(e.column), k.block.push_back({});
      k.block.back() = k.block.back() + e.block;
    }
    if (k.column.size() == first || k.column.back() != row) k.column.push_back(row), k.block.push_back({});
    k.first.push_back(int(k.column.size()));
  }
  return k;
}

void multiply(const Stiffness& k, const double* x, double* y) noexcept {
  for (int i = 0; i < 3 * k.nodes(); ++i) y[i] = 0;
  for (int row = 0; row < k.nodes(); ++row)
    for (int e = k.first[std::size_t(row)]; e < k.first[std::size_t(row) + 1]; ++e) {
      const int column = k.column[std::size_t(e)];
      const Mat3d block = without_axes(k.block[std::size_t(e)], k.held[std::size_t(row)], k.held[std::size_t(column)]);
      add_product(block, x + 3 * column, y + 3 * row);
      if (column != row) add_product(transposed(block), x + 3 * row, y + 3 * column);
    }
}

}  // namespace trocar::tissue
