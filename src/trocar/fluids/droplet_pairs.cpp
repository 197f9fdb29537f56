// Forces between drops, and drops that become one; drops in flight among themselves on one tick, those on surfaces on
// another (they meet by landing). A grid of cells as wide as the farthest reach, hashed into buckets;
// drops are sorted by bucket (stable), so that everything has one order. A row of three cells is one range of the
// sorted drops, hence a drop looks at five ranges: the rest of its own row and four rows ahead.
#include <algorithm>
#include <cmath>

#include <trocar/fluids/droplets.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::fluids::detail {
namespace {

constexpr float kReach = 1.5f;                    ///< of the sum of radii
constexpr float kRest = 0.9f;                     ///< the same, where nothing pulls or pushes
constexpr float kFarthestReach = 2.6e-3f;         ///< beyond it large drops do not feel one another either [m]
constexpr float kJoin = 0.5f;                     ///< the same, where two become one
constexpr int kMostPairs = 32, kMostLooks = 256;  ///< of a drop ahead of itself

// Rows of three cells around a cell must fall into different buckets for every number of buckets used: sums of
// +-kRow and +-kLayer are at least 3 apart modulo 1024, 2048, ...
constexpr std::uint32_t kRow = 97, kLayer = 1663;

std::uint32_t buckets_for(int count) {
  std::uint32_t n = 1024;
  while (n < 2 * std::uint32_t(count)) n *= 2;
  return n;
}

struct Grid {
  std::uint32_t buckets, mask;
  float per_cell;
};

/// Of a cell; its bucket is what the mask leaves of it.
std::uint32_t name_of(const Grid& g, float x, float y, float z) {
  const auto cell = [&](float q) { return std::uint32_t(std::int32_t(q * g.per_cell + 65536.0f)); };
  return cell(x) + cell(y) * kRow + cell(z) * kLayer;
}

// Most rows around a drop in flight are empty, but few buckets are: a bit for each of kPairCells says which
// are worth a look.
void mark(std::uint32_t name, std::vector<std::uint64_t>& filled) {
  filled[(name & (kPairCells - 1)) / 64] |= std::uint64_t(1) << (name % 64);
}
/// Bits of a cell and the two behind it.
std::uint32_t row_from(std::uint32_t name, const std::vector<std::uint64_t>& filled) {
  const std::uint32_t word = (name & (kPairCells - 1)) / 64, bit = name % 64;
  const std::uint64_t low = filled[word] >> bit, high = filled[(word + 1) % (kPairCells / 64)] << 1 << (63 - bit);
  return std::uint32_t(low | high) & 7u;
}

/// Of eight parts, each takes every eighth slab of space as the home of its pairs' first drops.
constexpr std::uint32_t kSlabs = 8;
constexpr float kPerSlab = 1 / 0.010f;  // [1/m]
std::uint32_t slab_of(float x) { return std::uint32_t(std::int32_t(x * kPerSlab + 65536.0f)) & (kSlabs - 1); }
bool in_slabs(const Who& who) { return who.parts == kSlabs; }

/// A crowd's part: drops on surfaces in its slabs, or near enough to feel one that is.
int gather_slabs(const DropletState& s, Who who, DropletWork& w) {
  const float* x = s.x.data();
  std::int32_t* __restrict in = w.joined.data();
  for (int i = 0; i < s.count; ++i) {
    const std::uint32_t low = slab_of(x[i] - kFarthestReach), high = slab_of(x[i] + kFarthestReach);
    in[i] = int(low == who.part) | int(high == who.part);
  }
  int n = 0;
  for (int i = 0; i < s.count; ++i) {
    w.chosen[n] = i;
    n += int(s.body[i] >= 0) & in[i];
  }
  return n;
}

/// Who is looked at: those in flight, or those on a surface. In the order of the arrays.
int gather(const DropletState& s, Who who, DropletWork& w) {
  if (in_slabs(who)) return gather_slabs(s, who, w);
  int n = 0;
  for (int i = 0; i < s.count; ++i) {
    w.chosen[n] = i;
    n += (s.body[i] < 0) == who.flies ? 1 : 0;
  }
  return n;
}

Grid sort(const DropletModel& m, const DropletState& s, int n, DropletWork& w) {
  float largest = 1e-5f;
  for (int c = 0; c < n; ++c) largest = std::max(largest, s.radius[w.chosen[c]]);
  Grid g{buckets_for(n), 0, 1 / std::min(2 * kReach * largest, kFarthestReach)};
  g.mask = g.buckets - 1;
  std::fill_n(w.bucket_first.begin(), g.buckets + 1, 0u);
  std::fill(w.filled.begin(), w.filled.end(), 0u);
  for (int c = 0; c < n; ++c) {
    const int i = w.chosen[c];
    const std::uint32_t name = name_of(g, s.x[i], s.y[i], s.z[i]), b = name & g.mask;
    w.cell_of[c] = std::int32_t(name);
    mark(name, w.filled);
    ++w.bucket_first[b + 1];
  }
  for (std::uint32_t b = 0; b < g.buckets; ++b) w.bucket_first[b + 1] += w.bucket_first[b];
  // Filling moves each start to its end, which is the next one's start: shift back afterwards.
  for (int c = 0; c < n; ++c) w.sorted[w.bucket_first[std::uint32_t(w.cell_of[c]) & g.mask]++] = c;
  for (std::uint32_t b = g.buckets; b > 0; --b) w.bucket_first[b] = w.bucket_first[b - 1];
  w.bucket_first[0] = 0;
  for (int p = 0; p < n; ++p) {
    const int c = w.sorted[p], i = w.chosen[c];
    w.sorted[p] = i;
    w.own_cell[p] = w.cell_of[c];
    w.sx[p] = s.x[i], w.sy[p] = s.y[i], w.sz[p] = s.z[i];
    w.svx[p] = s.vx[i], w.svy[p] = s.vy[i], w.svz[p] = s.vz[i];
    w.sr[p] = s.radius[i];
    w.sm[p] = float(mass(widened(s.volume[i]), m.density));
    w.jx[p] = w.jy[p] = w.jz[p] = 0;
    w.joined[p] = -1;
    w.neighbours[p] = 0;
  }
  w.pair_count = 0;
  return g;
}

struct Law {
  float k, dt;
  std::int64_t largest;
};

/// Impulse on p towards q, given to one and taken from the other. Divided by the larger of their numbers of
/// neighbours, so that many together never turn a drop's motion round.
void pull(const Law& law, int p, int q, DropletWork& w) {
  const float dx = w.sx[q] - w.sx[p], dy = w.sy[q] - w.sy[p], dz = w.sz[q] - w.sz[p];
  const float d2 = (dx * dx + dy * dy) + dz * dz, sum = w.sr[p] + w.sr[q];
  if (!(d2 > 1e-14f)) return;
  const float d = std::sqrt(d2), per_d = 1 / d;
  const float apart = ((dx * (w.svx[q] - w.svx[p]) + dy * (w.svy[q] - w.svy[p])) + dz * (w.svz[q] - w.svz[p])) * per_d;
  const float stretch = d - kRest * sum;
  const float fading = (kReach * sum - d) / ((kReach - kRest) * sum);
  const float weight = fading < 1 ? fading : 1.0f;
  const float both = w.sm[p] * w.sm[q] / (w.sm[p] + w.sm[q]);
  const float damping = law.dt * law.k + std::sqrt(law.k * both);
  const float others = float(std::max(w.neighbours[p], w.neighbours[q]));
  const float impulse =
      weight * law.dt * (law.k * stretch + damping * apart) * both * per_d / ((both + law.dt * damping) * others);
  const float jx = impulse * dx, jy = impulse * dy, jz = impulse * dz;
  w.jx[p] += jx, w.jy[p] += jy, w.jz[p] += jz;
  w.jx[q] -= jx, w.jy[q] -= jy, w.jz[q] -= jz;
}

/// Notes that q becomes part of p, if they are deep in one another and may.
void try_to_join(const Law& law, const DropletState& s, int p, int q, DropletWork& w) {
  const float dx = w.sx[q] - w.sx[p], dy = w.sy[q] - w.sy[p], dz = w.sz[q] - w.sz[p], sum = w.sr[p] + w.sr[q];
  if ((dx * dx + dy * dy) + dz * dz >= (kJoin * kJoin) * (sum * sum)) return;
  const int i = w.sorted[p], j = w.sorted[q];
  if (w.joined[p] >= 0 || w.joined[q] >= 0 || s.body[i] != s.body[j]) return;
  if (s.volume[i].total() + s.volume[j].total() <= law.largest) w.joined[q] = p, w.joined[p] = p;
}

/// Drops q in [first, last) as neighbours of p. Every one is written down, the next over it if it is not one.
struct Budget {
  int end, looks = kMostLooks;
};
void look(int p, std::uint32_t first, std::uint32_t last, DropletWork& w, Budget& left) {
  const float x = w.sx[p], y = w.sy[p], z = w.sz[p], r = w.sr[p];
  const std::uint32_t some = std::min(last, first + std::uint32_t(left.looks));
  if (some <= first) return;
  left.looks -= int(some - first);
  const float *sx = w.sx.data(), *sy = w.sy.data(), *sz = w.sz.data(), *sr = w.sr.data();
  DropletWork::Pair* pairs = w.pairs.data();
  int n = w.pair_count;
  for (std::uint32_t q = first; q < some && n < left.end; ++q) {
    const float dx = sx[q] - x, dy = sy[q] - y, dz = sz[q] - z, sum = r + sr[q];
    const float d2 = (dx * dx + dy * dy) + dz * dz, reach2 = (kReach * kReach) * (sum * sum);
    pairs[n] = {p, std::int32_t(q)};
    n += int(d2 < reach2) & int(d2 < kFarthestReach * kFarthestReach);
  }
  w.pair_count = n;
}

/// The buckets a, a + 1, ..., a + n - 1, which may go round the end.
void look_at_buckets(const Grid& g, int p, std::uint32_t a, std::uint32_t n, DropletWork& w, Budget& left) {
  a &= g.mask;
  const std::uint32_t end = a + n;
  look(p, w.bucket_first[a], w.bucket_first[std::min(end, g.buckets)], w, left);
  if (end > g.buckets) look(p, 0, w.bucket_first[end - g.buckets], w, left);
}

void look_around(const Grid& g, int p, DropletWork& w, Budget& left) {
  const auto own = std::uint32_t(w.own_cell[p]);
  look(p, std::uint32_t(p) + 1, w.bucket_first[(own & g.mask) + 1], w, left);
  const std::uint32_t beside = row_from(own - 1, w.filled) >> 2, ahead = row_from(own + kRow - 1, w.filled);
  const std::uint32_t back = row_from(own + kLayer - kRow - 1, w.filled), above = row_from(own + kLayer - 1, w.filled);
  const std::uint32_t front = row_from(own + kLayer + kRow - 1, w.filled);
  if ((beside | ahead | back | above | front) == 0) return;
  if (beside != 0) look_at_buckets(g, p, own + 1, 1, w, left);
  if (ahead != 0) look_at_buckets(g, p, own + kRow - 1, 3, w, left);
  if (back != 0) look_at_buckets(g, p, own + kLayer - kRow - 1, 3, w, left);
  if (above != 0) look_at_buckets(g, p, own + kLayer - 1, 3, w, left);
  if (front != 0) look_at_buckets(g, p, own + kLayer + kRow - 1, 3, w, left);
}

/// Drop j becomes part of drop i. Flying ones meet half-way; on a surface the first stays where it is.
void join(const DropletModel& m, int i, int j, DropletState& s) {
  const float mi = float(mass(widened(s.volume[i]), m.density)), mj = float(mass(widened(s.volume[j]), m.density));
  const float part = mj / (mi + mj);
  s.vx[i] += part * (s.vx[j] - s.vx[i]), s.vy[i] += part * (s.vy[j] - s.vy[i]), s.vz[i] += part * (s.vz[j] - s.vz[i]);
  if (s.body[i] < 0) s.x[i] += part * (s.x[j] - s.x[i]), s.y[i] += part * (s.y[j] - s.y[i]);
  if (s.body[i] < 0) s.z[i] += part * (s.z[j] - s.z[i]);
  s.blood[i] = mean(s.blood[i], s.volume[i].blood, s.blood[j], s.volume[j].blood);
  s.volume[i].blood += s.volume[j].blood, s.volume[i].saline += s.volume[j].saline;
  s.volume[i].bile += s.volume[j].bile;
  s.volume[j] = {};
  s.radius[i] = radius_of(s.volume[i].total());
}

}  // namespace

