#include <cmath>
#include <vector>

#include <trocar/numerics/conjugate_gradient.hpp>
#include <trocar/tissue/base/law.hpp>
#include <trocar/tissue/network/prestress.hpp>

namespace trocar::tissue {
namespace {

/// The linear network on its free axes: y = K x, with the springs' drawn directions.
struct LinearNetwork {
  const NetworkDescription& d;
  std::span<const Anchor> anchors;
  std::vector<Vec3d> direction;  // per spring, a to b

  LinearNetwork(const NetworkDescription& description, std::span<const Anchor> held) : d(description), anchors(held) {
    for (const auto& e : d.springs) direction.push_back(normalised(d.positions[e.b] - d.positions[e.a]));
  }
  bool is_held(int node, int axis) const { return !d.fixed.empty() && (d.fixed[node] & (1 << axis)); }
  /// k n . (u_b - u_a): the tension that displacements u put into a spring [N].
  double tension(std::size_t s, const double* u) const {
    const auto& e = d.springs[s];
    const Vec3d n = direction[s];
    const double* a = u + 3 * e.a;
    const double* b = u + 3 * e.b;
    return e.k * (n.x * (b[0] - a[0]) + n.y * (b[1] - a[1]) + n.z * (b[2] - a[2]));
  }
  void multiply(const double* x, double* y) const {
    const int n = int(d.positions.size());
    for (int i = 0; i < 3 * n; ++i) y[i] = 0;
    for (std::size_t s = 0; s < d.springs.size(); ++s) {
      const auto& e = d.springs[s];
      const Vec3d f = tension(s, x) * direction[s];
      for (int axis = 0; axis < 3; ++axis) y[3 * e.a + axis] -= f[axis], y[3 * e.b + axis] += f[axis];
    }
    for (const Anchor& a : anchors)
      for (int axis = 0; axis < 3; ++axis) y[3 * a.node + axis] += a.k * x[3 * a.node + axis];
    for (int i = 0; i < n; ++i)
      for (int axis = 0; axis < 3; ++axis)
        if (is_held(i, axis)) y[3 * i + axis] = x[3 * i + axis];
  }
  /// Diagonal of K; 1 on held axes, and where nothing acts.
  std::vector<double> diagonal() const {
    std::vector<double> k(3 * d.positions.size(), 0.0);
    for (std::size_t s = 0; s < d.springs.size(); ++s) {
      const auto& e = d.springs[s];
      for (int axis = 0; axis < 3; ++axis) {
        const double q = e.k * direction[s][axis] * direction[s][axis];
        k[3 * e.a + axis] += q, k[3 * e.b + axis] += q;
      }
    }
    for (const Anchor& a : anchors)
      for (int axis = 0; axis < 3; ++axis) k[3 * a.node + axis] += a.k;
    for (std::size_t i = 0; i < k.size(); ++i)
      if (is_held(int(i / 3), int(i % 3)) || !(k[i] > 0)) k[i] = 1;
    return k;
  }
};

}  // namespace

double largest_imbalance(const NetworkDescription& d, std::span<const Anchor> anchors) {
  std::vector<Vec3d> f(d.positions.size());
  for (std::size_t i = 0; i < f.size(); ++i) f[i] = d.mass[i] * d.gravity;
  for (const auto& e : d.springs) {
    const Vec3d r = d.positions[e.b] - d.positions[e.a];
    const double now = length(r);
    const SpringLaw law{e.p1, e.p2, e.cap};
    const Vec3d s = (e.k * e.rest_length * law.shape(now / e.rest_length - 1) / now) * r;  // [KCM99 eq.2]
    f[e.a] += s, f[e.b] -= s;
  }
  for (const Anchor& a : anchors) f[a.node] += a.k * (a.x0 - d.positions[a.node]);
  double worst = 0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      if (!d.fixed.empty() && (d.fixed[i] & (1 << axis))) continue;
      const double size = std::fabs(f[i][axis]);
      worst = worst > size ? worst : size;
    }
  }
  return worst;
}

constexpr int kMostIterations = 20'000;  // a body that is barely held asks for millions

PrestressReport prestress(NetworkDescription& d, std::span<Anchor> anchors) {
  const int n = 3 * int(d.positions.size());
  const LinearNetwork network(d, anchors);
  std::vector<double> f(n, 0.0), u(n, 0.0);
  for (int i = 0; i < n; ++i)
    if (!network.is_held(i / 3, i % 3)) f[i] = d.mass[i / 3] * d.gravity[i % 3];
  const std::vector<double> diagonal = network.diagonal();
  numerics::ConjugateGradientWork work(n);
  const auto solved = numerics::conjugate_gradient(
      [&](const double* x, double* y) { network.multiply(x, y); }, numerics::DiagonalPreconditioner{diagonal.data()},
      f.data(), u.data(), n, {.iterations = std::min(200 + 4 * n, kMostIterations), .relative_residual = 1e-10}, work);

  PrestressReport report;
  report.iterations = solved.iterations;
  report.converged = solved.converged;
  for (double x : u) report.converged = report.converged && std::fabs(x) < 1e3;  // a body nothing holds drifts away
  if (report.converged) {
    for (std::size_t s = 0; s < d.springs.size(); ++s) {
      auto& e = d.springs[s];
      if (!(e.k > 0)) continue;
      const double now = length(d.positions[e.b] - d.positions[e.a]);
      const double rest = rest_length_for_tension({e.p1, e.p2, e.cap}, e.k, now, network.tension(s, u.data()));
      if (!(rest > 0)) {
        ++report.failed_springs;
        continue;
      }
      e.rest_length = rest;
      const double strain = std::fabs(now / rest - 1);
      report.largest_strain = report.largest_strain > strain ? report.largest_strain : strain;
    }
    for (Anchor& a : anchors) {
      const double* x = u.data() + 3 * a.node;
      a.x0 = d.positions[a.node] - Vec3d{x[0], x[1], x[2]};
    }
  }
  report.residual = largest_imbalance(d, anchors);
  return report;
}

}  // namespace trocar::tissue
