#include <algorithm>
#include <cmath>
#include <map>

#include <trocar/training/observe/folds.hpp>

namespace trocar::training {

bool FoldColumns::there(const sim::Model& model, BodyId body) {
  if (!body.is(BodyKind::membrane)) return false;
  const sim::MembraneBody& fold = model.membranes[body.index()];
  return fold.strand >= 0 && !fold.sheet.closed();
}

FoldColumns::FoldColumns(const sim::Model& model, int membrane)
    : m_membrane(membrane), m_rows(model.membranes[size_t(membrane)].sheet.rows) {
  const sim::MembraneBody& fold = model.membranes[size_t(membrane)];
  const tissue::NetworkModel& network = fold.sheet.network;
  const int columns = fold.sheet.columns;
  std::map<std::pair<int, int>, int> springs;
  for (int s = 0; s < network.springs; ++s) {
    const int a = network.spring_nodes[size_t(2 * s)], b = network.spring_nodes[size_t(2 * s) + 1];
    springs[{std::min(a, b), std::max(a, b)}] = s;
  }
  for (int c = 0; c < columns; ++c) {
    m_s.push_back(fold.from + (fold.to - fold.from) * c / std::max(1, columns - 1));
    for (int r = 0; r + 1 < m_rows; ++r) {
      const auto found = springs.find({r * columns + c, (r + 1) * columns + c});
      m_springs.push_back(found == springs.end() ? -1 : found->second);
    }
  }
}

bool FoldColumns::whole(const sim::Model& model, const sim::State& state, int column) const {
  const tissue::NetworkModel& network = model.membranes[size_t(m_membrane)].sheet.network;
  const tissue::NetworkState& now = state.membranes[size_t(m_membrane)].network;
  const auto first = m_springs.begin() + column * (m_rows - 1);
  return std::all_of(first, first + (m_rows - 1),
                     [&](int spring) { return spring < 0 || tissue::spring_scale(network, now, spring) > 0; });
}

Vec3d FoldColumns::point(const sim::Model& model, const sim::State& state, int column, double away) const {
  const sim::MembraneBody& fold = model.membranes[size_t(m_membrane)];
  const tissue::NetworkState& now = state.membranes[size_t(m_membrane)].network;
  const auto node = [&](int row) { return row * fold.sheet.columns + column; };
  const auto deep = [&](int row) { return double(fold.depth[size_t(node(row))]); };
  const auto at = [&](int row) { return tissue::position(fold.sheet.network, now, node(row)); };
  int row = 0;
  while (row + 2 < m_rows && deep(row + 1) < away) ++row;
  const double step = deep(row + 1) - deep(row);
  const double w = step > 1e-9 ? std::clamp((away - deep(row)) / step, 0.0, 1.0) : 0.5;
  return at(row) + w * (at(row + 1) - at(row));
}

double FoldColumns::whole_between(const sim::Model& model, const sim::State& state, double from, double to) const {
  double sum = 0;
  const double half = count() > 1 ? 0.5 * std::fabs(s(1) - s(0)) : 0;
  for (int c = 0; c < count(); ++c) {
    const double begins = c == 0 ? s(c) : s(c) - half, ends = c + 1 == count() ? s(c) : s(c) + half;
    const double width = std::min(to, ends) - std::max(from, begins);
    if (width > 0 && s(c) >= from && s(c) <= to && whole(model, state, c)) sum += width;
  }
  return sum;
}

}  // namespace trocar::training
