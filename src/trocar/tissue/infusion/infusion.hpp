// Fluid that a needle leaves in a lattice organ: where it lies, how it swells the tissue, and how a drug blanches it.
//
//   v_i  whole picolitres at node i, V_i its share of the cells: wanted dilation theta_i = v_i / V_i
//   J_i  dilation of the cells around node i as they stand
//   dP_i/dt = (E / tau) (theta_i - J_i),  0 <= P_i <= least(opening, 4 E theta_i)          [injected volume]
//   f_j  = sum over cells c of g_c mean(P of its corners) dV_c/dx_j                          [pore pressure]
//   g_c  = 1 up to J_c = 1 + kFullest, falls to 0 at kBursts; 0 of a cell that has torn       [torn cell]
//
// The tissue is a drained skeleton, its springs, and fluid that does not give: P is the pressure that makes just as
// much room as has flowed in, whatever the law of the springs and however near the surface. It follows with tau, as the
// body's own motion is far quicker than a syringe. Infinite linear tissue: P = (K + 4 G / 3) theta.
// A cavity opens in soft tissue at 5 E / 6 [Gent & Lindley 1959]; no pressure is higher.
// No cell is stretched by more than its fluid could account for, whatever holds it back; one that has torn is open, and
// what lies at its corners has no pressure and runs out.
// What goes in spreads as a Gaussian about the tip whose width grows with what is there, so that no more than a third
// of the tissue's own volume lies in it; a node that is full takes none. All amounts are integers: none is lost.
//
//   InfusionModel model = infusion_of(network, 30e3);
//   InfusionState state = dry(model);
//   infuse(model, nodes, tip, picolitres, spread, now, state, work);
//   swell(model, network, rows, 1e-3, state, work);              // once a tick: work.force
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/tissue/network/network.hpp>

namespace trocar::tissue {

/// Of one body. Const.
struct InfusionModel {
  std::vector<float> room;  ///< (rows) V: volume of the cells around a node that is its own [m^3]; 0: no node
  double modulus = 0;       ///< E [Pa]
  double opening = 0;       ///< 5 E / 6 [Pa]
  double finest = 0;        ///< no Gaussian is narrower than the lattice [m]

  bool there() const noexcept { return !room.empty(); }
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("room", s.room), v("modulus", s.modulus), v("opening", s.opening), v("finest", s.finest);
  }
};
/// @param youngs_modulus  of the tissue [Pa]
InfusionModel infusion_of(const NetworkModel& network, double youngs_modulus);

struct InfusionState {
  std::vector<std::int64_t> volume;  ///< (rows) [pL]
  std::vector<float> pressure;       ///< (rows) P [Pa]
  std::vector<float> dose;           ///< (rows) that a drug has ever been brought in, as a share of the room
  std::vector<std::uint32_t> since;  ///< (rows) tick when the drug came there; 0: never
  std::int64_t total = 0;            ///< sum of `volume` [pL]
  std::int32_t stirred = 0;          ///< 1: there is or was fluid, pressures are to be looked at
  std::int32_t reserved = 0;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("volume", s.volume), v("pressure", s.pressure), v("dose", s.dose), v("since", s.since), v("total", s.total),
        v("stirred", s.stirred), v("reserved", s.reserved, core::kNotHashed);
  }
};
InfusionState dry(const InfusionModel& model);

struct InfusionWork {
  std::vector<double> weight;      ///< (rows)
  std::vector<float> now;          ///< (rows) sum of the cells' volumes around a node [m^3]
  std::vector<Vec3f> force;        ///< (rows) [N]
  std::vector<std::uint8_t> torn;  ///< (rows) 1: at a cell that has torn
  std::int32_t pushes = 0;         ///< 1: `force` is of this tick
  std::int32_t tears = 0;          ///< 1: there is fluid at cells that have torn

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("weight", s.weight), v("now", s.now), v("force", s.force), v("torn", s.torn), v("pushes", s.pushes),
        v("tears", s.tears);
  }
};
InfusionWork make_work(const InfusionModel& model);

inline constexpr double kFullest = 0.5;     ///< a node holds so much of its room.                 Our choice
inline constexpr double kMeant = 0.3;       ///< the middle of a fresh Gaussian.                   Our choice
inline constexpr double kNarrowest = 3e-3;  ///< sigma of what little has flowed [m].            Our choice
inline constexpr float kBursts = 3;         ///< J of a cell on which fluid presses no more.      Our choice

/// sigma of the Gaussian that holds `volume` [m^3] with kMeant in its middle, at least kNarrowest.         [m]
double spread_of(double volume) noexcept;

/// Brings `amount` [pL] into the tissue about `tip` [m].
/// @param sigma  [m]; @param drugged  it blanches; @param tick  now, above 0
/// @return what has found room [pL]
std::int64_t infuse(const InfusionModel& model, const NodeView& nodes, Vec3d tip, std::int64_t amount, double sigma,
                    bool drugged, std::uint32_t tick, InfusionState& state, InfusionWork& work) noexcept;

/// The share that is taken of all that the tissue about a place can hold, 0 .. 1.
double filled_about(const InfusionModel& model, const NodeView& nodes, Vec3d place, double sigma,
                    const InfusionState& state) noexcept;

/// Takes up to `amount` [pL] from what lies within a few sigma of `place`.
/// @return what was there [pL]
std::int64_t let_out(const InfusionModel& model, const NodeView& nodes, Vec3d place, std::int64_t amount, double sigma,
                     InfusionState& state, InfusionWork& work) noexcept;

/// Vessels take up the `share` of what lies everywhere.
/// @return how much that was [pL]
std::int64_t absorb(double share, InfusionState& state) noexcept;

/// Takes the `share` of what lies at cells that have torn, as the last swell() has found them.
/// @param most  out: the row where most of it lay; -1: nothing did  @return how much that was [pL]
std::int64_t drain_tears(double share, const InfusionWork& work, InfusionState& state, std::int32_t& most) noexcept;

/// One tick: pressures follow what lies there, and push.
/// @param phase  (cells) as NetworkState::tet_phase; empty: all are whole
void swell(const InfusionModel& model, const NetworkModel& network, const std::vector<NodeState>& rows, double dt,
           InfusionState& state, InfusionWork& work, std::span<const std::uint8_t> phase = {}) noexcept;

/// P at the node nearest to a place, of those that hold any fluid.                                        [Pa]
double pressure_at(const NodeView& nodes, Vec3d place, const InfusionState& state) noexcept;

inline constexpr double kBlanchOnset = 20, kBlanchFull = 90, kBlanchLasts = 1800, kBlanchFades = 600;  ///< [s]
inline constexpr float kDoseFelt = 0.004f, kDoseFull = 0.03f;  ///< of the room.                 Our choice

/// How blanched a node is, 0 .. 1, `age` seconds after the drug came.
double blanched(float dose, double age) noexcept;
/// Of a row at a tick.
double blanched(const InfusionState& state, std::size_t row, std::uint64_t tick) noexcept;

}  // namespace trocar::tissue
