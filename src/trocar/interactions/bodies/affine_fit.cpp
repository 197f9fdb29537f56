#include <algorithm>
#include <cmath>

#include <trocar/interactions/bodies/affine_fit.hpp>

namespace trocar::interactions {
namespace {

/// What a weighted fit of an affine function to the nodes about a place is made of.
struct Fit {
  double a[4][4] = {}, g[kRowNodes] = {};
  Vec3d d[kRowNodes];

  Fit(std::span<const Vec3d> at, Vec3d p) noexcept {
    double farthest = 0, total = 0;
    for (const Vec3d& x : at) farthest = std::max(farthest, dot(x - p, x - p));
    const double scale = std::max(1e-4, std::sqrt(farthest));
    for (std::size_t i = 0; i < at.size(); ++i) {
      d[i] = (at[i] - p) / scale;
      g[i] = 1 / (dot(d[i], d[i]) + 0.05);
      total += g[i];
    }
    for (std::size_t i = 0; i < at.size(); ++i) {
      g[i] /= total;
      const double basis[4] = {1, d[i].x, d[i].y, d[i].z};
      for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c) a[r][c] += g[i] * basis[r] * basis[c];
    }
  }

  /// w_i = g_i (z0 + z . d_i) with sum w = 1 and sum w d = 0; a ridge leaves out what nodes do not tell, as across the
  /// plane that they lie in. @return sum |w|
  double weights(double ridge, std::span<float> w) const noexcept {
    double m[4][5] = {};
    for (int r = 0; r < 4; ++r)
      for (int c = 0; c < 4; ++c) m[r][c] = a[r][c];
    for (int r = 1; r < 4; ++r) m[r][r] += ridge;
    m[0][4] = 1;
    for (int c = 0; c < 4; ++c)  // positive definite: no pivoting
      for (int r = 0; r < 4; ++r) {
        if (r == c) continue;
        const double f = m[r][c] / m[c][c];
        for (int k = c; k < 5; ++k) m[r][k] -= f * m[c][k];
      }
    const double z0 = m[0][4] / m[0][0];
    const Vec3d z{m[1][4] / m[1][1], m[2][4] / m[2][2], m[3][4] / m[3][3]};
    double sum = 0;
    for (std::size_t i = 0; i < w.size(); ++i) {
      w[i] = float(g[i] * (z0 + dot(z, d[i])));
      sum += std::fabs(double(w[i]));
    }
    return sum;
  }
};

}  // namespace

void NearNodes::offer(std::int32_t n, double d2) noexcept {
  if (count == kRowNodes && d2 >= square[kRowNodes - 1]) return;
  int at = count < kRowNodes ? count++ : kRowNodes - 1;
  for (; at > 0 && square[std::size_t(at - 1)] > d2; --at) {
    square[std::size_t(at)] = square[std::size_t(at - 1)];
    node[std::size_t(at)] = node[std::size_t(at - 1)];
  }
  square[std::size_t(at)] = d2;
  node[std::size_t(at)] = n;
}

bool fit_affine(std::span<const Vec3d> at, Vec3d place, std::span<float> weight) noexcept {
  constexpr double kMostWeights = 8;  // sum |w|. Our choice: 1 inside of the nodes, up to 6 seen beside them
  if (at.empty()) return false;
  const Fit fit(at, place);
  double ridge = 1e-6;
  while (!(fit.weights(ridge, weight) <= kMostWeights) && ridge < 1) ridge *= 10;
  double sum = 0;
  for (const float w : weight) sum += double(w);
  return std::fabs(sum - 1) < 0.01;
}

}  // namespace trocar::interactions
