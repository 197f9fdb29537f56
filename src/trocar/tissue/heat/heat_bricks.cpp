#include <algorithm>

#include <trocar/tissue/heat/heat_bricks.hpp>

namespace trocar::tissue::heat {
namespace {

std::uint32_t hash_of(const BrickKey& key) noexcept {
  std::uint64_t h = std::uint64_t(std::uint32_t(key.i)) * 0x9e3779b97f4a7c15ull;
  h ^= std::uint64_t(std::uint32_t(key.j)) * 0xbf58476d1ce4e5b9ull;
  h ^= std::uint64_t(std::uint32_t(key.k)) * 0x94d049bb133111ebull;
  h ^= std::uint64_t(std::uint32_t(key.body.code())) * 0xd6e8feb86659fd93ull;
  return std::uint32_t((h ^ (h >> 32)) * 0x9e3779b1u >> 7);
}

const BrickKey& key_of(const HeatState& s, std::int32_t entry) noexcept {
  return entry >= 0 ? s.key[entry] : s.empty[kEmpty - entry];
}

void insert(const HeatModel& m, HeatState& s, std::int32_t entry) noexcept {
  std::uint32_t at = hash_of(key_of(s, entry)) & m.index_mask;
  while (s.index[at] != kNobody) at = (at + 1) & m.index_mask;
  s.index[at] = entry;
}

void index_anew(const HeatModel& m, HeatState& s) noexcept {
  std::fill(s.index.begin(), s.index.end(), kNobody);
  for (int b = 0; b < m.bricks; ++b)
    if (s.slot[b] != HeatState::kUnused) insert(m, s, b);
  for (int e = 0; e < s.empties; ++e) insert(m, s, kEmpty - e);
}

void remember_empty(const HeatModel& m, const BrickKey& key, HeatState& s) noexcept {
  if (s.empties < m.voids) {
    s.empty[s.empties] = key;
    insert(m, s, kEmpty - s.empties++);
    return;
  }
  s.empty[s.oldest] = key;
  s.oldest = (s.oldest + 1) % m.voids;
  index_anew(m, s);
}

Vec3d corner_of(const HeatModel& m, const BrickKey& key) noexcept {
  const double side = kBrickSide * m.cell;
  return {side * key.i, side * key.j, side * key.k};
}

/// A brick as it was made: nothing has happened to it. kNobody: no tissue there, or no room.
std::int32_t make_brick(const HeatModel& m, const BrickKey& key, const TissueShape& shape, HeatState& s,
                        std::uint32_t& flags) noexcept {
  std::int32_t brick = 0;
  while (brick < m.bricks && s.slot[brick] != HeatState::kUnused) ++brick;
  if (brick == m.bricks) {
    flags |= HeatReport::kBricksFull;
    return kNobody;
  }
  const std::size_t first = std::size_t(brick) * kBrickCells;
  const std::span<std::uint8_t> cells(s.cells.data() + first, kBrickCells);
  std::fill(cells.begin(), cells.end(), std::uint8_t(HeatState::kTissue));
  if (shape.fill) shape.fill(shape.context, key.body, corner_of(m, key), m.cell, cells);
  bool any = false;
  for (std::uint8_t& c : cells) {
    c = c ? HeatState::kTissue : 0;
    any = any || c;
  }
  if (!any) {
    remember_empty(m, key, s);
    return kNobody;
  }
  std::fill_n(s.water.begin() + first, kBrickCells, 1.0f);
  std::fill_n(s.damage.begin() + first, kBrickCells, 0.0f);
  std::fill_n(s.peak.begin() + first, kBrickCells, 0.0f);
  s.key[brick] = key;
  s.slot[brick] = HeatState::kAsleep;
  insert(m, s, brick);
  return brick;
}

void conduct_anew(const HeatModel& m, std::int32_t slot, HeatState& s) noexcept {
  const std::size_t cell = std::size_t(slot) * kBrickCells, at = std::size_t(s.owner[slot]) * kBrickCells;
  for (int c = 0; c < kBrickCells; ++c) s.conduction[cell + c] = conduction_of(m, s.cells[at + c], s.water[at + c]);
}

/// Puts a sleeping brick into a slot. -1: no room.
std::int32_t rouse(const HeatModel& m, std::int32_t brick, HeatState& s, std::uint32_t& flags) noexcept {
  std::int32_t slot = 0;
  while (slot < m.awake && s.owner[slot] >= 0) ++slot;
  if (slot == m.awake) {
    flags |= HeatReport::kAwakeFull;
    return -1;
  }
  s.owner[slot] = brick;
  s.slot[brick] = slot;
  const std::size_t cell = std::size_t(slot) * kBrickCells, at = std::size_t(brick) * kBrickCells;
  for (int c = 0; c < kBrickCells; ++c)
    s.u[cell + c] = s.next[cell + c] = s.cells[at + c] & HeatState::kTissue ? 0.0f : gas_of(m);
  std::fill_n(s.heat.begin() + cell, kBrickCells, 0.0f);
  std::fill_n(s.due.begin() + cell, kBrickCells, 0.0f);
  conduct_anew(m, slot, s);
  s.hottest[slot] = 0;
  s.marks[slot] = 0;
  std::fill_n(s.link.begin() + std::size_t(slot) * kNeighbours, kNeighbours, std::int32_t(kUnknown));
  return slot;
}

/// Whether nothing has happened in a brick that one would notice later.
bool is_as_new(const HeatModel& m, std::int32_t brick, const HeatState& s) noexcept {
  const std::size_t at = std::size_t(brick) * kBrickCells;
  for (int c = 0; c < kBrickCells; ++c)
    if (s.damage[at + c] > float(m.forget) || s.water[at + c] < 0.999f) return false;
  return true;
}

/// @return whether it was forgotten altogether
bool fall_asleep(const HeatModel& m, std::int32_t slot, HeatState& s) noexcept {
  const std::int32_t brick = s.owner[slot];
  const std::size_t cell = std::size_t(slot) * kBrickCells, at = std::size_t(brick) * kBrickCells;
  double left = 0;
  for (int c = 0; c < kBrickCells; ++c)
    if (s.cells[at + c] & HeatState::kTissue)
      left += m.heat_per_volume(double(s.water[at + c])) * double(s.u[cell + c]);
  s.books.dropped += left * m.cell_volume();
  s.owner[slot] = -1;
  s.slot[brick] = HeatState::kAsleep;
  if (!is_as_new(m, brick, s)) return false;
  s.slot[brick] = HeatState::kUnused;
  return true;
}

/// No neighbour would wake it again at once.
bool is_left_alone(const HeatState& s, std::int32_t slot) noexcept {
  for (int f = 0; f < kNeighbours; ++f) {
    const std::int32_t other = s.link[std::size_t(slot) * kNeighbours + f];
    if (other >= 0 && (s.marks[other] & (kWarmFace << (f ^ 1)))) return false;
  }
  return true;
}

bool send_to_sleep(const HeatModel& m, HeatState& s) noexcept {
  bool any = false, forgotten = false;
  for (int n = 0; n < s.listed; ++n) {
    const std::int32_t slot = s.order[n];
    if (s.hottest[slot] > float(m.sleep) || (s.marks[slot] & kFed) || !is_left_alone(s, slot)) continue;
    forgotten = fall_asleep(m, slot, s) || forgotten;
    any = true;
  }
  if (forgotten) index_anew(m, s);
  return any;
}

bool wake_neighbours(const HeatModel& m, const TissueShape& shape, HeatState& s, std::uint32_t& flags) noexcept {
  bool any = false;
  for (int n = 0; n < s.listed; ++n) {
    const std::int32_t slot = s.order[n];
    if (s.owner[slot] < 0) continue;
    for (int f = 0; f < kNeighbours; ++f) {
      if (!(s.marks[slot] & (kWarmFace << f))) continue;
      const std::int32_t link = s.link[std::size_t(slot) * kNeighbours + f];
      if (link >= 0 || link == kEmpty) continue;
      any = true;  // woken, or known to be empty from now on
      wake(m, neighbour(s.key[s.owner[slot]], f), shape, s, flags);
    }
  }
  return any;
}

/// @return whether bricks joined that a source has woken within the step
bool list_awake(const HeatModel& m, HeatState& s) noexcept {
  const std::int32_t before = s.listed;
  s.listed = 0;
  for (std::int32_t slot = 0; slot < m.awake; ++slot)
    if (s.owner[slot] >= 0) s.order[s.listed++] = slot;
  return s.listed != before;
}

void link_awake(const HeatModel& m, HeatState& s) noexcept {
  for (int n = 0; n < s.listed; ++n) {
    const std::int32_t slot = s.order[n];
    for (int f = 0; f < kNeighbours; ++f) {
      const std::int32_t other = find(m, s, neighbour(s.key[s.owner[slot]], f));
      std::int32_t link = kUnknown;
      if (other >= 0) link = s.slot[other] >= 0 ? s.slot[other] : kSleeping - other;
      if (other <= kEmpty) link = kEmpty;
      s.link[std::size_t(slot) * kNeighbours + f] = link;
    }
  }
}

}  // namespace

void index_bricks(const HeatModel& m, HeatState& s) noexcept { index_anew(m, s); }

BrickKey neighbour(const BrickKey& key, int face) noexcept {
  const int by = face & 1 ? 1 : -1;
  return {key.body, key.i + (face / 2 == 0 ? by : 0), key.j + (face / 2 == 1 ? by : 0),
          key.k + (face / 2 == 2 ? by : 0)};
}

std::int32_t find(const HeatModel& m, const HeatState& s, const BrickKey& key) noexcept {
  std::uint32_t at = hash_of(key) & m.index_mask;
  while (s.index[at] != kNobody && !(key_of(s, s.index[at]) == key)) at = (at + 1) & m.index_mask;
  return s.index[at];
}

std::int32_t wake(const HeatModel& m, const BrickKey& key, const TissueShape& shape, HeatState& s,
                  std::uint32_t& flags) noexcept {
  std::int32_t brick = find(m, s, key);
  if (brick == kNobody) brick = make_brick(m, key, shape, s, flags);
  if (brick < 0) return -1;
  return s.slot[brick] >= 0 ? s.slot[brick] : rouse(m, brick, s, flags);
}

void settle(const HeatModel& m, const TissueShape& shape, HeatState& s, std::uint32_t& flags) noexcept {
  for (int n = 0; n < s.listed; ++n) {
    const std::int32_t slot = s.order[n];
    if (s.marks[slot] & kDried) conduct_anew(m, slot, s);
  }
  bool changed = send_to_sleep(m, s);
  for (std::uint8_t& marks : s.marks) marks = std::uint8_t(marks & ~kFed);
  changed = wake_neighbours(m, shape, s, flags) || changed;
  changed = list_awake(m, s) || changed;
  if (changed) link_awake(m, s);
}

}  // namespace trocar::tissue::heat
