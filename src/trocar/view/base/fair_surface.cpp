#include <cmath>
#include <cstddef>
#include <numeric>

#include <trocar/view/base/fair_surface.hpp>

namespace trocar::view {
namespace {

using Values = std::vector<double>;
using Neighbours = std::vector<std::vector<int>>;

void bend(const Neighbours& net, const Values& z, Values& bent) {
  for (std::size_t i = 0; i < z.size(); ++i) {
    double sum = 0;
    for (const int j : net[i]) sum += z[std::size_t(j)];
    bent[i] = net[i].empty() ? 0 : sum / double(net[i].size()) - z[i];
  }
}

/// out = (L^T L + weight) z.
void apply(const Neighbours& net, std::span<const double> weight, const Values& z, Values& bent, Values& out) {
  bend(net, z, bent);
  for (std::size_t i = 0; i < z.size(); ++i) out[i] = weight[i] * z[i] - (net[i].empty() ? 0 : bent[i]);
  for (std::size_t i = 0; i < z.size(); ++i)
    for (const int j : net[i]) out[std::size_t(j)] += bent[i] / double(net[i].size());
}

double inner(const Values& a, const Values& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); }

}  // namespace

std::vector<double> fairest(const Neighbours& neighbours, std::span<const double> wished,
                            std::span<const double> weight, int passes) {
  const std::size_t n = wished.size();
  Values z(wished.begin(), wished.end()), bent(n), image(n), residual(n), scaled(n), way(n);
  apply(neighbours, weight, z, bent, image);
  for (std::size_t i = 0; i < n; ++i) residual[i] = weight[i] * wished[i] - image[i];
  const auto precondition = [&] {
    for (std::size_t i = 0; i < n; ++i) scaled[i] = residual[i] / (1.2 + weight[i]);
  };
  precondition();
  way = scaled;
  double before = inner(residual, scaled);
  const double enough = 1e-12 * before;
  for (int pass = 0; pass < passes && before > enough && before > 0; ++pass) {
    apply(neighbours, weight, way, bent, image);
    const double step = before / inner(way, image);
    for (std::size_t i = 0; i < n; ++i) z[i] += step * way[i], residual[i] -= step * image[i];
    precondition();
    const double now = inner(residual, scaled);
    for (std::size_t i = 0; i < n; ++i) way[i] = scaled[i] + (now / before) * way[i];
    before = now;
  }
  return z;
}

}  // namespace trocar::view
