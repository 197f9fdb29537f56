#include <algorithm>
#include <cmath>

#include <trocar/core/field_hash.hpp>
#include <trocar/core/require.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/tissue/heat/heat_bricks.hpp>

namespace trocar::tissue {
namespace {

using core::require;

constexpr double kGasConstant = 8.314462618;  ///< [J/mol K]
constexpr double kFarthest = 10;              ///< places beyond are refused [m]

bool positive(double v) { return v > 0 && v < 1e12; }
bool not_negative(double v) { return v >= 0 && v < 1e12; }
bool near(Vec3d p) noexcept {
  return std::fabs(p.x) < kFarthest && std::fabs(p.y) < kFarthest && std::fabs(p.z) < kFarthest;
}

/// Cell of a coordinate, and brick of a cell: rounded down, below zero too.
int cell_of(double x, double cell) noexcept { return int(std::floor(x / cell)); }
int brick_of(int cell) noexcept { return cell >= 0 ? cell / kBrickSide : -((kBrickSide - 1 - cell) / kBrickSide); }

/// From p to the segment ab.
double squared_distance(Vec3d a, Vec3d b, Vec3d p) noexcept {
  const Vec3d along = b - a, off = p - a;
  const double l2 = dot(along, along);
  const double share = l2 > 0 ? std::clamp(dot(off, along) / l2, 0.0, 1.0) : 0.0;
  const Vec3d d = off - share * along;
  return dot(d, d);
}

/// What a source touches: cells and their weights in work.
struct SourceReach {
  int cells = 0;
  double weight = 0, conducting = 0;  ///< sums of weights, of what conducts
  double resisting = 0, warmth = 0;   ///< of weight / conductance, of weight x u
  float hottest = 0;
};

struct CellBox {
  int low[3], high[3];
};
CellBox around(const HeatSource& q, double far, double cell) noexcept {
  CellBox box{};
  for (int c = 0; c < 3; ++c) {
    box.low[c] = cell_of(std::min(q.a[c], q.b[c]) - far, cell);
    box.high[c] = cell_of(std::max(q.a[c], q.b[c]) + far, cell);
  }
  return box;
}

class Gathering {
 public:
  Gathering(const HeatModel& m, const HeatSource& q, const TissueShape& shape, HeatState& s, HeatWork& w,
            std::uint32_t& flags) noexcept
      : m_model(m), m_source(q), m_state(s), m_work(w), m_flags(flags) {
    m_radius = std::max(q.radius, m.cell);
    m_far = m_radius * q.reach;
    const CellBox box = around(q, m_far + 0.5 * m.cell, m.cell);
    for (int k = brick_of(box.low[2]); k <= brick_of(box.high[2]); ++k)
      for (int j = brick_of(box.low[1]); j <= brick_of(box.high[1]); ++j)
        for (int i = brick_of(box.low[0]); i <= brick_of(box.high[0]); ++i) {
          const std::int32_t slot = heat::wake(m, {q.body, i, j, k}, shape, s, flags);
          if (slot >= 0) gather({q.body, i, j, k}, slot, box);
        }
  }
  const SourceReach& result() const noexcept { return m_reach; }

 private:
  void gather(const BrickKey& key, std::int32_t slot, const CellBox& box) noexcept {
    const int first[3] = {key.i * kBrickSide, key.j * kBrickSide, key.k * kBrickSide};
    int low[3], high[3];
    for (int c = 0; c < 3; ++c) {
      low[c] = std::max(box.low[c] - first[c], 0);
      high[c] = std::min(box.high[c] - first[c], kBrickSide - 1);
    }
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int x = low[0]; x <= high[0]; ++x)
          take(slot, (z * kBrickSide + y) * kBrickSide + x,
               m_model.cell * Vec3d{first[0] + x + 0.5, first[1] + y + 0.5, first[2] + z + 0.5});
  }

