// Fluid on its way: jets that break into drops, drops that fly, cling, join, run down over moving tissue and leave a
// film there, and fall into the pool.
//
//   m dv/dt = m g - drag + forces between drops                 in flight
//   drag      3/8 rho_gas/rho Cd |v| v / r,  Cd = 24/Re + 6/(1 + sqrt(Re)) + 0.4            [White 1991]
//   forces    a damped spring of stiffness pi sigma between drops nearer than 1.5 times the sum of their radii, at rest
//             at 0.9 times it, pulling as well as pushing; implicit, equal and opposite, shared among neighbours (our
//             choice; surface tension sigma is a stiffness). Drops that interpenetrate by half become one, if that is
//             not too large.
//   running   dv/dt = g_along - v/tau - retention; tau = rho h^2 / 3 mu with h a share of the radius (the film's mean
//             speed [Nusselt 1916]); retention: a drop stays until m g sin > width sigma (cos rec - cos adv)
//             [Furmidge 1962]; it falls off below an overhang when heavier than a share of 2 pi r sigma [Tate 1864]
//   film      a running drop leaves thickness x 2r x way of itself behind, as long as the film there is not full, and
//             changes as much with what is there already: water washes blood away (our choice)
//   landing   a drop does not bounce: it gives its momentum across the surface to it, which adds up to rho Q v in a jet
//
// A tick has two halves, because drops do not know tissue: plan() says where drops want to go, the caller answers with
// the planes they meet, resolve() moves them.
//
//   plan(model, openings, ...);                       // emits, pulls, predicts; work.asking lists who needs an answer
//   for (k < work.questions) work.answers[k] = nearest(work.asking[k]);   // all of them; body -1 where nothing is met
//   resolve(...);                                     // lands, runs down, films, falls in
//
// Drops on surfaces move on every fourth tick, a quarter of them on each. Forces between drops are looked at on every
// fourth tick (those in flight) and on every eighth (those on surfaces, among themselves, half of the pairs each time);
// films and the pool's surface at similar rates (our choice, for speed). Descriptions made for crowds may ask for
// longer periods (set_crowd_level_of_detail()).
//
// Volumes are whole picolitres (mix.hpp). Arrays are by drop, 0 .. count - 1; a drop that ends leaves its place to the
// last one. `id` names a drop for as long as it lives.
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
#include <trocar/fluids/pool.hpp>
#include <trocar/fluids/report.hpp>

