#include <algorithm>
#include <stdexcept>

#include <trocar/interactions/bodies/hosting.hpp>

namespace trocar::interactions {
namespace {

/// Solves the 4x4 system a z = b by elimination with pivoting.
bool solve4(double (&a)[4][5], double (&z)[4]) {
  for (int c = 0; c < 4; ++c) {
    int pivot = c;
    for (int r = c + 1; r < 4; ++r)
      if (std::fabs(a[r][c]) > std::fabs(a[pivot][c])) pivot = r;
    if (std::fabs(a[pivot][c]) < 1e-12) return false;
    for (int k = 0; k < 5; ++k) std::swap(a[c][k], a[pivot][k]);
    for (int r = 0; r < 4; ++r) {
      if (r == c) continue;
      const double f = a[r][c] / a[c][c];
      for (int k = c; k < 5; ++k) a[r][k] -= f * a[c][k];
    }
  }
  for (int c = 0; c < 4; ++c) z[c] = a[c][4] / a[c][c];
  return true;
}

}  // namespace

HostPatch make_patch(std::span<const Vec3d> rest, std::span<const double> mass, Vec3d point, double radius) {
  HostPatch patch;
  std::vector<double> g;
  std::vector<Vec3d> d;
  for (int i = 0; i < int(mass.size()); ++i) {
    const Vec3d away = (rest[size_t(i)] - point) / radius;
    const double r2 = dot(away, away);
    if (r2 >= 1.0) continue;
    patch.node.push_back(i);
    g.push_back(mass[size_t(i)] * (1 - r2) * (1 - r2));
    d.push_back(away);
  }
  if (patch.node.size() < 4) throw std::invalid_argument("fewer than four nodes near the end");
  // w_i = g_i (z0 + z . d_i) with sum w = 1, sum w d = 0: moments of g give a 4x4 system.
  double total = 0;
  for (double gi : g) total += gi;
  double a[4][5] = {};
  for (size_t i = 0; i < g.size(); ++i) {
    const double basis[4] = {1, d[i].x, d[i].y, d[i].z};
    for (int r = 0; r < 4; ++r)
      for (int c = 0; c < 4; ++c) a[r][c] += g[i] / total * basis[r] * basis[c];
  }
  a[0][4] = 1;
  double z[4] = {1, 0, 0, 0};
  const bool exact = solve4(a, z);
  Vec3d mean{0, 0, 0};
  for (size_t i = 0; i < g.size(); ++i) {
    const double tilt = exact ? z[0] + z[1] * d[i].x + z[2] * d[i].y + z[3] * d[i].z : 1.0;
    patch.weight.push_back(float(g[i] / total * tilt));
    mean += double(patch.weight.back()) * rest[size_t(patch.node[i])];
  }
  patch.offset = point - mean;
  return patch;
}

tissue::StrandEnd hosted_end(const HostPatch& patch, const tissue::NodeView& nodes, double dt) noexcept {
  tissue::StrandEnd end{patch.offset, {0, 0, 0}};
  for (size_t i = 0; i < patch.node.size(); ++i) {
    end.x += double(patch.weight[i]) * nodes.position(patch.node[i]);
    end.v += double(patch.weight[i]) * nodes.velocity(patch.node[i]);
  }
  end.x += dt * end.v;
  return end;
}

void host_loads(const HostPatch& patch, const tissue::StrandReaction& reaction, const tissue::NodeView& nodes,
                double dt, int strand, NetworkLoads& loads) noexcept {
  // The reaction was found for the patch flying on freely; where the tick bends that flight, the pull falls by the
  // tangent. Over one tick that is a resistance of K dt to changes of velocity, and needs no rest point.
  const Mat3d& t = reaction.tangent;
  double weights = 0;  // above 1 where the end lies at the rim of its patch: bounds the coupling between nodes
  for (float w : patch.weight) weights += std::fabs(double(w));
  const double k = weights * std::max(0.0, t.m[0][0] + t.m[1][1] + t.m[2][2]);
  for (size_t i = 0; i < patch.node.size(); ++i) {
    const double share = double(patch.weight[i]), d = std::fabs(share) * k * dt;
    tissue::NodeLoad load;
    load.node = patch.node[i];
    load.d = float(d);
    const Vec3d v = counted_on(nodes.velocity(patch.node[i]));
    load.f0 = vec_cast<float>(share * (reaction.force - patch.drawn_pull) + d * v);
    loads.add(load, {Owner::strand_end, strand, 0}, i > 0);
  }
}

}  // namespace trocar::interactions
