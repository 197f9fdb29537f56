// A brick's step: gathered with one layer of what lies around it, then row by row. Loops are plain and of fixed length,
// so that any compiler vectorises them to the same bits.
#include <algorithm>
#include <array>

#include <trocar/tissue/base/float4.hpp>
#include <trocar/tissue/heat/heat_bricks.hpp>

namespace trocar::tissue::heat {
namespace {

constexpr int kSide = HeatWork::kSide;

constexpr int padded(int x, int y, int z) { return ((z + 1) * kSide + (y + 1)) * kSide + (x + 1); }
constexpr int inner(int x, int y, int z) { return (z * kBrickSide + y) * kBrickSide + x; }

/// The n-th cell of a face, 0 .. 63: in its own brick, the one across, and the place around the brick for that.
struct FaceCell {
  int own, across, outside;
};
constexpr FaceCell find_face_cell(int face, int n) {
  const int a = n % kBrickSide, b = n / kBrickSide, last = kBrickSide - 1;
  const int own = face & 1 ? last : 0, across = face & 1 ? 0 : last, outside = face & 1 ? kBrickSide : -1;
  if (face / 2 == 0) return {inner(own, a, b), inner(across, a, b), padded(outside, a, b)};
  if (face / 2 == 1) return {inner(a, own, b), inner(a, across, b), padded(a, outside, b)};
  return {inner(a, b, own), inner(a, b, across), padded(a, b, outside)};
}
using Face = std::array<FaceCell, kBrickSide * kBrickSide>;
constexpr std::array<Face, kNeighbours> find_faces() {
  std::array<Face, kNeighbours> faces{};
  for (int f = 0; f < kNeighbours; ++f)
    for (int n = 0; n < kBrickSide * kBrickSide; ++n) faces[f][n] = find_face_cell(f, n);
  return faces;
}
constexpr std::array<Face, kNeighbours> kFaces = find_faces();

void gather_own(const HeatState& s, std::int32_t slot, HeatWork& w) noexcept {
  const float* u = s.u.data() + std::size_t(slot) * kBrickCells;
  const float* k = s.conduction.data() + std::size_t(slot) * kBrickCells;
  for (int z = 0; z < kBrickSide; ++z)
    for (int y = 0; y < kBrickSide; ++y) {
      std::copy_n(u + inner(0, y, z), kBrickSide, w.u.data() + padded(0, y, z));
      std::copy_n(k + inner(0, y, z), kBrickSide, w.conduction.data() + padded(0, y, z));
    }
}

/// What lies across a face: an awake brick, one at 37 C, gas, or tissue of which nothing is known.
void gather_face(const HeatModel& m, const HeatState& s, std::int32_t link, int face, HeatWork& w) noexcept {
  float *u = w.u.data(), *k = w.conduction.data();
  if (link >= 0) {
    const float* its_u = s.u.data() + std::size_t(link) * kBrickCells;
    const float* its_k = s.conduction.data() + std::size_t(link) * kBrickCells;
    for (const FaceCell& f : kFaces[face]) u[f.outside] = its_u[f.across], k[f.outside] = its_k[f.across];
    return;
  }
  const float gas = gas_of(m), open = conduction_of(m, 0, 1), wet = conduction_of(m, HeatState::kTissue, 1);
  for (const FaceCell& f : kFaces[face]) {
    u[f.outside] = link == kEmpty ? gas : 0.0f;
    k[f.outside] = link == kEmpty ? open : wet;
  }
  if (link > kSleeping) return;
  const std::size_t brick = std::size_t(kSleeping - link) * kBrickCells;
  for (const FaceCell& f : kFaces[face]) {
    k[f.outside] = conduction_of(m, s.cells[brick + f.across], s.water[brick + f.across]);
    if (!(s.cells[brick + f.across] & HeatState::kTissue)) u[f.outside] = gas;
  }
}

/// Heat that a face passes on to tissue that is not awake, in this step [J/m^3 of a cell].
double given_away(const HeatModel& m, const HeatState& s, std::int32_t slot, int face, const HeatWork& w) noexcept {
  const std::int32_t link = s.link[std::size_t(slot) * kNeighbours + face];
  if (link >= 0 || link == kEmpty) return 0;
  const std::size_t brick = std::size_t(s.owner[slot]) * kBrickCells, cells = std::size_t(slot) * kBrickCells;
  double sum = 0;
  for (const FaceCell& f : kFaces[face]) {
    if (!(s.cells[brick + f.own] & HeatState::kTissue)) continue;
    if (link <= kSleeping && !(s.cells[std::size_t(kSleeping - link) * kBrickCells + f.across] & HeatState::kTissue))
      continue;  // gas: the surface's
    sum +=
        double(std::min(s.conduction[cells + f.own], w.conduction[f.outside]) * (s.u[cells + f.own] - w.u[f.outside]));
  }
  return sum * (m.step / (m.cell * m.cell));
}

/// Constants of a step in float.
struct Factors {
  float flow, blood, dry, water, boil, per_boil, boiling, ceiling, gas, open;
};
Factors factors(const HeatModel& m) noexcept {
  return {.flow = float(m.step / (m.cell * m.cell)),
          .blood = float(m.wet_heat() * m.perfusion * m.step),
          .dry = float(m.heat_per_volume(0)),
          .water = float(m.water_heat()),
          .boil = float(m.boiling_heat()),
          .per_boil = float(1 / m.boiling_heat()),
          .boiling = float(kBoilingHeat - kBodyHeat),
          .ceiling = float(m.ceiling - kBodyHeat),
          .gas = gas_of(m),
          .open = conduction_of(m, 0, 0)};
}

/// Sums over a brick, a lane for every fourth cell of x, so that their order is that of no instruction set.
struct Lanes {
  Float4 moved{}, blood{}, boiled{}, burnt{};
  Float4 hottest{};  ///< largest |u|
};
double total(Float4 lanes) noexcept { return (double(lanes[0]) + lanes[1]) + (double(lanes[2]) + lanes[3]); }

/// Where four cells are. u, k: in the gathered brick.
struct Four {
  const float *u, *k, *heat, *damage;
  float *water, *peak, *next, *boiled;
};

void store4(float* p, Float4 a) noexcept { std::memcpy(p, &a, sizeof a); }
Float4 all(float a) noexcept { return Float4{a, a, a, a}; }
Float4 least(Float4 a, Float4 b) noexcept { return a < b ? a : b; }
Float4 most(Float4 a, Float4 b) noexcept { return a > b ? a : b; }
Float4 magnitude(Float4 a) noexcept { return (Float4)((Int4)a & 0x7fffffff); }

inline Float4 flow_from(const Four& r, Float4 u, Float4 k, int to) noexcept {
  return least(k, load4(r.k + to)) * (load4(r.u + to) - u);
}

inline void step_four(const Factors& f, const Four& r, Lanes& sum) noexcept {
  constexpr int kUp = kSide, kOver = kSide * kSide;
  const Float4 zero{}, u = load4(r.u), k = load4(r.k), w = load4(r.water);
  const Int4 tissue = k > f.open;
  const Float4 flow = (flow_from(r, u, k, -1) + flow_from(r, u, k, 1)) +
                      (flow_from(r, u, k, -kUp) + flow_from(r, u, k, kUp)) +
                      (flow_from(r, u, k, -kOver) + flow_from(r, u, k, kOver));
  const Float4 moved = pick(tissue, f.flow * flow, zero);
  const Float4 alive = most(1 - load4(r.damage), zero);
  const Float4 blood = pick(tissue, (f.blood * alive) * u, zero);
  const Float4 c = f.dry + f.water * w;
  const Float4 heated = u + ((moved - blood) + load4(r.heat)) / c;
  const Float4 over = most(c * (heated - f.boiling), zero);
  const Float4 boils = pick(tissue, least(over * f.per_boil, w), zero);
  const Float4 c_left = c - f.water * boils;
  const Float4 left = least(heated, all(f.boiling)) + (over - boils * f.boil) / c_left;
  const Float4 burns = most(left - f.ceiling, zero), v = left - burns;
  const Float4 kept = pick(magnitude(v) < 1e-9f, zero, v);  // never denormal
  store4(r.next, pick(tissue, kept, all(f.gas)));
  store4(r.water, w - boils);
  store4(r.peak, most(load4(r.peak), pick(tissue, kept, zero)));
  store4(r.boiled, boils);
  sum.hottest = most(sum.hottest, magnitude(pick(tissue, kept, zero)));
  sum.moved += moved;
  sum.blood += blood;
  sum.boiled += boils;
  sum.burnt += pick(tissue, burns * c_left, zero);
}

Lanes step_cells(const HeatModel& m, std::int32_t slot, HeatState& s, HeatWork& w) noexcept {
  const Factors f = factors(m);
  const std::size_t cells = std::size_t(slot) * kBrickCells, at = std::size_t(s.owner[slot]) * kBrickCells;
  Lanes sum;
  for (int z = 0; z < kBrickSide; ++z)
    for (int y = 0; y < kBrickSide; ++y)
      for (int x = 0; x < kBrickSide; x += 4) {
        const int own = inner(x, y, z), around = padded(x, y, z);
        step_four(f,
                  {.u = w.u.data() + around,
                   .k = w.conduction.data() + around,
                   .heat = s.due.data() + cells + own,
                   .damage = s.damage.data() + at + own,
                   .water = s.water.data() + at + own,
                   .peak = s.peak.data() + at + own,
                   .next = s.next.data() + cells + own,
                   .boiled = w.boiled.data() + own},
                  sum);
      }
  return sum;
}

std::uint8_t warm_faces(const HeatModel& m, const float* u, const std::uint8_t* cells) noexcept {
  const float warm = float(m.wake);
  std::uint8_t marks = 0;
  for (int face = 0; face < kNeighbours; ++face)
    for (const FaceCell& f : kFaces[face])
      if (u[f.own] > warm && (cells[f.own] & HeatState::kTissue)) {
        marks = std::uint8_t(marks | kWarmFace << face);
        break;
      }
  return marks;
}

/// Damage of a step at the temperatures with which it ends.
void do_damage(const HeatModel& m, const float* u, const std::uint8_t* cells, float* damage) noexcept {
  const float from = float(m.damage_from - kBodyHeat), dt = float(m.step);
  const float last = float(m.rate.size() - 1) - 0.001f;
  for (int c = 0; c < kBrickCells; ++c) {
    if (!(u[c] > from) || !(cells[c] & HeatState::kTissue)) continue;
    const float in_steps = std::min((u[c] - from) * HeatModel::kRateSteps, last);
    const int i = int(in_steps);
    const float share = in_steps - float(i);
    const float rate = m.rate[i] + share * (m.rate[i + 1] - m.rate[i]);
    damage[c] = std::min(damage[c] + dt * rate, 1000.0f);
  }
}

/// Marks what bursts, and says where the middle of what boils is.
Vec3d look_at_boiling(const HeatModel& m, const BrickKey& key, const float* boiled, const float* water,
                      std::uint8_t* cells) noexcept {
  const float burst = float(m.burst * m.step);
  Vec3d moment{0, 0, 0};
  double sum = 0;
  for (int c = 0; c < kBrickCells; ++c) {
    if (!(boiled[c] > 0)) continue;
    if ((cells[c] & HeatState::kSparked) && boiled[c] > burst && water[c] < 0.95f)
      cells[c] = std::uint8_t(cells[c] | HeatState::kParted);
    const Vec3d middle{c % kBrickSide + 0.5, c / kBrickSide % kBrickSide + 0.5, c / (kBrickSide * kBrickSide) + 0.5};
    moment += double(boiled[c]) * middle;
    sum += double(boiled[c]);
  }
  const Vec3d corner{double(key.i) * kBrickSide, double(key.j) * kBrickSide, double(key.k) * kBrickSide};
  return m.cell * (corner + moment / std::max(sum, 1e-30));
}

void forget_sparks(std::uint8_t* cells) noexcept {
  for (int c = 0; c < kBrickCells; ++c) cells[c] = std::uint8_t(cells[c] & ~HeatState::kSparked);
}

/// Notes what a step has done to a brick: warmth, damage, what boils.
void look_at(const HeatModel& m, std::int32_t slot, double boiled, HeatState& s, HeatWork& w, HeatReport& report,
             double& most_boiled) noexcept {
  const BrickKey& key = s.key[s.owner[slot]];
  const std::size_t at = std::size_t(s.owner[slot]) * kBrickCells;
  const float* u = s.next.data() + std::size_t(slot) * kBrickCells;
  std::uint8_t* cells = s.cells.data() + at;
  const bool warm = double(s.hottest[slot]) > m.wake;
  s.marks[slot] = std::uint8_t((s.marks[slot] & kFed) | (warm ? warm_faces(m, u, cells) : 0));
  if (double(s.hottest[slot]) > m.damage_from - kBodyHeat) do_damage(m, u, cells, s.damage.data() + at);
  if (boiled > 0) {
    s.marks[slot] = std::uint8_t(s.marks[slot] | kDried);
    const Vec3d where = look_at_boiling(m, key, w.boiled.data(), s.water.data() + at, cells);
    if (boiled > most_boiled) {
      most_boiled = boiled;
      report.boiled_body = key.body;
      report.boiled_at = where;
    }
  }
  forget_sparks(cells);
}

void step_brick(const HeatModel& m, std::int32_t slot, HeatState& s, HeatWork& w, HeatReport& report,
                double& most_boiled) noexcept {
  gather_own(s, slot, w);
  double away = 0;
  for (int f = 0; f < kNeighbours; ++f) {
    gather_face(m, s, s.link[std::size_t(slot) * kNeighbours + f], f, w);
    away += given_away(m, s, slot, f, w);
  }
  const Lanes sum = step_cells(m, slot, s, w);
  std::fill_n(s.due.begin() + std::size_t(slot) * kBrickCells, kBrickCells, 0.0f);

  const double volume = m.cell_volume(), boiled = total(sum.boiled);
  s.books.conducted += away * volume;
  s.books.surface += (-total(sum.moved) - away) * volume;  // what awake bricks give each other cancels in the sum
  s.books.perfused += total(sum.blood) * volume;
  s.books.burnt += total(sum.burnt) * volume;
  s.books.boiled += boiled * (m.boiling_heat() + m.water_heat() * (kBoilingHeat - kBodyHeat)) * volume;
  const double steam = boiled * m.density * m.water * volume;
  s.books.steam += steam;
  report.boiled += steam;
  s.hottest[slot] = std::max(std::max(sum.hottest[0], sum.hottest[1]), std::max(sum.hottest[2], sum.hottest[3]));
  look_at(m, slot, boiled, s, w, report, most_boiled);
}

}  // namespace

void step_bricks(const HeatModel& m, int first, int last, HeatState& s, HeatWork& w, HeatReport& report) noexcept {
  double most_boiled = 0;
  for (int n = first; n < last; ++n) step_brick(m, s.order[n], s, w, report, most_boiled);
  report.worked += last - first;
}

}  // namespace trocar::tissue::heat