namespace trocar::fluids {

inline constexpr int kMostOpenings = 64;

struct DropletDescription {
  int capacity = 8192;                   ///< drops at a time, up to 65536
  int film_cells = 0;                    ///< places on tissue that can carry a film
  std::int64_t film_capacity = 200'000;  ///< of a place [pL]: 50 um on 4 mm^2
  Vec3d gravity{0, 0, -9.81};            ///< [m/s^2]
  Densities density;
  double viscosity = 3.5e-3;                  ///< mu, of blood [Pa s]
  double surface_tension = 0.056;             ///< sigma, of blood [N/m]
  double gas_density = 1.75;                  ///< carbon dioxide, 12 mmHg, 37 C [kg/m^3]; 0 = nothing to fly through
  double gas_viscosity = 1.6e-5;              ///< [Pa s]
  std::int64_t smallest = 20'000;             ///< a drop below it becomes film [pL]: 0.17 mm radius
  std::int64_t largest = 8'000'000;           ///< no drop is born larger, or grows so in flight [pL]: 1.24 mm radius
  std::int64_t largest_running = 40'000'000;  ///< nor on a surface, where they become rivulets [pL]: 2.1 mm
  double film_thickness = 20e-6;              ///< left behind by a running drop [m]
  double hysteresis = 0.08;                   ///< cos receding - cos advancing, on wet tissue
  double running_height = 0.3;                ///< h over r of a running drop
  double overhang = 0.5;                      ///< share of 2 pi r sigma that holds a hanging drop
  double splash = 80;                         ///< Weber number above which a drop throws up smaller ones from the pool
  int pair_period = 4;  ///< ticks between two looks at the forces between flying drops: 2, 4, 8 or 16
  int run_period = 4;   ///< ticks between two steps of a drop on a surface, each with a question: 2, 4, 8 or 16
  int pair_parts = 2;   ///< looks at the forces between drops on surfaces until each pair has been looked at: 2 or 8
  int fly_period = 1;   ///< ticks between two questions of a drop in flight, for so many ahead: 1, 2, 4 or 8
};

struct DropletModel : DropletDescription {
  double tick = core::kTick;  ///< [s]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("capacity", s.capacity), v("film_cells", s.film_cells), v("film_capacity", s.film_capacity),
        v("gravity", s.gravity, core::kNotHashed), v("density", s.density, core::kNotHashed),
        v("viscosity", s.viscosity, core::kNotHashed), v("surface_tension", s.surface_tension, core::kNotHashed),
        v("gas_density", s.gas_density, core::kNotHashed), v("gas_viscosity", s.gas_viscosity, core::kNotHashed),
        v("smallest", s.smallest, core::kNotHashed), v("largest", s.largest, core::kNotHashed),
        v("largest_running", s.largest_running, core::kNotHashed),
        v("film_thickness", s.film_thickness, core::kNotHashed), v("hysteresis", s.hysteresis, core::kNotHashed),
        v("running_height", s.running_height, core::kNotHashed), v("overhang", s.overhang, core::kNotHashed),
        v("splash", s.splash, core::kNotHashed), v("pair_period", s.pair_period, core::kNotHashed),
        v("run_period", s.run_period, core::kNotHashed), v("pair_parts", s.pair_parts, core::kNotHashed),
        v("fly_period", s.fly_period, core::kNotHashed), v("tick", s.tick, core::kNotHashed);
  }
};

/// What a running drop runs on: points x with normal . x = offset.
struct Ground {
  Vec3f normal{0, 0, 1};
  float offset = 0;
  Vec3f velocity{0, 0, 0};  ///< of the surface [m/s]
  std::int32_t film = -1;   ///< place of the film below the drop, -1 = none

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("normal", s.normal), v("offset", s.offset), v("velocity", s.velocity), v("film", s.film);
  }
};

struct SmallMix {  ///< of a drop or a film's place [pL]
  std::int32_t blood = 0, saline = 0, bile = 0;
  std::int64_t total() const { return std::int64_t(blood) + saline + bile; }

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("blood", s.blood), v("saline", s.saline), v("bile", s.bile);
  }
};
inline Mix widened(const SmallMix& m) { return {m.blood, m.saline, m.bile}; }

struct DropletState {
  std::int32_t count = 0;
  std::uint32_t next_id = 1;
  std::vector<float> x, y, z, vx, vy, vz, radius;  ///< (capacity) [m], [m/s]
  std::vector<std::int32_t> body;                  ///< (capacity) it runs on; -1 = it flies
  std::vector<Ground> ground;                      ///< (capacity)
  std::vector<SmallMix> volume;                    ///< (capacity)
  std::vector<std::uint32_t> id;                   ///< (capacity)
  std::vector<Blood> blood;                        ///< (capacity)
  std::vector<SmallMix> film;                      ///< (film cells)
  std::vector<Blood> film_blood;                   ///< (film cells)
  std::array<Mix, kMostOpenings> forming{};        ///< what hangs at an opening until it is a drop
  std::uint64_t tick = 0;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("count", s.count), v("next_id", s.next_id), v("x", s.x, core::first(s.count)), v("y", s.y, core::first(s.count)),
        v("z", s.z, core::first(s.count)), v("vx", s.vx, core::first(s.count)), v("vy", s.vy, core::first(s.count)),
        v("vz", s.vz, core::first(s.count)), v("radius", s.radius, core::first(s.count)),
        v("body", s.body, core::first(s.count)), v("ground", s.ground, core::first(s.count)),
        v("volume", s.volume, core::first(s.count)), v("id", s.id, core::first(s.count)),
        v("blood", s.blood, core::first(s.count)), v("film", s.film), v("film_blood", s.film_blood),
        v("forming", s.forming), v("tick", s.tick);
  }
};

