// Heat in tissue where energy is applied: cells of at most 0.75 mm in bricks of 8^3, in material (rest) coordinates, so
// that heat and what it leaves behind go with the tissue as it moves. Organs' own nodes are too coarse for spreads of
// two or three millimetres.
//
//   C(w) du/dt = div k(w) grad u + q - C p s (u)        u = T - 37 C, w the share of the tissue's water that is left
//   boiling    what would lift a cell beyond 100 C evaporates water instead until there is none: rho 0.7 L a volume;
//              the steam takes its own sensible heat along, so that T stays at 100 C until dry
//   surface    h (u - u_gas) through faces between tissue and what is not tissue
//   perfusion  [Pennes 1948], s = 1 - damage, none once coagulated
//   damage     dO/dt = A exp(-Ea / R T) = exp(ln A - Ea / R T) above 43 C [Henriques & Moritz 1947; liver's A and Ea:
//              Jacques et al. 1996]; 1 - exp(-O) is the share that is coagulated
// Explicit in time, conservative, bounded at any power: heat passes between two cells by the smaller of their
// conductivities, what is above a ceiling burns off. C, k of drying tissue: the water's part goes linearly.
//
// Bricks. The caller says once per brick which of its cells are tissue (TissueShape). A brick is *awake* (its
// temperature computed) from when energy is applied in it or warmth reaches its border; it falls *asleep* when it is
// cool again, keeping its water, damage and highest temperature, and is forgotten if there is nothing to keep. All that
// goes in is booked: given = stored + boiled + burnt + perfused + surface + conducted (to bricks that are not awake) +
// dropped (by falling asleep). The account closes at the end of every step, which is every `period` ticks; within it
// each tick computes its part of the awake bricks, so that ticks cost alike; what is given in a step is taken up in the
// next, so that the order of bricks changes nothing.
//
//   HeatModel m = build(HeatDescription{});  HeatState s = cold(m);  HeatWork w = make_work(m);
//   HeatReport r = advance(m, {&source, 1}, shape, s, w);         // every tick; r.boiled is what smokes
//   HeatReading t = reading(m, s, body, place);                   // look, stiffness, shrinkage: heat_look.hpp
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <trocar/core/body_id.hpp>
#include <trocar/core/fields.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/tick.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::tissue {

inline constexpr int kBrickSide = 8;
inline constexpr int kBrickCells = kBrickSide * kBrickSide * kBrickSide;
inline constexpr double kBodyHeat = 37;      ///< [C]
inline constexpr double kBoilingHeat = 100;  ///< [C]

/// Figures without a source are our choice.
struct HeatDescription {
  double cell = 0.5e-3;  ///< [m] at most 0.75 mm
  int bricks = 256;      ///< that can be remembered
  int awake = 128;       ///< that can be computed at once
  int voids = 256;       ///< bricks without tissue that can be remembered; more are asked for again
  int period = 8;        ///< ticks in a step

  double density = 1060;             ///< [kg/m^3]
  double heat_capacity = 3600;       ///< [J/kg K]
  double conductivity = 0.5;         ///< wet [W/m K]
  double dry_conductivity = 0.2;     ///< [W/m K]
  double water = 0.7;                ///< share of the mass
  double water_capacity = 4186;      ///< [J/kg K]
  double latent_heat = 2.257e6;      ///< [J/kg]
  double perfusion = 6.4e-3;         ///< p [1/s]; liver's
  double surface = 60;               ///< h [W/m^2 K]: convection, radiation and evaporation of wet tissue at 80 C
  double gas = 37;                   ///< temperature beyond the surface [C]
  double ceiling = 400;              ///< above it tissue burns off [C]
  double damage_log_rate = 91.8023;  ///< ln A, A = 7.4e39 1/s
  double damage_energy = 257.7e3;    ///< Ea [J/mol]
  double damage_from = 43;           ///< below it cells repair what is damaged [C]
  double burst = 0.5;  ///< share of its water that a cell under a continuous wave boils off in a second as it bursts
  double dry_current = 0.06;  ///< how well dry tissue conducts current, wet = 1

