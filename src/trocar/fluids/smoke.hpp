// Surgical smoke in the cavity, and the fog it leaves on the lens: a coarse grid of densities that rise, spread and
// fade, a few hundred times a second slower than anything else needs.
//
//   dD/dt = s - D/tau + K lap D - w dD/dup     tau 25 s in still gas, 5 s while gas is sucked or vented
//   seen through a distance x of it: exp(-kappa D x)
//   dF/dt = a D t_on - F/tau_f                 fog F on the lens, 0 .. 1; D at the lens, t_on how long coagulation has
//                                              been on; a warm lens takes none and loses it faster
// D is steam and smoke per volume, in milligrams of boiled water per litre of gas = g/m^3. Plumes rise at 0.1 to 0.2
// m/s: w grows with density from the one to the other (our choice), K is the eddies' (our choice). Walls let nothing
// through, so the grid's content is exactly source minus decay. Figures without a source are our choice.
//
//   SmokeModel m = build(SmokeDescription{.origin = {-0.1, -0.1, 0}, .nx = 16, .ny = 16, .nz = 12, .cell = 0.0125});
//   SmokeState s = clear_air(m);  SmokeWork w = make_work(m);
//   boil(m, tip, 2e-6, s);                                    // 2 mg of water boiled in this tick
//   advance(m, {.sucked = false}, s, w);                      // every tick; works on every 8th
//   const double clear = visibility(m, s, eye, target);
#pragma once

#include <cstdint>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/tick.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::fluids {

struct SmokeDescription {
  Vec3d origin{0, 0, 0};  ///< lowest corner of the grid, z up [m]
  int nx = 16, ny = 16, nz = 12;
  double cell = 0.0125;                      ///< [m]
  double tau_still = 25, tau_sucked = 5;     ///< [s]
  double rise_thin = 0.1, rise_thick = 0.2;  ///< [m/s]
  double thick = 10;                         ///< density at which the rise is half-way between the two [g/m^3]
  double spread = 6e-4;                      ///< K [m^2/s]
  double kappa = 0.7;      ///< extinction [m^2/g]: 60 % left after 5 s of 20 W boiling into 4 L, 70 mm away
  double fog_gain = 5e-4;  ///< a [m^3/(g s^2)]
  double fog_tau = 15;     ///< [s]
  double wipe_time = 8;    ///< [s]
  double warm_lens = 37;   ///< [C]
  double cold_lens = 20;   ///< [C] at and below which fog gathers in full
  double on_memory = 5;    ///< how fast t_on is forgotten when coagulation is off [s]
  int period = 8;          ///< ticks between two steps, a power of two
};

struct SmokeModel : SmokeDescription {
  double tick = core::kTick;  ///< [s]
  int cells() const { return nx * ny * nz; }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("origin", s.origin), v("nx", s.nx), v("ny", s.ny), v("nz", s.nz), v("cell", s.cell), v("tau_still", s.tau_still),
        v("tau_sucked", s.tau_sucked), v("rise_thin", s.rise_thin), v("rise_thick", s.rise_thick), v("thick", s.thick),
        v("spread", s.spread), v("kappa", s.kappa), v("fog_gain", s.fog_gain), v("fog_tau", s.fog_tau),
        v("wipe_time", s.wipe_time), v("warm_lens", s.warm_lens), v("cold_lens", s.cold_lens),
        v("on_memory", s.on_memory), v("period", s.period), v("tick", s.tick);
  }
};

struct SmokeState {
  std::vector<float> density;  ///< (nx * ny * nz) [g/m^3], x fastest
  double fog = 0;              ///< 0 .. 1
  double on_time = 0;          ///< t_on [s]
  double wipe_left = 0;        ///< [s] > 0 while the lens is being wiped
  std::uint64_t tick = 0;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("density", s.density), v("fog", s.fog), v("on_time", s.on_time), v("wipe_left", s.wipe_left), v("tick", s.tick);
  }
};

struct SmokeWork {
  std::vector<float> rise, next;  ///< (cells)

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("rise", s.rise), v("next", s.next);
  }
};

struct SmokeInput {
  bool sucked = false;  ///< gas is being sucked or vented
  bool coagulating = false;
  bool wipe = false;             ///< the command, in its tick
  double lens_temperature = 20;  ///< [C]
  Vec3d lens{0, 0, 0};           ///< where it is [m]
};

/// @throws std::invalid_argument naming what is out of range
SmokeModel build(const SmokeDescription& description, double tick = core::kTick);
SmokeState clear_air(const SmokeModel& model);
SmokeWork make_work(const SmokeModel& model);

/// Smoke of `kilograms` of boiled water at a point (the nearest cell); what is not finite or negative is refused.
/// @return false if refused
bool boil(const SmokeModel& model, Vec3d at, double kilograms, SmokeState& state) noexcept;

void advance(const SmokeModel& model, const SmokeInput& input, SmokeState& state, SmokeWork& work) noexcept;

double density_at(const SmokeModel& model, const SmokeState& state, Vec3d at) noexcept;  ///< trilinear [g/m^3]
double content(const SmokeModel& model, const SmokeState& state) noexcept;               ///< [kg]
/// exp(-kappa int D dx) between two points, sampled at half cells.
double visibility(const SmokeModel& model, const SmokeState& state, Vec3d from, Vec3d to) noexcept;

void add_to_hash(core::Hasher& hasher, const SmokeState& state) noexcept;

}  // namespace trocar::fluids
