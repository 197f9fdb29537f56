// Loads taken implicitly, node by node.
#include <cmath>

#include <trocar/tissue/network/network_loads.hpp>

namespace trocar::tissue {
namespace {

bool usable(const LoadedBody& m, const NodeLoad& l) {
  const float sum = ((std::fabs(l.f0.x) + std::fabs(l.f0.y)) + std::fabs(l.f0.z)) +
                    ((std::fabs(l.x0.x) + std::fabs(l.x0.y)) + std::fabs(l.x0.z)) +
                    ((std::fabs(l.u.x) + std::fabs(l.u.y)) + std::fabs(l.u.z)) +
                    ((std::fabs(l.dir.x) + std::fabs(l.dir.y)) + std::fabs(l.dir.z));
  return l.node >= 0 && l.node < m.nodes && l.k >= 0 && l.d >= 0 && l.k < 1e12f && l.d < 1e12f && sum < 1e12f;
}

bool is_zero(Vec3f a) { return a.x == 0 && a.y == 0 && a.z == 0; }

/// a += k P of a load, P as in NodeLoad.
void add_along(const NodeLoad& l, double k, Matrix6& a) {
  if (is_zero(l.dir)) {
    a.xx += k, a.yy += k, a.zz += k;
    return;
  }
  const Vec3d n = vec_cast<double>(l.dir);
  a.xx += k * n.x * n.x, a.yy += k * n.y * n.y, a.zz += k * n.z * n.z;
  a.xy += k * n.x * n.y, a.xz += k * n.x * n.z, a.yz += k * n.y * n.z;
}

Vec3d operator*(const Matrix6& a, Vec3d v) {
  return {a.xx * v.x + a.xy * v.y + a.xz * v.z, a.xy * v.x + a.yy * v.y + a.yz * v.z,
          a.xz * v.x + a.yz * v.y + a.zz * v.z};
}

/// P u of a load.
Vec3d projected(const NodeLoad& l, Vec3d u) {
  if (is_zero(l.dir)) return u;
  const Vec3d n = vec_cast<double>(l.dir);
  return dot(n, u) * n;
}

/// Of a symmetric positive definite matrix, by cofactors.
Matrix6 inverse(const Matrix6& a) {
  if (a.xy == 0 && a.xz == 0 && a.yz == 0) return {1 / a.xx, 1 / a.yy, 1 / a.zz, 0, 0, 0};
  const double cx = a.yy * a.zz - a.yz * a.yz, cy = a.xz * a.yz - a.xy * a.zz, cz = a.xy * a.yz - a.xz * a.yy;
  const double scale = 1 / (a.xx * cx + a.xy * cy + a.xz * cz);
  return {scale * cx, scale * (a.xx * a.zz - a.xz * a.xz), scale * (a.xx * a.yy - a.xy * a.xy), scale * cy,
          scale * cz, scale * (a.xy * a.xz - a.xx * a.yz)};
}

/// Held axes keep their velocity: what they couple to the others goes into `coupling`, on the diagonal 1 is left.
void hold(int held, Matrix6& a, Matrix6& coupling) {
  double* const diagonal[3] = {&a.xx, &a.yy, &a.zz};
  for (int i = 0; i < 3; ++i)
    if (held & (1 << i)) *diagonal[i] = 1;
  const auto part = [held](int i, int j, double& of, double& into) {
    if (held & ((1 << i) | (1 << j))) into = of, of = 0;
  };
  part(0, 1, a.xy, coupling.xy);
  part(0, 2, a.xz, coupling.xz);
  part(1, 2, a.yz, coupling.yz);
}

Vec3d held_part(int held, Vec3d v) {
  return {held & kHeldX ? v.x : 0, held & kHeldY ? v.y : 0, held & kHeldZ ? v.z : 0};
}

/// Where axes are held or loads pull in one direction.
Vec3d loaded_speed(const LoadedNode& n, Vec3d x, Vec3d free_v) {
  Vec3d b = n.mass * free_v + (n.impulse - n.stiffness * x);
  if (n.held != kFree) {
    const Vec3d kept = held_part(n.held, free_v);
    b = b - n.coupling * kept;
    b = (b - held_part(n.held, b)) + kept;
  }
  return n.inverse * b;
}

}  // namespace

ImplicitLoads::ImplicitLoads(const LoadedBody& body, std::span<const NodeLoad> loads,
                             std::span<LoadedNode> scratch) noexcept
    : m(body), m_loads(loads) {
  std::size_t count = 0;
  for (int i = 0; i < int(loads.size()) && count < scratch.size();) {
    int last = i + 1;
    if (usable(m, loads[std::size_t(i)])) {
      const auto more = [&](int k) {
        return k < int(loads.size()) && loads[std::size_t(k)].node == loads[std::size_t(i)].node &&
               usable(m, loads[std::size_t(k)]);
      };
      while (more(last)) ++last;
      add(i, last, scratch[count++]);
    }
    i = last;
  }
  m_nodes = scratch.first(count);
}

/// (m (1 + dt gamma) + dt D + dt^2 K) v = m (1 + dt gamma) v_free + dt (f0 + K (x0 + t u - x)), held axes left out.
void ImplicitLoads::add(int first, int last, LoadedNode& n) const noexcept {
  const std::size_t node = std::size_t(m_loads[std::size_t(first)].node);
  n.row = m.row_of_node[node];
  n.first = first, n.last = last;
  n.held = m.fixed[node];
  n.plain = n.held == kFree;
  n.mass = m.mass[node] * (1 + m.dt * m.gamma);
  n.impulse = n.drift = n.places = n.velocities = {};
  for (int i = first; i < last; ++i) n.plain = n.plain && is_zero(m_loads[std::size_t(i)].dir);
  if (n.plain)
    add_plain(n);
  else
    add_matrices(n);
}

void ImplicitLoads::add_plain(LoadedNode& n) const noexcept {
  double a = n.mass, stiffness = 0;
  for (int i = n.first; i < n.last; ++i) {
    const NodeLoad& l = m_loads[std::size_t(i)];
    const double k = double(l.k);
    a += m.dt * (double(l.d) + m.dt * k);
    stiffness += m.dt * k;
    const Vec3d u = vec_cast<double>(l.u);
    n.impulse += m.dt * (vec_cast<double>(l.f0) + k * ((vec_cast<double>(l.x0) + m.dt * u) - m.origin));
    n.drift += (m.dt * m.dt * k) * u;
  }
  n.inverse.xx = 1 / a;
  n.stiffness.xx = stiffness;
}

void ImplicitLoads::add_matrices(LoadedNode& n) const noexcept {
  Matrix6 a{n.mass, n.mass, n.mass, 0, 0, 0};
  n.stiffness = n.coupling = {};
  for (int i = n.first; i < n.last; ++i) {
    const NodeLoad& l = m_loads[std::size_t(i)];
    const double k = double(l.k);
    add_along(l, m.dt * (double(l.d) + m.dt * k), a);
    add_along(l, m.dt * k, n.stiffness);
    const Vec3d u = vec_cast<double>(l.u);
    n.impulse += m.dt * (vec_cast<double>(l.f0) + k * projected(l, (vec_cast<double>(l.x0) + m.dt * u) - m.origin));
    n.drift += (m.dt * m.dt * k) * projected(l, u);
  }
  if (n.held != kFree) hold(n.held, a, n.coupling);
  n.inverse = inverse(a);
}

bool ImplicitLoads::apply(const NodeState* in, NodeState* out) noexcept {
  bool fine = true;
  for (LoadedNode& n : m_nodes) {
    const Vec3d x = vec_cast<double>(place(in[n.row])), free_v = vec_cast<double>(speed(out[n.row]));
    const Vec3d v =
        n.plain ? n.inverse.xx * (n.mass * free_v + (n.impulse - n.stiffness.xx * x)) : loaded_speed(n, x, free_v);
    move_to(out[n.row], in[n.row], vec_cast<float>(v), float(m.dt));
    n.impulse += n.drift;
    n.places += x + m.dt * v;
    n.velocities += v;
    fine = fine && std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z) < 1e6;
  }
  return fine;
}

void ImplicitLoads::report(std::span<Vec3f> reactions) const noexcept {
  for (Vec3f& r : reactions) r = {};
  if (reactions.empty()) return;
  const double share = 1.0 / m.substeps, mean_time = 0.5 * m.dt * (m.substeps + 1);
  for (const LoadedNode& n : m_nodes) {
    const Vec3d x = share * n.places, v = share * n.velocities;
    for (int i = n.first; i < n.last; ++i) {
      const NodeLoad& l = m_loads[std::size_t(i)];
      const Vec3d reach = ((vec_cast<double>(l.x0) + mean_time * vec_cast<double>(l.u)) - m.origin) - x;
      reactions[std::size_t(i)] =
          vec_cast<float>(vec_cast<double>(l.f0) + projected(l, double(l.k) * reach - double(l.d) * v));
    }
  }
}

StepReport check_loads(const LoadedBody& m, std::span<const NodeLoad> loads) noexcept {
  for (std::size_t i = 0; i < loads.size(); ++i) {
    if (!usable(m, loads[i]) || (i > 0 && loads[i].node < loads[i - 1].node)) return {StepReport::kBadLoad, int(i)};
  }
  return {};
}

}  // namespace trocar::tissue