  void take(std::int32_t slot, int cell, Vec3d middle) noexcept {
    const std::size_t at = std::size_t(m_state.owner[slot]) * kBrickCells + cell;
    if (!(m_state.cells[at] & HeatState::kTissue)) return;
    const double weight = weight_at(squared_distance(m_source.a, m_source.b, middle));
    if (!(weight > 0)) return;
    if (m_reach.cells == kReachCells) {
      m_flags |= HeatReport::kReachFull;
      return;
    }
    const double conducts = m_source.by_current ? current_through(slot, cell) : 1.0;
    const float u = m_state.u[std::size_t(slot) * kBrickCells + cell];
    m_work.touched[m_reach.cells] = slot * kBrickCells + cell;
    m_work.weight[m_reach.cells++] = float(weight * conducts);
    m_reach.weight += weight;
    m_reach.conducting += weight * conducts;
    m_reach.resisting += weight / conducts;
    m_reach.warmth += weight * double(u);
    m_reach.hottest = std::max(m_reach.hottest, u);
  }

  /// By the water at the step's beginning: what the step has done so far depends on the order of bricks.
  double current_through(std::int32_t slot, int cell) const noexcept {
    const double k = double(m_state.conduction[std::size_t(slot) * kBrickCells + cell]);
    const double wet =
        std::clamp((k - m_model.dry_conductivity) / (m_model.conductivity - m_model.dry_conductivity), 0.0, 1.0);
    return m_model.dry_current + (1 - m_model.dry_current) * wet;
  }
  double weight_at(double d2) const noexcept {
    const double edge = std::clamp((m_far - std::sqrt(d2)) / m_model.cell + 0.5, 0.0, 1.0);
    const double r2 = m_radius * m_radius, share = d2 > r2 ? r2 / d2 : 1.0;
    return edge * (share * share);
  }

  const HeatModel& m_model;
  const HeatSource& m_source;
  HeatState& m_state;
  HeatWork& m_work;
  std::uint32_t& m_flags;
  double m_radius = 0, m_far = 0;
  SourceReach m_reach;
};

bool is_sound(const HeatSource& q) noexcept {
  return near(q.a) && near(q.b) && q.radius >= 1e-4 && q.radius <= 5e-3 && q.reach >= 1 && q.reach <= 4 &&
         std::fabs(q.watts) <= 1000 && length(q.b - q.a) <= 0.05;
}

void give(const HeatModel& m, const HeatSource& q, int index, const TissueShape& shape, HeatState& s, HeatWork& w,
          HeatReport& report) noexcept {
  const auto wrong = [&](HeatReport::Flag flag) {
    report.flags |= flag;
    if (report.first_bad < 0) report.first_bad = index;
  };
  if (!is_sound(q)) return wrong(HeatReport::kBadSource);
  if (!(q.watts < 0 || q.watts > 0)) return;
  const SourceReach reach = Gathering(m, q, shape, s, w, report.flags).result();
  if (!(reach.conducting > 0)) return wrong(HeatReport::kMissed);
  const double joules = q.watts * m.tick;
  const float each = float(joules / (m.cell_volume() * reach.conducting));
  for (int n = 0; n < reach.cells; ++n) {
    const std::int32_t slot = w.touched[n] / kBrickCells, cell = w.touched[n] % kBrickCells;
    s.heat[w.touched[n]] += each * w.weight[n];
    s.marks[slot] = std::uint8_t(s.marks[slot] | heat::kFed);
    std::uint8_t& kind = s.cells[std::size_t(s.owner[slot]) * kBrickCells + cell];
    if (q.bursts) kind = std::uint8_t(kind | HeatState::kSparked);
  }
  report.given += joules;
  s.books.given += joules;
}

/// Whole cell and share towards the next of a coordinate, from cell middle to cell middle.
struct Place1 {
  int cell;
  float share;
};
Place1 place(double x, double cell) noexcept {
  const double q = x / cell - 0.5, whole = std::floor(q);
  return {int(whole), float(q - whole)};
}

}  // namespace

double damage_rate(const HeatDescription& d, double celsius) noexcept {
  if (!(celsius >= d.damage_from)) return 0;
  return portable::exp(d.damage_log_rate - d.damage_energy / (kGasConstant * (celsius + 273.15)));
}

