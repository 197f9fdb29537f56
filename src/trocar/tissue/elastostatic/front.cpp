#include <algorithm>
#include <string>

#include <trocar/tissue/elastostatic/condense.hpp>
#include <trocar/tissue/elastostatic/dense_kernels.hpp>
#include <trocar/tissue/elastostatic/front.hpp>

namespace trocar::tissue {
namespace {

int to_packs(std::size_t unknowns) noexcept { return int((unknowns + kPack - 1) / kPack * kPack); }
std::size_t square_of(int n) noexcept { return std::size_t(n) * std::size_t(n); }

}  // namespace

FrontSize::FrontSize(const FrontNodes& nodes, int load_count)
    : pivots(to_packs(3 * nodes.own.size())),
      border(to_packs(3 * nodes.border.size())),
      loads(to_packs(std::size_t(load_count))) {}

/// A front's columns: packed what is eliminated, and the rest.
struct FrontSource::Matrix {
  PackedRows packed;
  int pivots;
  LowerMatrix rest;
  /// Element of the lower triangle.
  double& at(int i, int j) const noexcept { return j < pivots ? packed(i, j) : rest(i - pivots, j - pivots); }
};

FrontSource::FrontSource(const Stiffness& k, const Dissection& order, std::span<const double> loads)
    : m_k(k),
      m_order(order),
      m_forces(loads),
      m_loads(k.nodes() > 0 ? int(loads.size() / (3 * k.points.size())) : 0),
      m_first(k.points.size() + 1, 0),
      m_local(k.points.size(), 0) {
  const auto owner = [&](std::size_t e) {
    const int row = m_row_of[e], column = k.column[e];
    const int p = order.place[std::size_t(row)], q = order.place[std::size_t(column)];
    return p < 0 || q < 0 ? -1 : p < q ? row : column;
  };
  for (int row = 0; row < k.nodes(); ++row)
    m_row_of.insert(m_row_of.end(), std::size_t(k.first[std::size_t(row) + 1] - k.first[std::size_t(row)]), row);
  for (std::size_t e = 0; e < k.column.size(); ++e)
    if (owner(e) >= 0) ++m_first[std::size_t(owner(e)) + 1];
  for (std::size_t i = 1; i < m_first.size(); ++i) m_first[i] += m_first[i - 1];
  m_entry.resize(std::size_t(m_first.back()));
  std::vector<int> next = m_first;
  for (std::size_t e = 0; e < k.column.size(); ++e)
    if (owner(e) >= 0) m_entry[std::size_t(next[std::size_t(owner(e))]++)] = int(e);
}

double FrontSource::diagonal(int node, int axis) const {
  if (m_k.held[std::size_t(node)] >> axis & 1) return 1;
  return m_k.block[std::size_t(m_k.first[std::size_t(node) + 1] - 1)].m[axis][axis];
}

void FrontSource::give_places(const FrontNodes& nodes, const FrontSize& size) {
  for (std::size_t i = 0; i < nodes.own.size(); ++i) m_local[std::size_t(nodes.own[i])] = 3 * int(i);
  for (std::size_t i = 0; i < nodes.border.size(); ++i)
    m_local[std::size_t(nodes.border[i])] = size.pivots + 3 * int(i);
}

void FrontSource::add_entries(int node, const Matrix& to) const {
  for (int i = m_first[std::size_t(node)]; i < m_first[std::size_t(node) + 1]; ++i) {
    const std::size_t e = std::size_t(m_entry[std::size_t(i)]);
    const int row = m_row_of[e], column = m_k.column[e];
    const int r = m_local[std::size_t(row)], c = m_local[std::size_t(column)];
    for (int p = 0; p < 3; ++p)
      for (int q = 0; q < (row == column ? p + 1 : 3); ++q) {
        const bool held = (m_k.held[std::size_t(row)] >> p & 1) || (m_k.held[std::size_t(column)] >> q & 1);
        if (!held) to.at(std::max(r + p, c + q), std::min(r + p, c + q)) += m_k.block[e].m[p][q];
      }
  }
  const int own = m_local[std::size_t(node)];
  for (int axis = 0; axis < 3; ++axis)
    if (m_k.held[std::size_t(node)] >> axis & 1) to.at(own + axis, own + axis) = 1;
}

void FrontSource::add_loads(int node, const Matrix& to, const FrontSize& size) const {
  const std::size_t unknowns = 3 * m_k.points.size();
  for (int load = 0; load < m_loads; ++load)
    for (int axis = 0; axis < 3; ++axis)
      if (!(m_k.held[std::size_t(node)] >> axis & 1))
        to.at(size.pivots + size.border + load, m_local[std::size_t(node)] + axis) +=
            m_forces[std::size_t(load) * unknowns + std::size_t(3 * node + axis)];
}

void FrontSource::add_child(int child, const FrontSize& size, double* left, const Matrix& to) {
  const FrontSize own = this->size(child);
  const LowerMatrix from{left, own.rest()};
  const std::vector<int>& border = m_order.fronts[std::size_t(child)].border;
  m_to.clear();
  for (const int node : border)
    for (int axis = 0; axis < 3; ++axis) m_to.push_back(m_local[std::size_t(node)] + axis);
  const int unknowns = int(m_to.size());
  for (int load = 0; load < m_loads; ++load) m_to.push_back(size.pivots + size.border + load);
  const auto source_row = [&](int i) { return i < unknowns ? i : own.border + i - unknowns; };
  for (int j = 0; j < unknowns; ++j) {
    const double* const column = &from(0, j);
    const int c = m_to[std::size_t(j)];
    const int count = int(m_to.size());
    if (c < to.pivots) {
      for (int i = j; i < count; ++i) to.packed(m_to[std::size_t(i)], c) += column[source_row(i)];
      continue;
    }
    double* const target = &to.rest(0, c - to.pivots) - to.pivots;
    for (int i = j; i < unknowns; ++i) target[m_to[std::size_t(i)]] += column[i];
    for (int i = unknowns; i < count; ++i) target[m_to[std::size_t(i)]] += column[source_row(i)];
  }
}

void FrontSource::eliminate_front(int front, std::vector<AlignedNumbers>& left, core::ThreadPool* pool) {
  const FrontNodes& nodes = m_order.fronts[std::size_t(front)];
  const FrontSize size = this->size(front);
  AlignedNumbers packed;
  packed.assign(std::size_t(size.rows()) * std::size_t(size.pivots));
  AlignedNumbers& rest = left[std::size_t(front)];
  rest.assign(square_of(size.rest()));
  const Matrix matrix{{packed.data(), kPack * size.pivots}, size.pivots, {rest.data(), size.rest()}};
  give_places(nodes, size);
  for (const int node : nodes.own) add_entries(node, matrix), add_loads(node, matrix, size);
  if (front + 1 == int(m_order.fronts.size()))
    for (const int node : nodes.border) add_entries(node, matrix), add_loads(node, matrix, size);
  for (int i = 3 * int(nodes.own.size()); i < size.pivots; ++i) matrix.packed(i, i) = 1;
  for (const int child : nodes.children) {
    add_child(child, size, left[std::size_t(child)].data(), matrix);
    left[std::size_t(child)].free();
  }
  m_original.assign(std::size_t(size.pivots), 0.0);
  for (std::size_t i = 0; i < 3 * nodes.own.size(); ++i) m_original[i] = diagonal(nodes.own[i / 3], int(i % 3));
  const int failed = eliminate(matrix.packed, size.rows(), size.pivots, m_original.data(), matrix.rest, pool);
  if (failed >= 0) refuse_unheld(nodes.own[std::size_t(failed / 3)]);
}

double memory_of(const Dissection& order, int loads) {
  const auto left = [&](int front) {
    return double(square_of(FrontSize(order.fronts[std::size_t(front)], loads).rest()));
  };
  double most = 0, now = 0;
  for (int f = 0; f < int(order.fronts.size()); ++f) {
    const FrontSize size(order.fronts[std::size_t(f)], loads);
    now += left(f);
    most = std::max(most, now + double(size.rows()) * size.pivots);
    for (const int child : order.fronts[std::size_t(f)].children) now -= left(child);
  }
  const FrontSize root(order.fronts.back(), loads);  // its inversion, or the copy that is handed out
  const double width = std::min(kBlock, root.border), own = double(square_of(root.border));
  return 8 * std::max(most, now + std::max(own, width * (root.rest() + 2 * width)));
}

}  // namespace trocar::tissue
