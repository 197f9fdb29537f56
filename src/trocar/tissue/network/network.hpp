// Volumetric tissue as a network of mass points, springs and dampers: the paper's full dynamic mesh.
//
//   m_i x_i'' + gamma m_i x_i' + g_i = f_i                                               [KCM99 eq.1]
//   s_k = c_k e_k r_k/|r_k|,  e_k = |r_k| - l_k,  r_k = x_j - x_i,  g_i = -sum_k s_k     [KCM99 eq.2]
//   h = f - gamma m v - g,  a = B h / m,  v += dt a,  x += dt v (the new v)              [KCM99 eq.3]
// with c_k the polynomial of [KCM99 eq.5] (law.hpp) and whole sub-steps of a tick from the true limit (stability.hpp).
// Deviations: the sign of g (as printed a stretched spring would repel); gamma is per mass and taken implicitly; each
// spring also damps along itself; below half its rest length a spring's direction is r/(l/2) instead of r/|r|, because
// compression's transverse stiffness, force over length, would grow beyond what the step bears; loads with stiffness
// are taken implicitly, so that any stiffness is stable; a cell that collapses is driven back to its drawn shape,
// turned as the body is, because its mirror image would satisfy all springs.
//
// Every spring is evaluated once, by one of its ends, which leaves the force for the other end to pick up: no scatter,
// no colouring, and the same bits for any number of threads and any SIMD width. Each node evaluates half of its
// springs, so that slices of rows pad little. Nodes are stored as rows in reverse Cuthill-McKee order: a force is
// picked up soon, while it is in the cache.
//
//   NetworkModel model = build(description, 1e-3);
//   NetworkState state = rest_state(model);
//   NetworkWork work = make_work(model);
//   NodeLoad pull{.node = 7, .k = 200, .x0 = tip};
//   Vec3f force;
//   StepReport report = advance(model, {&pull, 1}, {&force, 1}, state, work);
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/parallel.hpp>
#include <trocar/numerics/vec3.hpp>
#include <trocar/tissue/base/report.hpp>
#include <trocar/tissue/network/guard.hpp>
#include <trocar/tissue/network/loaded_node.hpp>
#include <trocar/tissue/network/node_view.hpp>
#include <trocar/tissue/network/scarred_spring.hpp>
#include <trocar/tissue/network/volume_force.hpp>

