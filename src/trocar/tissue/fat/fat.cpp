#include <algorithm>

#include <trocar/tissue/fat/fat.hpp>

namespace trocar::tissue {
namespace {

constexpr double kBody = 37, kCoagulates = 60, kBoils = 100;  // [C]
constexpr double kFatCapacity = 2700;                         // of fat with its water [J/kg K]
constexpr double kFatWaterBoils = 2.26e6;                     // of water [J/kg]
constexpr double kCools = 6;                                  // [s] of a lobule by conduction, l^2 / pi^2 a
constexpr std::uint64_t kTurns = 8;                           // ticks until a septum is looked at again

double warms_to(const FatModel& m, const Lobule& l) noexcept {
  const double capacity = m.mass * kFatCapacity;
  return kBody + l.heat / capacity;
}

/// Septa of this turn are damaged by how far they are open.
void part_septa(const FatModel& m, FatState& s) noexcept {
  const double dt = double(kTurns) * m.network.tick;
  for (int i = int(s.tick % kTurns); i < m.septa(); i += int(kTurns)) {
    const double before = 1 - double(spring_scale(m.network, s.network, i));
    if (before >= 1) continue;
    const double rest = double(m.network.spring_rest[std::size_t(i)]);
    double opening = rest * spring_strain(m.network, s.network, i);
    const Lobule& a = s.lobules[std::size_t(septum_end(m, i, 0))];
    const Lobule& b = s.lobules[std::size_t(septum_end(m, i, 1))];
    if (a.coagulated() || b.coagulated()) opening /= kCoagulatedStrength;
    const CohesiveLaw& law = m.serosal[std::size_t(i)] ? m.serosa : m.septum;
    const double after = damage_after(law, before, opening, dt);
    if (after > before) set_spring_scale(m.network, s.network, i, after < 1 ? float(1 - after) : 0.0f);
  }
}

void cool(const FatModel& m, FatState& s) noexcept {
  const double keeps = 1 - double(kTurns) * m.network.tick / kCools;
  for (std::size_t i = s.tick % kTurns; i < s.lobules.size(); i += kTurns) {
    Lobule& l = s.lobules[i];
    l.heat = l.heat > 1e-6 ? keeps * l.heat : 0.0;
  }
}

void vanish(const FatModel& m, int lobule, FatState& s) noexcept {
  s.lobules[std::size_t(lobule)].marks |= Lobule::kBoiledAway;
  ++s.gone;
  for (int i = 0; i < m.septa(); ++i)
    if (septum_end(m, i, 0) == lobule || septum_end(m, i, 1) == lobule) cut_spring(m.network, s.network, i);
}

}  // namespace

StepReport advance(const FatModel& m, std::span<const NodeLoad> loads, std::span<Vec3f> reactions, FatState& s,
                   FatWork& w) noexcept {
  part_septa(m, s);
  cool(m, s);
  ++s.tick;
  return advance(m.network, loads, reactions, s.network, w.network);
}

Vec3d position(const FatModel& m, const FatState& s, int lobule) noexcept {
  return position(m.network, s.network, lobule);
}
Vec3d velocity(const FatModel& m, const FatState& s, int lobule) noexcept {
  return velocity(m.network, s.network, lobule);
}

double holding(const FatModel& m, const FatState& s, int septum) noexcept {
  return double(spring_scale(m.network, s.network, septum));
}

int sever(const FatModel& m, const geometry::BladePlane& blade, FatState& s) noexcept {
  int severed = 0;
  for (int i = 0; i < m.septa(); ++i) {
    if (holding(m, s, i) <= 0) continue;
    if (!blade.crosses(position(m, s, septum_end(m, i, 0)), position(m, s, septum_end(m, i, 1)))) continue;
    cut_spring(m.network, s.network, i);
    ++severed;
  }
  s.severed += severed;
  return severed;
}

double warm(const FatModel& m, int lobule, double joules, FatState& s) noexcept {
  Lobule& l = s.lobules[std::size_t(lobule)];
  if (l.gone() || !(joules > 0)) return 0;
  const double most = m.mass * kFatCapacity * (kBoils - kBody), water = m.material.water * m.mass;
  l.heat += joules;
  if (warms_to(m, l) >= kCoagulates) l.marks |= Lobule::kCoagulated;
  if (l.heat <= most) return 0;
  const double boils = std::min((l.heat - most) / kFatWaterBoils, water - l.boiled);
  l.heat = most;
  l.boiled += boils;
  if (l.boiled >= water) vanish(m, lobule, s);
  return boils;
}

double temperature(const FatModel& m, const FatState& s, int lobule) noexcept {
  return warms_to(m, s.lobules[std::size_t(lobule)]);
}

double heat_to_go(const FatModel& m) noexcept {
  return m.mass * (kFatCapacity * (kBoils - kBody) + m.material.water * kFatWaterBoils);
}

}  // namespace trocar::tissue