  double wake = 1;       ///< a neighbour wakes when a cell at the border is this much above 37 C [K]
  double sleep = 0.5;    ///< a brick falls asleep when no cell is off 37 C by more [K]
  double forget = 0.01;  ///< largest damage that is not worth remembering
};

/// Const after build().
struct HeatModel : HeatDescription {
  static constexpr int kRateSteps = 16;     ///< of the table, a kelvin
  static constexpr double kRateUpTo = 140;  ///< [C]; above it damage is complete at once in any case
  double tick = core::kTick, step = 8e-3;   ///< [s]
  std::vector<float> rate;                  ///< damage rate from damage_from on [1/s]
  std::uint32_t index_mask = 0;             ///< size of HeatState::index - 1

  double wet_heat() const { return density * heat_capacity; }             ///< C [J/m^3 K]
  double water_heat() const { return density * water * water_capacity; }  ///< its water's part
  double boiling_heat() const { return density * water * latent_heat; }   ///< to boil all water [J/m^3]
  double heat_per_volume(double w) const { return wet_heat() - water_heat() * (1 - w); }
  double cell_volume() const { return cell * cell * cell; }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("cell", s.cell), v("density", s.density), v("heat_capacity", s.heat_capacity), v("conductivity", s.conductivity),
        v("dry_conductivity", s.dry_conductivity), v("water", s.water), v("water_capacity", s.water_capacity),
        v("latent_heat", s.latent_heat), v("perfusion", s.perfusion), v("surface", s.surface), v("gas", s.gas),
        v("ceiling", s.ceiling), v("damage_log_rate", s.damage_log_rate), v("damage_energy", s.damage_energy),
        v("damage_from", s.damage_from), v("burst", s.burst), v("dry_current", s.dry_current), v("wake", s.wake),
        v("sleep", s.sleep), v("forget", s.forget), v("tick", s.tick), v("bricks", s.bricks), v("awake", s.awake),
        v("voids", s.voids), v("period", s.period), v("step", s.step, core::kNotHashed),
        v("rate", s.rate, core::kNotHashed), v("index_mask", s.index_mask, core::kNotHashed);
  }
};

/// Place of a brick: 8 cells a side, in a body's rest frame.
struct BrickKey {
  BodyId body = BodyId::strand(0);
  std::int32_t i = 0, j = 0, k = 0;
  friend bool operator==(const BrickKey& a, const BrickKey& b) {
    return a.body == b.body && a.i == b.i && a.j == b.j && a.k == b.k;
  }

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("body", s.body), v("i", s.i), v("j", s.j), v("k", s.k);
  }
};

/// Where the energy went [J], since the beginning.
struct HeatBooks {
  double given = 0;      ///< by sources; negative ones cool
  double boiled = 0;     ///< latent and sensible heat of the steam
  double burnt = 0;      ///< above the ceiling
  double perfused = 0;   ///< taken away by blood
  double surface = 0;    ///< to the gas
  double conducted = 0;  ///< to tissue that is not awake
  double dropped = 0;    ///< what was left in bricks that fell asleep
  double steam = 0;      ///< water boiled off [kg]

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("given", s.given), v("boiled", s.boiled), v("burnt", s.burnt), v("perfused", s.perfused), v("surface", s.surface),
        v("conducted", s.conducted), v("dropped", s.dropped), v("steam", s.steam);
  }
};

struct HeatState {
  enum Slot : std::int32_t { kUnused = -2, kAsleep = -1 };
  enum Cell : std::uint8_t {
    kTissue = 1,
    kParted = 2,
    kSparked = 4
  };  ///< parted: burst by boiling; sparked: in this step

  std::vector<BrickKey> key;        ///< (bricks)
  std::vector<std::int32_t> slot;   ///< (bricks) where it is awake, or Slot
  std::vector<std::uint8_t> cells;  ///< (bricks x 512) Cell
  std::vector<float> water;         ///< (bricks x 512) share that is left
  std::vector<float> damage;        ///< (bricks x 512) O, at most 1000
  std::vector<float> peak;          ///< (bricks x 512) highest u [K]

