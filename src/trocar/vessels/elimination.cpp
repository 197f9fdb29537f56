#include <algorithm>
#include <set>
#include <stdexcept>
#include <tuple>

#include <trocar/vessels/elimination.hpp>

namespace trocar::vessels {
namespace {

using Neighbours = std::vector<std::vector<int>>;  // of each node, ascending

void insert_once(std::vector<int>& sorted, int value) {
  const auto at = std::lower_bound(sorted.begin(), sorted.end(), value);
  if (at == sorted.end() || *at != value) sorted.insert(at, value);
}

void erase_one(std::vector<int>& sorted, int value) {
  sorted.erase(std::lower_bound(sorted.begin(), sorted.end(), value));
}

/// Eliminates node by node; `neighbours` become those that were left when their node's turn came. @return the order
std::vector<int> minimum_degree(Neighbours& neighbours, std::size_t max_entries) {
  const int n = int(neighbours.size());
  std::vector<int> round(std::size_t(n), 0), order;
  using Key = std::tuple<int, int, int>;  // degree (0 and 1 alike), round, node
  const auto key = [&](int i) { return Key(std::max(1, int(neighbours[i].size())), round[i], i); };
  std::set<Key> queue;
  for (int i = 0; i < n; ++i) queue.insert(key(i));
  std::size_t entries = 0;
  while (!queue.empty()) {
    const int i = std::get<2>(*queue.begin());
    queue.erase(queue.begin());
    order.push_back(i);
    entries += neighbours[i].size();
    if (entries > max_entries) throw std::length_error("vessels: the graph has too many anastomoses to be solved");
    for (const int j : neighbours[i]) queue.erase(key(j));
    for (const int j : neighbours[i]) {
      erase_one(neighbours[j], i);
      for (const int k : neighbours[i])
        if (k != j) insert_once(neighbours[j], k);
      round[j] = std::max(round[j], round[i] + 1);
    }
    for (const int j : neighbours[i]) queue.insert(key(j));
  }
  return order;
}

/// The entry of rows i < j.
int entry(const Elimination& e, int i, int j) {
  const auto first = e.later.begin() + e.start[i], last = e.later.begin() + e.start[i + 1];
  return int(std::lower_bound(first, last, j) - e.later.begin());
}

/// Where A(i, j) stands.
int place(const Elimination& e, int i, int j) { return i < j ? 2 * entry(e, i, j) : 2 * entry(e, j, i) + 1; }

}  // namespace

Elimination plan_elimination(int nodes, std::span<const std::pair<int, int>> links, std::size_t max_entries) {
  Neighbours neighbours(static_cast<std::size_t>(nodes));
  for (const auto& [a, b] : links) insert_once(neighbours[a], b), insert_once(neighbours[b], a);
  const std::vector<int> order = minimum_degree(neighbours, max_entries);
  Elimination e;
  e.rows = nodes;
  e.row_of.resize(std::size_t(nodes));
  for (int i = 0; i < nodes; ++i) e.row_of[order[i]] = i;
  e.start.push_back(0);
  for (const int node : order) {
    std::vector<int> rows;
    for (const int other : neighbours[node]) rows.push_back(e.row_of[other]);
    std::sort(rows.begin(), rows.end());
    e.later.insert(e.later.end(), rows.begin(), rows.end());
    e.start.push_back(int(e.later.size()));
  }
  for (int i = 0; i < nodes; ++i)
    if (e.start[i + 1] - e.start[i] > 1)
      for (int x = e.start[i]; x < e.start[i + 1]; ++x)
        for (int y = e.start[i]; y < e.start[i + 1]; ++y)
          if (x != y) e.fill.push_back(place(e, e.later[x], e.later[y]));
  for (const auto& [a, b] : links) e.entry_of_link.push_back(place(e, e.row_of[a], e.row_of[b]));
  return e;
}

int eliminate(const Elimination& e, std::span<double> diagonal, std::span<double> values,
              std::span<double> rhs) noexcept {
  const int *start = e.start.data(), *later = e.later.data(), *fill = e.fill.data();
  double *d = diagonal.data(), *v = values.data(), *b = rhs.data();
  for (int i = 0; i < e.rows; ++i) {
    if (!(d[i] > 0)) return i;
    const double inverse = d[i] = 1 / d[i];
    const int first = start[i], last = start[i + 1];
    for (int x = first; x < last; ++x) {
      const double factor = v[2 * x + 1] * inverse;
      d[later[x]] -= factor * v[2 * x];
      b[later[x]] -= factor * b[i];
      if (last - first == 1) continue;
      for (int y = first; y < last; ++y)
        if (y != x) v[*fill++] -= factor * v[2 * y];
    }
  }
  for (int i = e.rows - 1; i >= 0; --i) {
    double sum = b[i];
    for (int k = start[i]; k < start[i + 1]; ++k) sum -= v[2 * k] * b[later[k]];
    b[i] = sum * d[i];
  }
  return -1;
}

}  // namespace trocar::vessels