/// Where fluid comes out. Its index in the span is its name from tick to tick.
struct Outlet {
  Vec3f position{0, 0, 0}, direction{0, 0, 1};  ///< direction: unit
  Vec3f velocity{0, 0, 0};                      ///< of the opening itself [m/s]
  double area = 0;                              ///< [m^2]
  Mix flow;                                     ///< in this tick [pL]
  Source source = Source::kBled;
  std::int32_t film = -1;  ///< >= 0: it oozes into the film there
  float venous = 0;        ///< share of its blood that comes from veins, 0 .. 1
};

/// The caller's answer: the surface that a drop meets between its two positions, or runs on.
struct Contact {
  Vec3f point{0, 0, 0}, normal{0, 0, 1};  ///< normal: unit, out of the body
  Vec3f velocity{0, 0, 0};                ///< of the surface there [m/s]
  std::int32_t body = -1;                 ///< -1 = none
  std::int32_t film = -1;                 ///< place of the film there, -1 = none
};

/// Momentum that a drop gave to what it met, in this tick.
struct Impact {
  std::int32_t body = -1, film = -1;
  Vec3f point{0, 0, 0};
  Vec3f impulse{0, 0, 0};  ///< of the drop's motion relative to the surface [N s]
  float mass = 0;          ///< of the drop, which continues with the surface [kg]

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("body", s.body), v("film", s.film), v("point", s.point), v("impulse", s.impulse), v("mass", s.mass);
  }
};

struct DropletWork {
  std::vector<float> to_x, to_y, to_z;  ///< (capacity) where one of `movers` would fly to in the tick
  std::vector<std::int32_t> asking;     ///< who needs an answer; the first `questions`
  std::vector<Contact> answers;         ///< (capacity) one for each of `asking`, all for the caller to fill
  int questions = 0;
  int ways = 1;  ///< a drop in flight is asked for on its way through so many ticks or half as many: ways_of()
  std::vector<std::int32_t> overfull;  ///< (kFilmQuestions) places of film that run over; the first `film_questions`
  std::vector<Contact> film_answers;   ///< the surface at each of them; body -1 = let it wait
  int film_questions = 0;
  std::vector<Impact> impacts;  ///< (capacity) the first `impact_count`
  int impact_count = 0;
  std::vector<std::int32_t> movers;       ///< (capacity) who moves in this tick, ascending; the first `mover_count`
  std::vector<std::int32_t> near;         ///< (capacity) bits of capsules that each of `movers` is near to
  std::vector<std::int32_t> question_of;  ///< (capacity) index of the question of each of `movers`, or why none
  int mover_count = 0;
  bool emptied = false;                     ///< some drop may have no volume left
  std::vector<std::uint32_t> bucket_first;  ///< the grid of the forces between drops
  std::vector<std::uint64_t> filled;        ///< a bit a cell of it
  std::vector<std::int32_t> chosen, sorted, cell_of, own_cell;
  std::vector<float> sx, sy, sz, svx, svy, svz, sr, sm, jx, jy, jz;
  std::vector<std::int32_t> joined;      ///< (capacity) drop that it became part of, or -1
  std::vector<std::int32_t> neighbours;  ///< (capacity)
  struct Pair {
    std::int32_t first, second;
  };
  std::vector<Pair> pairs;  ///< (16 capacity) within reach; the first pair_count
  int pair_count = 0;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("to_x", s.to_x), v("to_y", s.to_y), v("to_z", s.to_z), v("asking", s.asking), v("answers", s.answers),
        v("questions", s.questions), v("ways", s.ways), v("overfull", s.overfull), v("film_answers", s.film_answers),
        v("film_questions", s.film_questions), v("impacts", s.impacts), v("impact_count", s.impact_count),
        v("movers", s.movers), v("near", s.near), v("question_of", s.question_of), v("mover_count", s.mover_count),
        v("emptied", s.emptied), v("bucket_first", s.bucket_first), v("filled", s.filled), v("chosen", s.chosen),
        v("sorted", s.sorted), v("cell_of", s.cell_of), v("own_cell", s.own_cell), v("sx", s.sx), v("sy", s.sy),
        v("sz", s.sz), v("svx", s.svx), v("svy", s.svy), v("svz", s.svz), v("sr", s.sr), v("sm", s.sm), v("jx", s.jx),
        v("jy", s.jy), v("jz", s.jz), v("joined", s.joined), v("neighbours", s.neighbours), v("pairs", s.pairs),
        v("pair_count", s.pair_count);
  }
};