  std::vector<std::int32_t> owner;  ///< (awake) brick, or -1
  std::vector<float> u;             ///< (awake x 512) T - 37 [K]
  std::vector<float> next;          ///< (awake x 512) u at the end of this step, as far as computed
  std::vector<float> heat;          ///< (awake x 512) given in this step, to be taken up in the next [J/m^3]
  std::vector<float> due;           ///< (awake x 512) given in the last one, as far as not taken up [J/m^3]
  std::vector<float> conduction;    ///< (awake x 512) k, of tissue; h x cell elsewhere [W/m K]
  std::vector<float> hottest;       ///< (awake) largest |u| of the step
  std::vector<std::uint8_t> marks;  ///< (awake) see heat_bricks.hpp
  std::vector<std::int32_t> link;   ///< (awake x 6) neighbours: -x +x -y +y -z +z
  std::vector<std::int32_t> order;  ///< (awake) slots of this step, ascending
  std::int32_t listed = 0;          ///< how many of them

  std::vector<BrickKey> empty;  ///< (voids) bricks without tissue
  std::int32_t empties = 0, oldest = 0;
  std::vector<std::int32_t> index;  ///< hash table of the above; follows from them
  HeatBooks books;
  std::uint64_t tick = 0;

  static constexpr bool kOwnHash = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("slot", s.slot), v("key", s.key, core::kLoose), v("cells", s.cells, core::kLoose),
        v("water", s.water, core::kLoose), v("damage", s.damage, core::kLoose), v("peak", s.peak, core::kLoose),
        v("owner", s.owner), v("u", s.u, core::kLoose), v("next", s.next, core::kLoose),
        v("heat", s.heat, core::kLoose), v("due", s.due, core::kLoose), v("conduction", s.conduction, core::kLoose),
        v("hottest", s.hottest, core::kLoose), v("marks", s.marks, core::kLoose), v("link", s.link, core::kLoose),
        v("listed", s.listed), v("order", s.order, core::first(s.listed)), v("empties", s.empties),
        v("oldest", s.oldest), v("empty", s.empty, core::first(s.empties)), v("books", s.books), v("tick", s.tick),
        v("index", s.index, core::kNotHashed);
  }
};

/// Scratch.
struct HeatWork {
  static constexpr int kSide = kBrickSide + 2, kPadded = kSide * kSide * kSide;
  std::vector<float> u, conduction;   ///< (10^3) a brick and what lies around it
  std::vector<float> boiled;          ///< (512) share of the water in this step
  std::vector<std::int32_t> touched;  ///< (kReachCells) cells of a source, slot x 512 + cell
  std::vector<float> weight;          ///< (kReachCells)

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("u", s.u), v("conduction", s.conduction), v("boiled", s.boiled), v("touched", s.touched), v("weight", s.weight);
  }
};
inline constexpr int kReachCells = 16384;  ///< most that a source can reach

/// Which cells of a brick are tissue. Asked once per brick, within a tick: no allocation, no lock.
struct TissueShape {
  const void* context = nullptr;
  /// @param corner  lowest corner of the brick in the body's rest frame [m]
  /// @param tissue  (512) to be set to 1 where a cell's middle is tissue, else 0; x fastest
  void (*fill)(const void* context, BodyId body, Vec3d corner, double cell,
               std::span<std::uint8_t> tissue) noexcept = nullptr;  ///< none: all is tissue
};

/// Energy that goes in around a segment (a point where a = b): evenly within `radius` of it, beyond with the fourth
/// power of the distance, as current that spreads from a ball heats [Organ 1976], up to `reach` radii; more where
/// tissue still has water that conducts.
struct HeatSource {
  BodyId body = BodyId::strand(0);
  std::int32_t by_current = 1;   ///< 0: contact heat (a hot tip), which does not care for water
  std::int32_t bursts = 0;       ///< 1: a continuous wave, under which tissue that boils bursts and parts
  Vec3d a{0, 0, 0}, b{0, 0, 0};  ///< rest frame [m]
  double radius = 1e-3;          ///< [m] 0.1 to 5 mm
  double reach = 2;              ///< 1 to 4
  double watts = 0;              ///< may be negative
};

