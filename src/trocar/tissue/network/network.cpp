// One tick of the network: sub-steps of the chosen kernel, collapsed cells mended, loads taken implicitly.
#include <algorithm>
#include <cmath>
#include <utility>

#include <trocar/tissue/base/law.hpp>
#include <trocar/tissue/network/network.hpp>
#include <trocar/tissue/network/network_kernels.hpp>
#include <trocar/tissue/network/network_loads.hpp>
#include <trocar/tissue/network/network_scars.hpp>

namespace trocar::tissue {
namespace {

GuardedBody guarded_of(const NetworkModel& m, const NetworkState& s) {
  return {.cells = m.tets,
          .packs = m.tet_packs,
          .row_of_node = m.row_of_node,
          .node_of_row = m.node_of_row,
          .mass = m.mass,
          .rest = m.rest,
          .row_packs = m.row_packs,
          .part = {},
          .nodes = m.nodes,
          .rows = m.rows,
          .origin = m.origin,
          .dt = m.dt,
          .uncut = s.version == 0,
          .opening = m.opening};
}

KernelArgs kernel_args(const NetworkModel& m, const NetworkState& s) {
  KernelArgs a;
  a.packs = m.packs.data();
  a.laws = m.law_packs.empty() ? nullptr : m.law_packs.data();
  a.scale = s.version == 0 ? nullptr : s.scale.data();
  a.rows = m.row_packs.data();
  a.slice_begin = m.slice_begin.data();
  a.p1 = m.p1, a.p2 = m.p2, a.cap = m.cap, a.cap_slope = m.cap_slope;
  a.decay = m.decay;
  for (int i = 0; i < 3; ++i) a.gravity_step[i] = m.gravity_step[i];
  a.dt = float(m.dt);
  a.arrivals = m.arrivals.data();
  a.arrival_begin = m.arrival_begin.data();
  a.slices = m.rows / kSlice;
  a.lag = m.lag, a.ring = m.ring;
  return a;
}

constexpr int kSlicesPerThread = 24;  // below this a thread's wake-up costs more than it saves

bool run_part(KernelArgs a, ForceWork& w, int first, int last) {
  a.forces = w.forces.data();
  a.sums = w.sums.data();
  return kernels().substep(a, first, last);
}

bool run_substep(const KernelArgs& a, std::vector<ForceWork>& w, core::ThreadPool* pool) {
  constexpr int kMostThreads = 64;
  const int threads = pool ? std::min({pool->threads(), int(w.size()), kMostThreads}) : 1;
  if (threads < 2 || a.slices < threads * kSlicesPerThread) return run_part(a, w[0], 0, a.slices);
  bool fine[kMostThreads];
  core::run(*pool, threads, [&](int i) noexcept {
    const auto border = [&](int part) { return int(std::int64_t(a.slices) * part / threads); };
    fine[i] = run_part(a, w[std::size_t(i)], border(i), border(i + 1));
  });
  return std::all_of(fine, fine + threads, [](bool b) { return b; });
}

int first_non_finite(const NetworkModel& m, const NetworkState& s) {
  for (int i = 0; i < m.nodes; ++i) {
    const NodeState& n = s.nodes[m.row_of_node[i]];
    const float size =
        ((std::fabs(n.x) + std::fabs(n.y)) + std::fabs(n.z)) + ((std::fabs(n.vx) + std::fabs(n.vy)) + std::fabs(n.vz));
    if (!(size < 1e6f)) return i;
  }
  return -1;
}

/// What pushes all of a tick alike, in the sub-step that the kernel has made: the weights of its rows hold dt / m.
void push_steadily(const KernelArgs& a, std::span<const Vec3f> steady) noexcept {
  for (std::size_t r = 0; r < steady.size(); ++r) {
    const Vec3f f = steady[r];
    if (f.x == 0 && f.y == 0 && f.z == 0) continue;
    const RowPack& w = a.rows[r / kSlice];
    const std::size_t lane = r % kSlice;
    NodeState& n = a.out[r];
    const Vec3f dv{w.wx[lane] * f.x, w.wy[lane] * f.y, w.wz[lane] * f.z};
    n.vx += dv.x, n.vy += dv.y, n.vz += dv.z;
    n.x += a.dt * dv.x, n.y += a.dt * dv.y, n.z += a.dt * dv.z;
  }
}

}  // namespace

StepReport advance(const NetworkModel& m, std::span<const NodeLoad> loads, std::span<Vec3f> reactions, NetworkState& s,
                   NetworkWork& w, core::ThreadPool* pool, Hands hands, std::span<const ScarredSpring> springs,
                   std::span<const Vec3f> steady) noexcept {
  LoadedBody body = loaded_body(m);
  StepReport report = check_loads(body, loads);
  ScarredSprings scars(body, springs, w.scars);
  ImplicitLoads pull(body, loads, w.loaded);
  const GuardedBody guarded = guarded_of(m, s);
  Guard guard(guarded, {s.tet_phase, s.open_tets, s.tick}, {w.open_tets, w.below}, s.nodes, hands);
  if (guard.at_work()) report.flags |= StepReport::kInverted;
  KernelArgs args = kernel_args(m, s);
  bool fine = true;
  for (int i = 0; i < m.substeps; ++i) {
    if (m.bulk.impulses > 0 && i % (m.substeps / m.bulk.impulses) == 0) {
      scars.mark(s.nodes);
      push_volumes(m.volume_cells, s.tet_phase, m.bulk, m.tick / m.bulk.impulses, m.dt, s.nodes, w.volume);
      scars.ease(s.nodes);
    }
    args.in = s.nodes.data();
    args.out = w.other.data();
    fine = run_substep(args, w.forces, pool) && fine;
    push_steadily(args, steady);
    scars.apply(args.in, args.out);
    guard.mend(args.in, args.out);
    fine = pull.apply(args.in, args.out) && fine;
    guard.catch_leaps(args.in, args.out);
    std::swap(s.nodes, w.other);
  }
  pull.report(reactions);
  guard.release(s.nodes);
  ++s.tick;
  if (!fine) report = StepReport{StepReport::kNonFinite, first_non_finite(m, s)} | report;
  return report;
}

}  // namespace trocar::tissue
