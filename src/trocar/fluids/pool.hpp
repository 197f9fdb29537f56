// Fluid that has gathered: a height field over a floor that may move. Cells hold whole picolitres of blood, saline and
// bile; what passes from cell to cell is a whole number too, so that the pool's content never changes by itself.
//
//   du/dt + u.grad u + g grad eta + (1/h) grad N = -(c |u|/h + 3 nu/h^2 + gamma) u      u at the cells' faces
//   N = -(h^3/3) (d/dt + u.grad - div u) div u            [Serre 1953, Green & Naghdi 1976]
//   dV/dt = inflow - outflow                              V in the cells
//
// Depth-averaged flow with the vertical inertia of the fluid: waves of k h go with w^2 = g h k^2 / (1 + k^2 h^2 / 3),
// shallow ones with sqrt(g h). N's part that is linear in du/dt is solved implicitly, direction by direction (a
// tridiagonal system a row), which also keeps the step stable in deep cells; the rest is explicit and bounded by the
// hydrostatic pressure (our choice). Momentum is advected as in [Stelling & Duinmeijer 2003]. c is friction on the
// bed, 3 nu / h^2 that of a thin film [Nusselt 1916], gamma the damping of ripples (our choice). A face is under fluid
// from the higher bed of its two cells up to the higher surface. No cell gives more than it has.
//
// Instruments are capsules; they lift the surface by the height of the column that they fill, so moving ones make
// waves. The frame: origin, axes u and v, and up (against gravity); heights are along up from the origin.
//
//   PoolModel m = build(PoolDescription{.origin = {-0.08, -0.08, 0}, .nx = 128, .ny = 128, .cell = 0.00125});
//   PoolState s = empty_pool(m);  PoolWork w = make_work(m);
//   pour(m, 64, 64, {.blood = kMillilitre}, s);
//   advance(m, {.floor = heights}, s, w, ledger);               // every tick; works on every 4th
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/tick.hpp>
#include <trocar/fluids/capsule.hpp>
#include <trocar/fluids/ledger.hpp>
#include <trocar/fluids/report.hpp>

namespace trocar::fluids {

inline constexpr std::int32_t kMostInACell = 1 << 30;  ///< [pL]; 0.69 m of fluid on a cell of 1.25 mm
inline constexpr int kMostDrains = 16;

struct PoolDescription {
  Vec3d origin{0, 0, 0};         ///< corner of cell (0, 0) [m]
  Vec3d u{1, 0, 0}, v{0, 1, 0};  ///< unit, orthogonal; up = u x v
  int nx = 128, ny = 128;        ///< cells, 2 .. 1024
  double cell = 0.00125;         ///< [m]
  double gravity = 9.81;         ///< [m/s^2], against up
  double vertical_inertia = 1;   ///< share of N: 1 as above, 0 plain shallow water
  double inertia_depth = 0.008;  ///< deeper columns have the vertical inertia of this depth [m]
  double friction = 0.005;       ///< c
  double viscosity = 3.3e-6;     ///< nu, of blood [m^2/s]
  double damping = 2;            ///< gamma [1/s]: ripples fall to 1/e in a second
  int period = 4;                ///< ticks between two steps
  int first = 0;                 ///< tick of the first step, before `period`
};

struct PoolModel : PoolDescription {
  Vec3d up{0, 0, 1};
  double tick = core::kTick;  ///< [s]
  int stride = 0;             ///< of a row in the arrays: nx + 1
  float height_per_pl = 0;    ///< depth of a picolitre on a cell [m]
  float fastest = 0;          ///< bound of speeds: half a cell a step [m/s]

  std::size_t size() const { return std::size_t(ny + 4) * stride + 16; }
  /// Place of cell (i, j) in the arrays; also of the faces between it and (i - 1, j), (i, j - 1).
  int at(int i, int j) const { return (j + 1) * stride + i; }
  double dt() const { return tick * period; }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("origin", s.origin), v("u", s.u), v("v", s.v), v("nx", s.nx), v("ny", s.ny), v("cell", s.cell),
        v("gravity", s.gravity, core::kNotHashed), v("vertical_inertia", s.vertical_inertia, core::kNotHashed),
        v("inertia_depth", s.inertia_depth, core::kNotHashed), v("friction", s.friction, core::kNotHashed),
        v("viscosity", s.viscosity, core::kNotHashed), v("damping", s.damping, core::kNotHashed),
        v("period", s.period, core::kNotHashed), v("first", s.first, core::kNotHashed), v("up", s.up, core::kNotHashed),
        v("tick", s.tick, core::kNotHashed), v("stride", s.stride, core::kNotHashed),
        v("height_per_pl", s.height_per_pl, core::kNotHashed), v("fastest", s.fastest, core::kNotHashed);
  }
};

