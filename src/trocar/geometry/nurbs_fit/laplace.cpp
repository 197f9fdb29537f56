#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <trocar/geometry/nurbs_fit/laplace.hpp>
#include <trocar/numerics/conjugate_gradient.hpp>

namespace trocar::geometry::nurbs {
namespace {

// Of the angle at corner a.
double cotangent(Vec3d a, Vec3d b, Vec3d c) {
  const Vec3d x = b - a, y = c - a;
  const double sine = length(cross(x, y));
  return sine > 0.0 ? dot(x, y) / sine : 0.0;
}

void add_weight(EdgeWeights& w, int from, int to, double value) {
  const int* const begin = w.neighbours.items.data();
  const int* const at = std::lower_bound(begin + w.neighbours.start[from], begin + w.neighbours.start[from + 1], to);
  w.weight[static_cast<std::size_t>(at - begin)] += value;
}

}  // namespace

EdgeWeights cotangent_weights(const TriMesh& mesh) {
  EdgeWeights w{vertex_neighbours(mesh), {}};
  w.weight.assign(w.neighbours.items.size(), 0.0);
  const auto& p = mesh.positions;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
      const double half = 0.5 * cotangent(p[a], p[b], p[c]);
      add_weight(w, b, c, half);
      add_weight(w, c, b, half);
    }
  for (double& value : w.weight) value = std::max(value, kLeastWeight);
  return w;
}

void relax(const EdgeWeights& w, const std::vector<std::uint8_t>& held, std::vector<double>& value,
           const std::vector<double>& step) {
  const int n = w.neighbours.rows();
  std::vector<double> diagonal(static_cast<std::size_t>(n), 1.0), b(static_cast<std::size_t>(n), 0.0), x = value;
  for (int i = 0; i < n; ++i) {
    if (held[i]) {
      x[i] = 0.0;
      continue;
    }
    double sum = 0.0;
    for (int k = w.neighbours.start[i]; k < w.neighbours.start[i + 1]; ++k) {
      const int j = w.neighbours.items[k];
      sum += w.weight[k];
      if (held[j]) b[i] += w.weight[k] * value[j];
      if (!step.empty()) b[i] += w.weight[k] * step[k];
    }
    if (sum > 0.0) diagonal[i] = sum;
  }
  const auto apply = [&](const double* in, double* out) {
    for (int i = 0; i < n; ++i) {
      out[i] = diagonal[i] * in[i];
      if (held[i]) continue;
      for (int k = w.neighbours.start[i]; k < w.neighbours.start[i + 1]; ++k)
        if (!held[w.neighbours.items[k]]) out[i] -= w.weight[k] * in[w.neighbours.items[k]];
    }
  };
  numerics::ConjugateGradientWork work(n);
  const auto done = numerics::conjugate_gradient(apply, numerics::DiagonalPreconditioner{diagonal.data()}, b.data(),
                                                 x.data(), n, {20 * n + 1000, 1e-12}, work);
  if (done.not_positive || !(done.relative_residual < 1e-6))
    throw std::runtime_error("relax: the equations of the mesh cannot be solved");
  for (int i = 0; i < n; ++i)
    if (!held[i]) value[i] = x[i];
}

}  // namespace trocar::geometry::nurbs