namespace trocar::tissue {

/// Held axes of a node: B of [KCM99 eq.3] is 0 on them. Bits of NetworkDescription::fixed.
enum Held : std::uint8_t { kFree = 0, kHeldX = 1, kHeldY = 2, kHeldZ = 4, kHeld = 7 };

struct SpringDescription {
  int a = 0, b = 0;        ///< nodes
  double rest_length = 0;  ///< l [m] > 0
  double k = 0;            ///< small-strain stiffness [N/m] >= 0
  double p1 = 0, p2 = 0;   ///< shape factors of [KCM99 eq.5]
  double cap = 1;          ///< strain beyond which the law is linear
  double damping = 0;      ///< along the spring [N s/m]
};

struct NetworkDescription {
  std::vector<Vec3d> positions;     ///< drawn shape [m], world frame
  std::vector<double> mass;         ///< per node [kg] > 0
  std::vector<std::uint8_t> fixed;  ///< per node, Held bits; empty = all free
  std::vector<SpringDescription> springs;
  std::vector<std::array<int, 4>> tets;  ///< cells protected against inversion, of positive volume; may be empty
  double global_damping = 0;             ///< gamma [1/s], against space; keep <= 1
  Vec3d gravity{0, 0, 0};                ///< [m/s^2]
  double opening_time = 0;               ///< for collapsed cells to take their shape again [s]; 0: kOpeningTime
  double kappa = 0;                      ///< of the volume force of the tets (volume_force.hpp) [Pa]; 0: none
  double max_stiffness_scale = 1;        ///< largest value set_spring_scale may give; enters the time step bound
};

/// Const after build(); shared by any number of States.
struct NetworkModel {
  int nodes = 0;  ///< as described
  int rows = 0;   ///< nodes rounded up to whole slices
  int springs = 0;
  Vec3d origin{0, 0, 0};                         ///< State positions are relative to this point [m]
  std::vector<int> row_of_node;                  ///< (nodes)
  std::vector<int> node_of_row;                  ///< (rows), -1 = padding
  std::vector<int> slice_begin;                  ///< (slices + 1) first pack of each slice
  std::vector<HalfEdgePack> packs;               ///< every spring once, at the row that evaluates it
  std::vector<int> arrival_begin;                ///< (slices + 1) first pack of each slice
  std::vector<ArrivalPack> arrivals;             ///< every spring once, at its other end
  int lag = 0, ring = 1;                         ///< as in KernelArgs
  std::vector<LawPack> law_packs;                ///< empty where one law serves the body
  float p1 = 0, p2 = 0, cap = 1, cap_slope = 1;  ///< that law
  std::vector<RowPack> row_packs;                ///< (slices)
  std::vector<Vec3d> rest;                       ///< (nodes) drawn positions, world frame [m]
  std::vector<double> mass;                      ///< (nodes) [kg]
  std::vector<std::uint8_t> fixed;               ///< (nodes) Held bits
  std::vector<int> spring_nodes;                 ///< (2 springs) a, b
  std::vector<float> spring_rest;                ///< (springs) l [m]
  std::vector<int> place;                        ///< (springs) in packs, and in NetworkState::scale
  std::vector<TetRest> tets;                     ///< as described
  std::vector<TetPack> tet_packs;                ///< the same, for the search for collapsed ones
  std::vector<int> tet_begin;                    ///< (nodes + 1) into tet_of_node
  std::vector<int> tet_of_node;                  ///< cells at a node
  Bulk bulk;                                     ///< the volume force; its impulses divide the sub-steps
  VolumeCells volume_cells;                      ///< empty where there is none
  double tick = 0;                               ///< [s]
  int substeps = 1;
  double dt = 0;        ///< tick / substeps [s]
  double dt_limit = 0;  ///< sufficient stability limit [s]
  double gamma = 0;     ///< [1/s]
  Vec3d gravity{0, 0, 0};
  float decay = 1;                    ///< 1 / (1 + dt gamma)
  float gravity_step[3] = {0, 0, 0};  ///< dt g / (1 + dt gamma) [m/s]
  float max_scale = 1;
  float opening = kOpeningTime;  ///< within which a collapsed cell is driven open [s]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("nodes", s.nodes), v("origin", s.origin), v("row_of_node", s.row_of_node), v("slice_begin", s.slice_begin),
        v("packs", s.packs), v("arrival_begin", s.arrival_begin), v("arrivals", s.arrivals),
        v("law_packs", s.law_packs), v("p1", s.p1, core::kWithNext), v("p2", s.p2, core::kWithNext),
        v("cap", s.cap, core::kWithNext), v("cap_slope", s.cap_slope, core::kWithNext),
        v("decay", s.decay, core::kWithNext), v("max_scale", s.max_scale, core::kWithNext), v("opening", s.opening),
        v("row_packs", s.row_packs), v("tet_packs", s.tet_packs), v("rest", s.rest), v("mass", s.mass),
        v("fixed", s.fixed), v("substeps", s.substeps), v("bulk", s.bulk), v("dt", s.dt),
        v("gravity_step", s.gravity_step), v("rows", s.rows, core::kNotHashed),
        v("springs", s.springs, core::kNotHashed), v("node_of_row", s.node_of_row, core::kNotHashed),
        v("lag", s.lag, core::kNotHashed), v("ring", s.ring, core::kNotHashed),
        v("spring_nodes", s.spring_nodes, core::kNotHashed), v("spring_rest", s.spring_rest, core::kNotHashed),
        v("place", s.place, core::kNotHashed), v("tets", s.tets, core::kNotHashed),
        v("tet_begin", s.tet_begin, core::kNotHashed), v("tet_of_node", s.tet_of_node, core::kNotHashed),
        v("volume_cells", s.volume_cells, core::kNotHashed), v("tick", s.tick, core::kNotHashed),
        v("dt_limit", s.dt_limit, core::kNotHashed), v("gamma", s.gamma, core::kNotHashed),
        v("gravity", s.gravity, core::kNotHashed);
  }
};

struct NetworkState {
  std::vector<NodeState> nodes;         ///< (rows)
  std::vector<float> scale;             ///< per place: 1 whole, 0 cut
  std::vector<std::uint8_t> tet_phase;  ///< (tets) as GuardState::phase
  std::uint32_t version = 0;            ///< counts cuts and changes of scale; 0 = untouched
  std::uint32_t open_tets = 0;          ///< cells being pushed open
  std::uint32_t tick = 0;               ///< ticks made

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("nodes", s.nodes), v("scale", s.scale), v("tet_phase", s.tet_phase), v("version", s.version),
        v("open_tets", s.open_tets), v("tick", s.tick);
  }
};

/// Forces on their way from one end of a spring to the other, for one thread.
struct ForceWork {
  std::vector<ForcePack> forces;  ///< (1 + ring)
  std::vector<ForceSum> sums;     ///< (lag + 1)

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("forces", s.forces), v("sums", s.sums);
  }
};

