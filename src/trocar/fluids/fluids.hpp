// All fluids of a scene: drops, pool, smoke, the suction-irrigators that add and take, and the account of it all.
//
//   begin_tick   irrigation and bleeding become drops; drops predict where they go
//                ... the caller answers State.droplets' questions (droplets.hpp) ...
//   finish_tick  drops land, run, fall in; suction takes; the pool and the smoke move
//
//   FluidsModel m = build(description);  FluidsState s = initial_state(m);  FluidsWork w = make_work(m);
//   begin_tick(m, input, s, w);
//   for (int k = 0; k < w.droplets.questions; ++k) w.droplets.answers[k] = ...;
//   FluidsReport r = finish_tick(m, input, s, w);      // r.tools[0].sucked, w.droplets.impacts, balanced(s.ledger)
//
// Pool and smoke work on some ticks only (their periods), the forces between drops too; which ones follows from the
// State, so a State saved at any tick continues with the same bits.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/tick.hpp>
#include <trocar/fluids/droplets.hpp>
#include <trocar/fluids/insufflator.hpp>
#include <trocar/fluids/jet.hpp>
#include <trocar/fluids/ledger.hpp>
#include <trocar/fluids/pool.hpp>
#include <trocar/fluids/report.hpp>
#include <trocar/fluids/smoke.hpp>

namespace trocar::fluids {

inline constexpr int kMostTools = 4;

struct FluidsDescription {
  PoolDescription pool;
  DropletDescription droplets;
  SmokeDescription smoke;
  Lines lines;
  Insufflator insufflator;
};

struct FluidsModel {
  PoolModel pool;
  DropletModel droplets;
  SmokeModel smoke;
  Lines lines;
  Insufflator insufflator;
  double tick = core::kTick;  ///< [s]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("pool", s.pool), v("droplets", s.droplets), v("smoke", s.smoke, core::kNotHashed),
        v("lines", s.lines, core::kNotHashed), v("insufflator", s.insufflator, core::kNotHashed),
        v("tick", s.tick, core::kNotHashed);
  }
};

struct FluidsState {
  PoolState pool;
  DropletState droplets;
  SmokeState smoke;
  Ledger ledger;
  CavityGas gas;
  std::array<double, kMostTools> irrigation_carry{}, suction_carry{};  ///< [pL]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("pool", s.pool), v("droplets", s.droplets), v("smoke", s.smoke), v("ledger", s.ledger), v("gas", s.gas),
        v("irrigation_carry", s.irrigation_carry), v("suction_carry", s.suction_carry);
  }
};

struct FluidsWork {
  PoolWork pool;
  DropletWork droplets;
  SmokeWork smoke;
  std::vector<Outlet> openings;  ///< (kMostOpenings) tools' nozzles first

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("pool", s.pool), v("droplets", s.droplets), v("smoke", s.smoke), v("openings", s.openings);
  }
};

/// One bore, two valves.
struct SuctionIrrigator {
  Vec3f tip{0, 0, 0}, direction{0, 0, -1};  ///< direction: unit, out of the bore
  Vec3f velocity{0, 0, 0};                  ///< [m/s]
  double irrigation = 0, suction = 0;       ///< valves, 0 closed .. 1 open
  bool blocked = false;                     ///< tissue within 1 mm of the port
};

/// Water that boiled somewhere in this tick.
struct Boiled {
  Vec3d at{0, 0, 0};
  double kilograms = 0;
};

struct FluidsInput {
  std::span<const Outlet> openings;         ///< bleeding; the first kMostOpenings - kMostTools count
  std::span<const SuctionIrrigator> tools;  ///< the first kMostTools count
  std::span<const Capsule> capsules;
  std::span<const float> floor;  ///< as PoolInput
  std::span<const Drain> drains;
  std::span<const Boiled> boiled;
  SmokeInput smoke;  ///< `sucked` is added to by the tools
};

struct ToolResult {
  Mix sucked;            ///< liquid in this tick [pL]
  double gas_flow = 0;   ///< out of the cavity [m^3/s]
  double thrust = 0;     ///< rho Q v of the irrigation, against `direction` on the tool [N]
  bool clogged = false;  ///< valve open, tissue on the port: nothing flows
};

struct FluidsReport {
  FluidReport report;
  std::array<ToolResult, kMostTools> tools;
};

/// @throws std::invalid_argument naming what is out of range
FluidsModel build(const FluidsDescription& description, double tick = core::kTick);
FluidsState initial_state(const FluidsModel& model);
FluidsWork make_work(const FluidsModel& model);

FluidReport begin_tick(const FluidsModel& model, const FluidsInput& input, FluidsState& state,
                       FluidsWork& work) noexcept;
FluidsReport finish_tick(const FluidsModel& model, const FluidsInput& input, FluidsState& state,
                         FluidsWork& work) noexcept;

/// The account is balanced, and drops, film and pool hold what it says they hold (adds everything up).
bool audit(const FluidsModel& model, const FluidsState& state) noexcept;

void add_to_hash(core::Hasher& hasher, const FluidsState& state) noexcept;

/// Overwrites all scratch with NaN and nonsense (tests of the law).
void poison(FluidsWork& work) noexcept;

}  // namespace trocar::fluids