FluidReport pull_together(const DropletModel& m, Who who, double dt, DropletState& s, DropletWork& w) noexcept {
  FluidReport report;
  const int n = gather(s, who, w);
  if (n < 2) return report;
  const Grid g = sort(m, s, n, w);
  const Law law{float(portable::pi * m.surface_tension), float(dt), who.flies ? m.largest : m.largest_running};
  const int room = int(w.pairs.size()) - 1;
  for (int p = 0; p < n; ++p) {
    const std::uint32_t part = in_slabs(who) ? slab_of(w.sx[p]) : s.id[w.sorted[p]] & (who.parts - 1);
    if (part != who.part) continue;
    Budget left{std::min(w.pair_count + kMostPairs, room)};
    look_around(g, p, w, left);
    if (left.looks == 0 || w.pair_count >= left.end) report.note(FluidReport::kCrowded, w.sorted[p]);
  }
  for (int k = 0; k < w.pair_count; ++k) ++w.neighbours[w.pairs[k].first], ++w.neighbours[w.pairs[k].second];
  for (int k = 0; k < w.pair_count; ++k) {
    pull(law, w.pairs[k].first, w.pairs[k].second, w);
    try_to_join(law, s, w.pairs[k].first, w.pairs[k].second, w);
  }
  for (int p = 0; p < n; ++p) {
    if (w.neighbours[p] == 0) continue;
    const int i = w.sorted[p];
    s.vx[i] += w.jx[p] / w.sm[p], s.vy[i] += w.jy[p] / w.sm[p], s.vz[i] += w.jz[p] / w.sm[p];
  }
  bool any = false;
  for (int p = 0; p < n; ++p)
    if (w.joined[p] >= 0 && w.joined[p] != p) join(m, w.sorted[w.joined[p]], w.sorted[p], s), any = true;
  if (any) remove_empty(s);
  return report;
}

}  // namespace trocar::fluids::detail