HeatModel build(const HeatDescription& d, double tick) {
  require(d.cell >= 0.05e-3 && d.cell <= 0.75e-3, "heat: cells of 0.05 to 0.75 mm");
  require(d.bricks >= 1 && d.bricks <= 8192 && d.awake >= 1 && d.awake <= d.bricks, "heat: 1 to 8192 bricks");
  require(d.voids >= 1 && d.voids <= 8192 && d.period >= 1 && d.period <= 64, "heat: voids and period");
  require(tick > 0 && tick <= 0.1, "heat: tick");
  require(positive(d.density) && positive(d.heat_capacity) && positive(d.latent_heat), "heat: tissue's figures");
  require(d.dry_conductivity > 0 && d.conductivity > d.dry_conductivity && d.conductivity < 1e3, "heat: conductivity");
  require(d.water >= 0.01 && d.water < 1 && d.water * d.water_capacity < 0.95 * d.heat_capacity, "heat: water");
  require(not_negative(d.perfusion) && not_negative(d.surface) && not_negative(d.burst), "heat: rates");
  require(d.gas > -50 && d.gas < 100 && d.ceiling > 200 && d.ceiling < 3000, "heat: temperatures");
  require(d.damage_from > kBodyHeat && d.damage_from < 100 && positive(d.damage_energy), "heat: damage");
  require(std::fabs(d.damage_log_rate) < 700 && d.dry_current > 0 && d.dry_current <= 1, "heat: damage and current");
  require(d.sleep > 0 && d.wake > d.sleep && d.wake < 10 && d.forget >= 0, "heat: waking above sleeping above 0 K");
  require(d.surface * d.cell < 0.9 * d.dry_conductivity, "heat: the surface passes on more than tissue does");
  HeatModel m;
  static_cast<HeatDescription&>(m) = d;
  m.tick = tick;
  m.step = tick * d.period;
  const double fastest = d.conductivity / m.heat_per_volume(0);
  require(6 * fastest * m.step / (d.cell * d.cell) + d.perfusion * m.step * m.wet_heat() / m.heat_per_volume(0) <= 0.9,
          "heat: a step passes on more than a cell has; larger cells or a shorter period");
  const int steps = int((HeatModel::kRateUpTo - d.damage_from) * HeatModel::kRateSteps) + 2;
  for (int i = 0; i < steps; ++i)
    m.rate.push_back(float(std::min(damage_rate(d, d.damage_from + double(i) / HeatModel::kRateSteps), 1e9)));
  std::uint32_t size = 16;
  while (size < 4u * std::uint32_t(d.bricks + d.voids)) size *= 2;
  m.index_mask = size - 1;
  return m;
}

HeatState cold(const HeatModel& m) {
  HeatState s;
  const std::size_t bricks = std::size_t(m.bricks), awake = std::size_t(m.awake);
  s.key.resize(bricks);
  s.slot.assign(bricks, HeatState::kUnused);
  s.cells.resize(bricks * kBrickCells);
  s.water.resize(bricks * kBrickCells);
  s.damage.resize(bricks * kBrickCells);
  s.peak.resize(bricks * kBrickCells);
  s.owner.assign(awake, -1);
  s.u.resize(awake * kBrickCells);
  s.next.resize(awake * kBrickCells);
  s.heat.resize(awake * kBrickCells);
  s.due.resize(awake * kBrickCells);
  s.conduction.resize(awake * kBrickCells);
  s.hottest.resize(awake);
  s.marks.resize(awake);
  s.link.resize(awake * heat::kNeighbours);
  s.order.resize(awake);
  s.empty.resize(std::size_t(m.voids));
  s.index.assign(std::size_t(m.index_mask) + 1, heat::kNobody);
  return s;
}

HeatWork make_work(const HeatModel&) {
  HeatWork w;
  w.u.resize(HeatWork::kPadded);
  w.conduction.resize(HeatWork::kPadded);
  w.boiled.resize(kBrickCells);
  w.touched.resize(kReachCells);
  w.weight.resize(kReachCells);
  return w;
}

