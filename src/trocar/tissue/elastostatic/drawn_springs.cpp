#include <algorithm>

#include <trocar/tissue/base/law.hpp>
#include <trocar/tissue/elastostatic/drawn_springs.hpp>

namespace trocar::tissue {
namespace {

SpringLaw law_of_place(const NetworkModel& m, int place) {
  if (m.law_packs.empty()) return {double(m.p1), double(m.p2), double(m.cap)};
  const LawPack& l = m.law_packs[std::size_t(place / kSlice)];
  const int lane = place % kSlice;
  return {double(l.p1[lane]), double(l.p2[lane]), double(l.cap[lane])};
}

/// Of k l^2 that cells bring to a spring.
SpringDescription brought(const CuttableModel& m, int a, int b, double k_l2, double ratio) {
  const double l = length(m.drawn.rest[std::size_t(b)] - m.drawn.rest[std::size_t(a)]);
  return {.a = a,
          .b = b,
          .rest_length = ratio * l,
          .k = k_l2 / (l * l),
          .p1 = double(m.p1),
          .p2 = double(m.p2),
          .cap = double(m.cap)};
}

}  // namespace

std::vector<SpringDescription> drawn_springs(const NetworkModel& m) {
  std::vector<SpringDescription> out;
  for (int i = 0; i < m.springs; ++i) {
    const SpringLaw law = law_of_place(m, m.place[std::size_t(i)]);
    out.push_back({.a = m.spring_nodes[std::size_t(2 * i)],
                   .b = m.spring_nodes[std::size_t(2 * i) + 1],
                   .rest_length = double(m.spring_rest[std::size_t(i)]),
                   .k = spring_stiffness(m, i),
                   .p1 = law.p1,
                   .p2 = law.p2,
                   .cap = law.cap});
  }
  return out;
}

std::vector<SpringDescription> drawn_springs(const CuttableModel& m) {
  std::vector<SpringDescription> out;
  const geometry::CuttableTets& t = m.drawn;
  for (std::size_t c = 0; c < t.cells.size(); ++c) {
    const CellSprings& brings = m.brings[c];
    for (int e = 0; e < 6; ++e)  // what the cells around an edge bring, side by side
      out.push_back(brought(m, t.cells[c][std::size_t(kCellEdges[e][0])], t.cells[c][std::size_t(kCellEdges[e][1])],
                            double(brings.edge[e]), double(brings.edge_ratio[e])));
    for (std::size_t own = 0; own < 4; ++own) {
      const std::int32_t beyond = t.across[c][own];
      if (beyond < 0 || std::size_t(beyond) < c) continue;
      const geometry::Tet& back = t.across[std::size_t(beyond)];
      const auto far = std::size_t(std::find(back.begin(), back.end(), std::int32_t(c)) - back.begin());
      const double both = double(brings.cross[own]) + double(m.brings[std::size_t(beyond)].cross[far]);
      if (both > 0)
        out.push_back(
            brought(m, t.cells[c][own], t.cells[std::size_t(beyond)][far], both, double(brings.cross_ratio[own])));
    }
  }
  return out;
}

std::vector<double> drawn_masses(const CuttableModel& m) {
  std::vector<double> mass(std::size_t(m.own_nodes), 0.0);
  for (const geometry::Tet& cell : m.drawn.cells) {
    const auto x = [&](std::size_t k) { return m.drawn.rest[std::size_t(cell[k])]; };
    const double quarter = m.density / 24 * dot(x(1) - x(0), cross(x(2) - x(0), x(3) - x(0)));
    for (const std::int32_t node : cell) mass[std::size_t(node)] += quarter;
  }
  return mass;
}

std::vector<std::array<int, 4>> drawn_cells(const NetworkModel& m) {
  std::vector<std::array<int, 4>> out;
  for (const TetRest& t : m.tets) {
    const auto node = [&](int k) { return m.node_of_row[std::size_t(t.row[k])]; };
    out.push_back({node(0), node(1), node(2), node(3)});
  }
  return out;
}

std::vector<std::array<int, 4>> drawn_cells(const CuttableModel& m) {
  std::vector<std::array<int, 4>> out;
  for (const geometry::Tet& t : m.drawn.cells) out.push_back({t[0], t[1], t[2], t[3]});
  return out;
}

}  // namespace trocar::tissue