struct PoolState {
  std::vector<std::int32_t> blood, saline, bile;  ///< (size) [pL] in the cells
  std::vector<float> u, v;                        ///< (size) speed through the faces towards +u, +v [m/s]
  Mix held;                                       ///< what no cell had room for [pL]
  Blood shed;                                     ///< what its blood is, in the mean of all
  std::array<double, kMostDrains> drain_carry{};  ///< [pL]
  float highest = 1e3f;                           ///< no surface or bed was above it at the last step [m]
  std::int32_t first_row = 0, last_row = -1;      ///< that may hold speeds other than 0
  float churn = 0;         ///< most that passed a face in the last step, as height of a cell over time [m/s]
  std::uint64_t next = 0;  ///< tick of the next step
  std::uint64_t tick = 0;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("blood", s.blood), v("saline", s.saline), v("bile", s.bile), v("u", s.u), v("v", s.v), v("held", s.held),
        v("shed", s.shed), v("churn", s.churn), v("next", s.next), v("drain_carry", s.drain_carry),
        v("highest", s.highest), v("first_row", s.first_row), v("last_row", s.last_row), v("tick", s.tick);
  }
};

struct PoolWork {
  std::vector<float> bed, depth, eta, volume;          ///< (size) of cells; bed includes what instruments fill
  std::vector<float> inertia, extra;                   ///< (size) h^3/3 dx^2 and N of cells
  std::vector<float> under, rhs, flux, sweep, answer;  ///< (size) of faces
  std::vector<float> flux_v;                           ///< (size) of the other faces [pL]
  std::vector<float> keep;                             ///< (size) of cells: share of what leaves that is of one species
  std::vector<std::int32_t> moved_u, moved_v;          ///< (size) of faces, one species [pL]
  std::vector<float> tops;                             ///< (nx) the highest of each column
  std::vector<float> strip[4];                         ///< (16 (nx + 1)) sixteen rows, turned

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("bed", s.bed), v("depth", s.depth), v("eta", s.eta), v("volume", s.volume), v("inertia", s.inertia),
        v("extra", s.extra), v("under", s.under), v("rhs", s.rhs), v("flux", s.flux), v("sweep", s.sweep),
        v("answer", s.answer), v("flux_v", s.flux_v), v("keep", s.keep), v("moved_u", s.moved_u),
        v("moved_v", s.moved_v), v("tops", s.tops), v("strip", s.strip);
  }
};

/// A hole in the bed. An open one takes everything that reaches its cell, the others by Q = Cd a sqrt(2 g h).
struct Drain {
  int i = 0, j = 0;
  double area = 0;  ///< [m^2]; 0 = open
  double cd = 0.61;
};

struct PoolInput {
  std::span<const float> floor;       ///< (ny x nx) height of the bed [m]; empty = 0 everywhere
  std::span<const Capsule> capsules;  ///< in the world's frame
  std::span<const Drain> drains;      ///< the first kMostDrains count; the order is their name
};

/// @throws std::invalid_argument naming what is out of range
PoolModel build(const PoolDescription& description, double tick = core::kTick);
PoolState empty_pool(const PoolModel& model);
PoolWork make_work(const PoolModel& model);

/// One tick. Works on every `period`-th; where much flows, more often (our choice): when more than 8 mm of a cell's
/// height would pass a face in a step, steps are halved, down to a tick. Longer ones drive deep fluid that is stirred
/// ever higher.
/// @param ledger  drained volume is booked from the pool
FluidReport advance(const PoolModel& model, const PoolInput& input, PoolState& state, PoolWork& work,
                    Ledger& ledger) noexcept;

struct PoolPoint {
  int i = 0, j = 0;     ///< nearest cell
  bool inside = false;  ///< over or under the field, not beside it
  float height = 0;     ///< along up from the origin [m]
};
PoolPoint locate(const PoolModel& model, Vec3d p) noexcept;  ///< what is not finite: the middle cell, not inside
Vec3d world(const PoolModel& model, double along_u, double along_v, double height) noexcept;  ///< [m] from the origin

float floor_at(const PoolModel& model, std::span<const float> floor, int i, int j) noexcept;  ///< [m], always finite
Mix mix_at(const PoolModel& model, const PoolState& state, int i, int j) noexcept;            ///< [pL]
float depth_at(const PoolModel& model, const PoolState& state, int i, int j) noexcept;        ///< [m]

/// Adds a volume to a cell (to what waits, if it is full).  @return false if it had to wait
bool pour(const PoolModel& model, int i, int j, const Mix& m, PoolState& state) noexcept;

/// Something of m with velocity v (along u, v, up) falls in at a cell: its volume is shared out over the cells within
/// `radius` [m] whose surface is not above their mean; the pool takes its momentum along the surface and is pushed down
/// and so aside where it falls in.
void fall_into(const PoolModel& model, std::span<const float> floor, int i, int j, float radius, const Mix& m, Vec3f v,
               PoolState& state) noexcept;

/// Takes up to `amount` from the cells within `radius` of p whose surface reaches up to p less the radius; each gives
/// in proportion to what it holds. The caller books it.
Mix draw_off(const PoolModel& model, std::span<const float> floor, Vec3d p, double radius, std::int64_t amount,
             PoolState& state) noexcept;

Mix content(const PoolModel& model, const PoolState& state) noexcept;  ///< what the cells and `held` hold

void add_to_hash(core::Hasher& hasher, const PoolState& state) noexcept;

}  // namespace trocar::fluids
