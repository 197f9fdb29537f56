// Loads taken implicitly, node by node.
#include <cmath>

#include <trocar/tissue/network_loads.hpp>

namespace trocar::tissue {
namespace {

bool usable(const LoadedBody& m, const NodeLoad& l) {
  const float sum = ((std::fabs(l.f0.x) + std::fabs(l.f0.y)) + std::fabs(l.f0.z)) +
                    ((std::fabs(l.x0.x) + std::fabs(l.x0.y)) + std::fabs(l.x0.z)) +
                    ((std::fabs(l.dir.x) + std::fabs(l.dir.y)) + std::fabs(l.dir.z));
  return l.node >= 0 && l.node < m.nodes && l.k >= 0 && l.d >= 0 && l.k < 1e12f && l.d < 1e12f && sum < 1e12f;
}

/// a x = b for a symmetric positive definite 3x3 matrix given as xx, yy, zz, xy, xz, yz: LDL^T.
Vec3d solve3(const double a[6], Vec3d b) {
  const double l10 = a[3] / a[0], l20 = a[4] / a[0];
  const double d1 = a[1] - l10 * a[3];
  const double e21 = a[5] - l20 * a[3];
  const double l21 = e21 / d1;
  const double d2 = a[2] - l20 * a[4] - l21 * e21;
  const double y1 = b.y - l10 * b.x, y2 = b.z - l20 * b.x - l21 * y1;
  const double z = y2 / d2;
  const double y = y1 / d1 - l21 * z;
  return {b.x / a[0] - l10 * y - l20 * z, y, z};
}

bool is_zero(Vec3f a) { return a.x == 0 && a.y == 0 && a.z == 0; }

/// P u of a load.
Vec3d along(const NodeLoad& l, Vec3d u) {
  if (is_zero(l.dir)) return u;
  const Vec3d n = vec_cast<double>(l.dir);
  return dot(n, u) * n;
}

/// The loads of one node: (m (1 + dt gamma) + dt D + dt^2 K) v = m (1 + dt gamma) v_free + dt (f0 + K (x0 - x)),
/// held axes left out. Adds each load's mean force to `reactions`. False where the result is not finite.
bool apply_to_node(const LoadedBody& m, std::span<const NodeLoad> loads, Vec3f* reactions, const NodeState& in,
                   NodeState& out) {
  const int node = loads[0].node;
  const double dt = m.dt, mass = m.mass[node] * (1 + dt * m.gamma);
  const Vec3d x = vec_cast<double>(place(in)), free_v = vec_cast<double>(speed(out));
  double a[6] = {mass, mass, mass, 0, 0, 0};
  Vec3d b = mass * free_v;
  for (const NodeLoad& l : loads) {
    const Vec3d reach = (vec_cast<double>(l.x0) - m.origin) - x;
    const double q = dt * (double(l.d) + dt * double(l.k));
    b += dt * (vec_cast<double>(l.f0) + double(l.k) * along(l, reach));
    const Vec3d n = vec_cast<double>(l.dir);
    if (is_zero(l.dir)) {
      a[0] += q, a[1] += q, a[2] += q;
    } else {
      a[0] += q * n.x * n.x, a[1] += q * n.y * n.y, a[2] += q * n.z * n.z;
      a[3] += q * n.x * n.y, a[4] += q * n.x * n.z, a[5] += q * n.y * n.z;
    }
  }
  const int held = m.fixed[node];
  if (held != kFree) {
    // A held axis keeps its velocity: move its column to the right side, put 1 on its diagonal.
    const int cross_of[3][2] = {{3, 4}, {3, 5}, {4, 5}}, other[3][2] = {{1, 2}, {0, 2}, {0, 1}};
    for (int i = 0; i < 3; ++i) {
      if (!(held & (1 << i))) continue;
      for (int j = 0; j < 2; ++j) {
        b[other[i][j]] -= a[cross_of[i][j]] * free_v[i];
        a[cross_of[i][j]] = 0;
      }
      a[i] = 1;
      b[i] = free_v[i];
    }
    for (int i = 0; i < 3; ++i)
      if (held & (1 << i)) b[i] = free_v[i];
  }
  const bool isotropic = a[3] == 0 && a[4] == 0 && a[5] == 0;  // most are: spare the elimination
  const Vec3d v = isotropic ? Vec3d{b.x / a[0], b.y / a[1], b.z / a[2]} : solve3(a, b);
  move_to(out, in, vec_cast<float>(v), float(dt));
  const bool fine = std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z) < 1e6;
  if (!reactions) return fine;
  const double share = 1.0 / m.substeps;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const NodeLoad& l = loads[i];
    const Vec3d reach = (vec_cast<double>(l.x0) - m.origin) - (x + dt * v);
    const Vec3d force = vec_cast<double>(l.f0) + along(l, double(l.k) * reach - double(l.d) * v);
    reactions[i] += vec_cast<float>(share * force);
  }
  return fine;
}

}  // namespace

bool apply_loads(const LoadedBody& m, std::span<const NodeLoad> loads, std::span<Vec3f> reactions, const NodeState* in,
                 NodeState* out) noexcept {
  bool fine = true;
  for (std::size_t i = 0; i < loads.size();) {
    std::size_t end = i + 1;
    if (!usable(m, loads[i])) {
      i = end;
      continue;
    }
    while (end < loads.size() && loads[end].node == loads[i].node && usable(m, loads[end])) ++end;
    const int row = m.row_of_node[loads[i].node];
    Vec3f* reaction = reactions.empty() ? nullptr : reactions.data() + i;
    fine = apply_to_node(m, loads.subspan(i, end - i), reaction, in[row], out[row]) && fine;
    i = end;
  }
  return fine;
}

StepReport check_loads(const LoadedBody& m, std::span<const NodeLoad> loads) noexcept {
  for (std::size_t i = 0; i < loads.size(); ++i) {
    if (!usable(m, loads[i]) || (i > 0 && loads[i].node < loads[i - 1].node)) return {StepReport::kBadLoad, int(i)};
  }
  return {};
}

}  // namespace trocar::tissue