inline constexpr int kFilmQuestions = 64;

/// So far ahead that it is about a centimetre: quick drops half as many ticks. to_x ... is the end of the first. Our
/// choice
/// @param quick  [m/s]
inline int ways_of(const DropletWork& work, Vec3f velocity, float quick = 1.2f) noexcept {
  return work.ways < 8 || dot(velocity, velocity) < quick * quick ? work.ways : work.ways / 2;
}

/// What thousands of drops at a time need to be affordable: those in flight are asked for on every eighth tick, eight
/// ticks ahead, quick ones on every fourth; those on surfaces move on every sixteenth and are asked for on every second
/// of these turns, slow ones on slow ground on every fourth; pairs on surfaces are looked at an eighth at a time. Our
/// choice
void set_crowd_level_of_detail(DropletDescription& description) noexcept;
/// @throws std::invalid_argument naming what is out of range
DropletModel build(const DropletDescription& description, double tick = core::kTick);
DropletState no_droplets(const DropletModel& model);
DropletWork make_work(const DropletModel& model);

/// The pool below and the account, for what falls in.
struct Below {
  const PoolModel& model;
  std::span<const float> floor;
  PoolState& state;
  Ledger& ledger;
};

/// First half of a tick.
FluidReport plan(const DropletModel& model, std::span<const Outlet> openings, DropletState& state, DropletWork& work,
                 Below& below) noexcept;
/// Second half. @param capsules  instruments; drops cling to them and run down on them
FluidReport resolve(const DropletModel& model, std::span<const Capsule> capsules, DropletState& state,
                    DropletWork& work, Below& below) noexcept;

/// One more drop. @return false if there is no room or nothing of it; nothing is booked
bool add_drop(const DropletModel& model, Vec3f position, Vec3f velocity, const Mix& volume,
              DropletState& state) noexcept;
/// Takes all drops within `radius` of p in the order of the arrays, up to `amount`; the last one in part.
Mix draw_drops(const DropletModel& model, Vec3f p, float radius, std::int64_t amount, DropletState& state) noexcept;
/// Takes up to `amount` of the film at a place.
Mix take_film(std::int32_t film, std::int64_t amount, DropletState& state) noexcept;

/// Drops, and what is forming; film.
Mix drops_content(const DropletState& state) noexcept;
Mix film_content(const DropletState& state) noexcept;

float radius_of(std::int64_t picolitres) noexcept;  ///< of a ball [m]
/// The clock of Blood::born [s].
inline float now_of(const DropletModel& model, const DropletState& state) noexcept {
  return float(model.tick * double(state.tick));
}

void add_to_hash(core::Hasher& hasher, const DropletState& state) noexcept;

namespace detail {
inline constexpr std::uint32_t kPairCells = 65536;  ///< of the grid of forces between drops, by name
/// Those in flight; or a part of the pairs on surfaces: by the first one's name of two parts, by its place of eight.
struct Who {
  bool flies = true;
  std::uint32_t part = 0, parts = 1;  ///< parts: 1, 2 or 8
};
/// Forces between drops, and joining. dt: since the last time.
FluidReport pull_together(const DropletModel& model, Who who, double dt, DropletState& state,
                          DropletWork& work) noexcept;
/// Removes drops without volume, from the end.
void remove_empty(DropletState& state) noexcept;
void put_into_pool(Vec3f at, const Mix& volume, Blood blood, Place from, Below& below) noexcept;
/// Before more blood [pL] comes into the pool.
void mix_into_pool(std::int64_t volume, Blood blood, Below& below) noexcept;
}  // namespace detail

}  // namespace trocar::fluids