HeatContact probe(const HeatModel& m, const HeatSource& source, const TissueShape& shape, HeatState& s,
                  HeatWork& w) noexcept {
  HeatContact contact;
  HeatSource q = source;
  q.watts = 0;
  if (!is_sound(q)) return contact;
  std::uint32_t flags = 0;
  const SourceReach reach = Gathering(m, q, shape, s, w, flags).result();
  if (!(reach.weight > 0)) return contact;
  contact.volume = reach.weight * m.cell_volume();
  contact.conductance = reach.weight / reach.resisting;
  contact.temperature = kBodyHeat + reach.warmth / reach.weight;
  contact.hottest = kBodyHeat + double(reach.hottest);
  return contact;
}

HeatReport advance(const HeatModel& m, std::span<const HeatSource> sources, const TissueShape& shape, HeatState& s,
                   HeatWork& w) noexcept {
  HeatReport report;
  for (std::size_t n = 0; n < sources.size(); ++n) give(m, sources[n], int(n), shape, s, w, report);
  const int part = int(s.tick++ % std::uint64_t(m.period));
  heat::step_bricks(m, s.listed * part / m.period, s.listed * (part + 1) / m.period, s, w, report);
  if (part + 1 == m.period) {
    s.u.swap(s.next);
    s.heat.swap(s.due);
    heat::settle(m, shape, s, report.flags);
  }
  return report;
}

double stored(const HeatModel& m, const HeatState& s) noexcept {
  double sum = 0;
  for (int slot = 0; slot < m.awake; ++slot) {
    if (s.owner[slot] < 0) continue;
    const std::size_t cells = std::size_t(slot) * kBrickCells, at = std::size_t(s.owner[slot]) * kBrickCells;
    for (int c = 0; c < kBrickCells; ++c)
      if (s.cells[at + c] & HeatState::kTissue)
        sum += m.heat_per_volume(double(s.water[at + c])) * double(s.u[cells + c]) + double(s.heat[cells + c]) +
               double(s.due[cells + c]);
  }
  return sum * m.cell_volume();
}

int bricks_used(const HeatState& s) noexcept {
  return int(s.slot.size()) - int(std::count(s.slot.begin(), s.slot.end(), HeatState::kUnused));
}
int bricks_awake(const HeatState& s) noexcept {
  return int(s.owner.size()) - int(std::count(s.owner.begin(), s.owner.end(), -1));
}

HeatReading reading(const HeatModel& m, const HeatState& s, BodyId body, Vec3d at) noexcept {
  HeatReading r;
  if (!near(at)) return r;
  const Place1 px = place(at.x, m.cell), py = place(at.y, m.cell), pz = place(at.z, m.cell);
  float all = 0, u = 0, peak = 0, alive = 0, water = 0, parted = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int x = px.cell + (corner & 1), y = py.cell + ((corner >> 1) & 1), z = pz.cell + (corner >> 2);
    const float weight = ((corner & 1) ? px.share : 1 - px.share) * ((corner & 2) ? py.share : 1 - py.share) *
                         ((corner & 4) ? pz.share : 1 - pz.share);
    const BrickKey key{body, brick_of(x), brick_of(y), brick_of(z)};
    const std::int32_t brick = heat::find(m, s, key);
    if (brick <= heat::kEmpty) continue;
    if (brick < 0) {  // nothing is known of it: as it always was
      all += weight, alive += weight, water += weight;
      continue;
    }
    const int c =
        ((z - key.k * kBrickSide) * kBrickSide + (y - key.j * kBrickSide)) * kBrickSide + (x - key.i * kBrickSide);
    const std::size_t cell = std::size_t(brick) * kBrickCells + c;
    if (!(s.cells[cell] & HeatState::kTissue)) continue;
    all += weight;
    if (s.slot[brick] >= 0) u += weight * s.u[std::size_t(s.slot[brick]) * kBrickCells + c];
    peak += weight * s.peak[cell];
    alive += weight * float(portable::exp(-double(s.damage[cell])));
    water += weight * s.water[cell];
    if (s.cells[cell] & HeatState::kParted) parted += weight;
  }
  if (!(all > 1e-6f)) return r;
  r.temperature = float(kBodyHeat) + u / all;
  r.peak = float(kBodyHeat) + peak / all;
  r.coagulated = 1 - alive / all;
  r.water = water / all;
  r.parted = parted / all;
  return r;
}