/// What a source meets.
struct HeatContact {
  double volume = 0;       ///< weighted volume of tissue [m^3]; 0: nothing there
  double conductance = 1;  ///< beside wet tissue: harmonic mean, as current crosses one cell after the other
  double temperature = kBodyHeat, hottest = kBodyHeat;  ///< weighted mean, largest [C]
};

struct HeatReport {
  enum Flag : std::uint32_t {
    kFine = 0,
    kBricksFull = 1,  ///< no more bricks can be remembered: raise `bricks`; what lies there stays at 37 C
    kAwakeFull = 2,   ///< too many are warm: raise `awake`; what lies there stays at 37 C
    kBadSource = 4,   ///< not finite, out of range: left out, not booked
    kMissed = 8,      ///< a source met no tissue that could take it: left out, not booked
    kReachFull = 16,  ///< a source reaches too many cells: some of them are left out
  };
  std::uint32_t flags = kFine;
  std::int32_t first_bad = -1;  ///< index of the first source that was wrong
  double given = 0;             ///< by this tick's sources [J]
  double boiled = 0;            ///< water that boiled off in this tick [kg]
  BodyId boiled_body;
  Vec3d boiled_at{0, 0, 0};  ///< where most of it did, rest frame of that body [m]
  int worked = 0;            ///< bricks computed in this tick
};

/// @throws std::invalid_argument naming what is out of range
HeatModel build(const HeatDescription& description, double tick = core::kTick);
HeatState cold(const HeatModel& model);
HeatWork make_work(const HeatModel& model);

/// What a source would meet; wakes the bricks that it reaches.
HeatContact probe(const HeatModel& model, const HeatSource& source, const TissueShape& shape, HeatState& state,
                  HeatWork& work) noexcept;

/// One tick.
HeatReport advance(const HeatModel& model, std::span<const HeatSource> sources, const TissueShape& shape,
                   HeatState& state, HeatWork& work) noexcept;

/// Heat of what is awake, over 37 C, and what is given and not yet taken up [J]. Closes the account at a step's end.
double stored(const HeatModel& model, const HeatState& state) noexcept;
int bricks_used(const HeatState& state) noexcept;
int bricks_awake(const HeatState& state) noexcept;

/// What the tissue at a material point is like: between the middles of eight cells, those that are tissue.
struct HeatReading {
  float temperature = kBodyHeat;  ///< [C]
  float peak = kBodyHeat;         ///< highest so far, since it was last forgotten [C]
  float coagulated = 0;           ///< 1 - exp(-damage)
  float water = 1;                ///< share that is left
  float parted = 0;               ///< share of the cells around that have burst
};
HeatReading reading(const HeatModel& model, const HeatState& state, BodyId body, Vec3d at) noexcept;

/// Where an electrode was: a segment, or a point where a = b, in the body's rest frame [m].
struct Treated {
  Vec3d a, b;
};
/// How far the farthest cell that has died (O >= 1) is from the nearest of these [m]; 0 where none has.
double spread(const HeatModel& model, const HeatState& state, BodyId body, std::span<const Treated> treated) noexcept;

/// The box around all bricks of a body, for callers with many points; false if there are none.
bool heated_box(const HeatModel& model, const HeatState& state, BodyId body, Vec3d& low, Vec3d& high) noexcept;

/// A exp(-Ea / R T) [1/s], 0 below damage_from.
double damage_rate(const HeatDescription& description, double celsius) noexcept;

void add_to_hash(core::Hasher& hasher, const HeatState& state) noexcept;
void add_to_hash(core::Hasher& hasher, const HeatModel& model) noexcept;

}  // namespace trocar::tissue
