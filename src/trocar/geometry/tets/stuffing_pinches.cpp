#include <algorithm>
#include <cmath>
#include <span>

#include <trocar/geometry/tets/stuffing_pinches.hpp>

namespace trocar::geometry {
namespace {

using Cells = std::vector<std::array<int, 4>>;

/// A cell at an edge (from the lower node to the higher), or at a node (twice the same).
struct At {
  int a, b, cell;
  friend bool operator<(const At& x, const At& y) {
    if (x.a != y.a) return x.a < y.a;
    if (x.b != y.b) return x.b < y.b;
    return x.cell < y.cell;
  }
};

std::vector<At> cells_at_places(const Cells& cells, const std::vector<bool>& on_surface) {
  std::vector<At> out;
  for (int c = 0; c < int(cells.size()); ++c)
    for (int i = 0; i < 4; ++i)
      for (int j = i; j < 4; ++j) {
        const int a = cells[c][i], b = cells[c][j];
        if (on_surface[a] && on_surface[b]) out.push_back({std::min(a, b), std::max(a, b), c});
      }
  std::sort(out.begin(), out.end());
  return out;
}

bool share_a_face(const std::array<int, 4>& x, const std::array<int, 4>& y) {
  int shared = 0;
  for (const int node : x) shared += std::find(y.begin(), y.end(), node) != y.end();
  return shared >= 3;
}

double size_of(const std::vector<Vec3d>& points, const std::array<int, 4>& cell) {
  const Vec3d p = points[cell[0]];
  return std::fabs(dot(points[cell[1]] - p, cross(points[cell[2]] - p, points[cell[3]] - p)));
}

/// Which group each of these cells is in: those that hang together by faces, numbered by their first cell.
std::vector<int> groups_of(std::span<const At> here, const Cells& cells) {
  std::vector<int> group(here.size(), -1), waiting;
  int groups = 0;
  for (std::size_t start = 0; start < here.size(); ++start) {
    if (group[start] >= 0) continue;
    group[start] = groups;
    waiting.assign(1, int(start));
    while (!waiting.empty()) {
      const int k = waiting.back();
      waiting.pop_back();
      for (std::size_t other = 0; other < here.size(); ++other) {
        if (group[other] >= 0 || !share_a_face(cells[here[k].cell], cells[here[other].cell])) continue;
        group[other] = groups;
        waiting.push_back(int(other));
      }
    }
    ++groups;
  }
  return group;
}

void mark_all_but_the_largest(std::span<const At> here, const std::vector<Vec3d>& points, const Cells& cells,
                              std::vector<bool>& left_out) {
  const std::vector<int> group = groups_of(here, cells);
  const int groups = *std::max_element(group.begin(), group.end()) + 1;
  if (groups == 1) return;
  std::vector<double> size(groups, 0.0);
  for (std::size_t k = 0; k < here.size(); ++k) size[group[k]] += size_of(points, cells[here[k].cell]);
  const int largest = int(std::max_element(size.begin(), size.end()) - size.begin());
  for (std::size_t k = 0; k < here.size(); ++k)
    if (group[k] != largest) left_out[here[k].cell] = true;
}

}  // namespace

void leave_out_pinches(const std::vector<Vec3d>& points, std::vector<bool> on_surface,
                       std::vector<std::array<int, 4>>& cells) {
  for (bool again = true; again;) {
    std::vector<bool> left_out(cells.size(), false);
    const std::vector<At> all = cells_at_places(cells, on_surface);
    for (std::size_t first = 0, last = 0; first < all.size(); first = last) {
      while (last < all.size() && all[last].a == all[first].a && all[last].b == all[first].b) ++last;
      mark_all_but_the_largest(std::span(all.data() + first, last - first), points, cells, left_out);
    }
    Cells kept;
    for (int c = 0; c < int(cells.size()); ++c) {
      if (!left_out[c]) kept.push_back(cells[c]);
      if (left_out[c])
        for (const int node : cells[c]) on_surface[node] = true;  // what was inside may have come out
    }
    again = kept.size() < cells.size();
    cells = std::move(kept);
  }
}

}  // namespace trocar::geometry