bool heated_box(const HeatModel& m, const HeatState& s, BodyId body, Vec3d& low, Vec3d& high) noexcept {
  bool any = false;
  const double side = kBrickSide * m.cell;
  for (int b = 0; b < m.bricks; ++b) {
    if (s.slot[b] == HeatState::kUnused || s.key[b].body != body) continue;
    const Vec3d corner{side * s.key[b].i, side * s.key[b].j, side * s.key[b].k};
    for (int c = 0; c < 3; ++c) {
      low[c] = any ? std::min(low[c], corner[c]) : corner[c];
      high[c] = any ? std::max(high[c], corner[c] + side) : corner[c] + side;
    }
    any = true;
  }
  return any;
}

double spread(const HeatModel& m, const HeatState& s, BodyId body, std::span<const Treated> treated) noexcept {
  double farthest2 = 0;
  for (std::size_t b = 0; b < s.slot.size() && !treated.empty(); ++b) {
    if (s.slot[b] == HeatState::kUnused || s.key[b].body != body) continue;
    const BrickKey& key = s.key[b];
    for (int c = 0; c < kBrickCells; ++c) {
      const std::size_t cell = b * kBrickCells + std::size_t(c);
      if (!(s.cells[cell] & HeatState::kTissue) || s.damage[cell] < 1) continue;
      const Vec3d middle = m.cell * Vec3d{key.i * kBrickSide + c % kBrickSide + 0.5,
                                          key.j * kBrickSide + c / kBrickSide % kBrickSide + 0.5,
                                          key.k * kBrickSide + c / (kBrickSide * kBrickSide) + 0.5};
      double nearest2 = 1e30;
      for (const Treated& t : treated) nearest2 = std::min(nearest2, squared_distance(t.a, t.b, middle));
      farthest2 = std::max(farthest2, nearest2);
    }
  }
  return std::sqrt(farthest2);
}

void add_to_hash(core::Hasher& hasher, const HeatState& s) noexcept {
  const auto add = [&](const auto& values, std::size_t first, std::size_t count) {
    for (std::size_t i = first; i < first + count; ++i) hasher.add(values[i]);
  };
  for (std::size_t b = 0; b < s.slot.size(); ++b) {
    hasher.add(s.slot[b]);
    if (s.slot[b] == HeatState::kUnused) continue;
    add(s.key, b, 1);
    hasher.add(core::hash_bytes(s.cells.data() + b * kBrickCells, kBrickCells));
    for (const auto* values : {&s.water, &s.damage, &s.peak})
      hasher.add(core::hash_bytes(values->data() + b * kBrickCells, kBrickCells * sizeof(float)));
  }
  for (std::size_t a = 0; a < s.owner.size(); ++a) {
    hasher.add(s.owner[a]);
    if (s.owner[a] < 0) continue;
    for (const auto* values : {&s.u, &s.next, &s.heat, &s.due, &s.conduction})
      hasher.add(core::hash_bytes(values->data() + a * kBrickCells, kBrickCells * sizeof(float)));
    hasher.add(s.hottest[a]);
    hasher.add(s.marks[a]);
    add(s.link, a * heat::kNeighbours, heat::kNeighbours);
  }
  hasher.add(s.listed);
  add(s.order, 0, std::size_t(s.listed));
  hasher.add(s.empties);
  hasher.add(s.oldest);
  add(s.empty, 0, std::size_t(s.empties));
  hasher.add(s.books);
  hasher.add(s.tick);
}

void add_to_hash(core::Hasher& h, const HeatModel& m) noexcept { core::add_fields(h, m); }

}  // namespace trocar::tissue