/// Scratch: its contents between ticks do not matter.
struct NetworkWork {
  std::vector<NodeState> other;      ///< (rows) the ping-pong partner
  std::vector<ForceWork> forces;     ///< (threads)
  std::vector<LoadedNode> loaded;    ///< (nodes)
  VolumeWork volume;                 ///< empty where there is no volume force
  std::vector<int> open_tets;        ///< capacity: tets
  std::vector<std::uint8_t> folded;  ///< (rows)
  std::vector<std::uint16_t> below;  ///< (tet packs)
  ScarWork scars;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("other", s.other), v("forces", s.forces), v("loaded", s.loaded), v("volume", s.volume),
        v("open_tets", s.open_tets), v("folded", s.folded), v("below", s.below), v("scars", s.scars);
  }
};

/// A force on one node during one tick, taken implicitly: f0 - k P (x - x0 - t u) - d P v with P = 1, or dir dir^T
/// where dir is not zero (a unit vector then), and t the time since the tick began. Several loads per node add up, in
/// order.
struct NodeLoad {
  int node = 0;  ///< Description's numbering
  Vec3f f0{};    ///< constant part [N]
  float k = 0;   ///< [N/m] >= 0
  Vec3f x0{};    ///< rest point when the tick begins, world frame [m]
  Vec3f u{};     ///< how fast that goes [m/s]
  Vec3f dir{};   ///< zero, or unit
  float d = 0;   ///< [N s/m] >= 0
};

/// Compiles a network. `tick` [s]. Throws std::invalid_argument naming the first node, spring or cell that is unsound
/// (mass or rest length not positive, law not monotone, index out of range, negative cell volume).
NetworkModel build(const NetworkDescription& description, double tick);

NetworkState rest_state(const NetworkModel& model);
/// @param threads  the most that advance() will use
NetworkWork make_work(const NetworkModel& model, int threads = 1);

/// One tick. Loads must be sorted by node (otherwise kBadLoad). `reactions` (as long as loads, or empty) receives the
/// force each load exerted on its node, averaged over the tick [N]; what holds the tissue feels the opposite.
/// @param hands  on: folded cells are not driven home, as hands may be what keeps them folded
/// @param scars  springs that heat has changed (network_scars.hpp)
/// @param steady  (rows) forces that stay the same for all of the tick [N], or empty
/// Bits depend neither on the pool nor on the SIMD width.
StepReport advance(const NetworkModel& model, std::span<const NodeLoad> loads, std::span<Vec3f> reactions,
                   NetworkState& state, NetworkWork& work, core::ThreadPool* pool = nullptr, Hands hands = Hands::off,
                   std::span<const ScarredSpring> scars = {}, std::span<const Vec3f> steady = {}) noexcept;

inline NodeView view_of(const NetworkModel& model, const NetworkState& state) noexcept {
  return {state.nodes, model.row_of_node, model.origin};
}
/// (rows) Nodes of cells that have been folded for long, or nothing; valid until the next tick.
std::span<const std::uint8_t> folded_rows(const NetworkModel& model, const NetworkState& state,
                                          NetworkWork& work) noexcept;
/// Position in the world frame [m] and velocity [m/s] of a node.
Vec3d position(const NetworkModel& model, const NetworkState& state, int node) noexcept;
Vec3d velocity(const NetworkModel& model, const NetworkState& state, int node) noexcept;
void set_position(const NetworkModel& model, NetworkState& state, int node, Vec3d x) noexcept;
void set_velocity(const NetworkModel& model, NetworkState& state, int node, Vec3d v) noexcept;

/// e/l of a spring as it stands [-].
double spring_strain(const NetworkModel& model, const NetworkState& state, int spring) noexcept;
/// Scale a spring's stiffness and damping: 0 = cut, 1 = whole; clamped to [0, max_stiffness_scale].
void set_spring_scale(const NetworkModel& model, NetworkState& state, int spring, float scale) noexcept;
float spring_scale(const NetworkModel& model, const NetworkState& state, int spring) noexcept;
/// Of a small strain, as built [N/m].
double spring_stiffness(const NetworkModel& model, int spring) noexcept;
/// Cut a spring: both half-edges dead, and the cells that have it as an edge no longer protected.
void cut_spring(const NetworkModel& model, NetworkState& state, int spring) noexcept;

/// Sum of kinetic, spring and gravity energy [J] (double precision, for tests and reports).
struct NetworkEnergy {
  double kinetic = 0, elastic = 0, gravity = 0;
};
NetworkEnergy energy(const NetworkModel& model, const NetworkState& state) noexcept;

void add_to_hash(core::Hasher& hasher, const NetworkState& state) noexcept;
/// Hash of everything in the Model that the step reads.
void add_to_hash(core::Hasher& hasher, const NetworkModel& model) noexcept;

/// The instruction set advance() uses on this machine: "sse2", "avx2", "avx512" or "generic". TROCAR_SIMD overrides
/// (read once); a name this machine cannot run falls back to the widest that it can below it.
const char* simd_name() noexcept;
/// Choose by hand (tests, benches): returns false and changes nothing where this machine cannot run it.
bool set_simd(const std::string& name) noexcept;

}  // namespace trocar::tissue
