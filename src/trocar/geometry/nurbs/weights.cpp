#include <algorithm>

#include <trocar/geometry/nurbs/basis.hpp>
#include <trocar/geometry/nurbs/weights.hpp>

namespace trocar::geometry::nurbs {

std::vector<Share> weights_at(const Surface& s, double u, double v) {
  const Basis2 bu = basis_at(s.u, u, 0), bv = basis_at(s.v, v, 0);
  std::vector<Share> row;
  double sum = 0.0;
  for (int l = 0; l <= s.v.degree; ++l)
    for (int k = 0; k <= s.u.degree; ++k) {
      const int i = s.index(s.u.point_of(bu.first + k), s.v.point_of(bv.first + l));
      row.push_back({i, bu.value[0][k] * bv.value[0][l] * s.weight(i)});
      sum += row.back().value;
    }
  if (!s.weights.empty())
    for (Share& share : row) share.value /= sum;
  return row;
}

std::vector<Share> node_weights_at(const Surface& s, const Nodes& nodes, double u, double v) {
  std::vector<Share> row = weights_at(s, u, v);
  for (Share& share : row) share.index = nodes.of_point[share.index];
  std::stable_sort(row.begin(), row.end(), [](const Share& a, const Share& b) { return a.index < b.index; });
  std::vector<Share> merged;
  for (const Share& share : row) {
    if (merged.empty() || merged.back().index != share.index)
      merged.push_back(share);
    else
      merged.back().value += share.value;
  }
  return merged;
}

Vec3d combined(std::span<const Share> row, std::span<const Vec3d> places) noexcept {
  Vec3d sum;
  for (const Share& share : row) sum += share.value * places[share.index];
  return sum;
}

WeightRows weight_rows(const Surface& s, const Nodes& nodes, std::span<const std::array<double, 2>> parameters) {
  WeightRows result;
  result.nodes.start.push_back(0);
  for (const auto& [u, v] : parameters) {
    for (const Share& share : node_weights_at(s, nodes, u, v))
      if (share.value != 0.0) {
        result.nodes.items.push_back(share.index);
        result.values.push_back(share.value);
      }
    result.nodes.start.push_back(static_cast<int>(result.nodes.items.size()));
  }
  return result;
}

}  // namespace trocar::geometry::nurbs
