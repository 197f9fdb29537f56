// Forces between drops, and drops that become one. A grid of cells as wide as the farthest reach, hashed into buckets;
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
constexpr float kJoin = 0.5f;                     ///< the same, where two become one
constexpr float kShare = 0.5f;                    ///< of the implicit impulse, as a drop may have many neighbours
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

std::uint32_t bucket(const Grid& g, float x, float y, float z) {
  const auto cell = [&](float q) { return std::uint32_t(std::int32_t(q * g.per_cell + 65536.0f)); };
  return (cell(x) + cell(y) * kRow + cell(z) * kLayer) & g.mask;
}

Grid sort(const DropletModel& m, const DropletState& s, DropletWork& w) {
  float largest = 1e-5f;
  for (int i = 0; i < s.count; ++i) largest = std::max(largest, s.radius[i]);
  Grid g{buckets_for(s.count), 0, 1 / (2 * kReach * largest)};
  g.mask = g.buckets - 1;
  std::fill_n(w.bucket_first.begin(), g.buckets + 1, 0u);
  for (int i = 0; i < s.count; ++i) {
    const std::uint32_t b = bucket(g, s.x[i], s.y[i], s.z[i]);
    w.bucket_of[i] = std::int32_t(b);
    ++w.bucket_first[b + 1];
  }
  for (std::uint32_t b = 0; b < g.buckets; ++b) w.bucket_first[b + 1] += w.bucket_first[b];
  // Filling moves each start to its end, which is the next one's start: shift back afterwards.
  for (int i = 0; i < s.count; ++i) w.sorted[w.bucket_first[w.bucket_of[i]]++] = i;
  for (std::uint32_t b = g.buckets; b > 0; --b) w.bucket_first[b] = w.bucket_first[b - 1];
  w.bucket_first[0] = 0;
  for (int p = 0; p < s.count; ++p) {
    const int i = w.sorted[p];
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
  const float d = std::sqrt((dx * dx + dy * dy) + dz * dz), sum = w.sr[p] + w.sr[q];
  if (!(d > 1e-7f)) return;
  const float nx = dx / d, ny = dy / d, nz = dz / d;
  const float apart = (nx * (w.svx[q] - w.svx[p]) + ny * (w.svy[q] - w.svy[p])) + nz * (w.svz[q] - w.svz[p]);
  const float stretch = d - kRest * sum;
  const float weight = stretch > 0 ? (kReach * sum - d) / ((kReach - kRest) * sum) : 1.0f;
  const float both = w.sm[p] * w.sm[q] / (w.sm[p] + w.sm[q]);
  const float damping = law.dt * law.k + std::sqrt(law.k * both);
  const float others = float(std::max(w.neighbours[p], w.neighbours[q]));
  const float impulse = weight * law.dt * (law.k * stretch + damping * apart) / (1 + law.dt * damping / both) / others;
  w.jx[p] += impulse * nx, w.jy[p] += impulse * ny, w.jz[p] += impulse * nz;
  w.jx[q] -= impulse * nx, w.jy[q] -= impulse * ny, w.jz[q] -= impulse * nz;
}

bool may_join(const Law& law, const DropletState& s, const DropletWork& w, int p, int q) {
  const int i = w.sorted[p], j = w.sorted[q];
  return w.joined[p] < 0 && w.joined[q] < 0 && s.body[i] == s.body[j] &&
         s.volume[i].total() + s.volume[j].total() <= law.largest;
}

/// Drops q in [first, last) as neighbours of p.
struct Budget {
  int pairs = kMostPairs, looks = kMostLooks;
};
void look(const Law& law, int p, std::uint32_t first, std::uint32_t last, const DropletState& s, DropletWork& w,
          Budget& left) {
  const float x = w.sx[p], y = w.sy[p], z = w.sz[p], r = w.sr[p];
  const std::uint32_t some = std::min(last, first + std::uint32_t(left.looks));
  if (some > first) left.looks -= int(some - first);
  for (std::uint32_t q = first; q < some; ++q) {
    const float dx = w.sx[q] - x, dy = w.sy[q] - y, dz = w.sz[q] - z, sum = r + w.sr[q];
    const float d2 = (dx * dx + dy * dy) + dz * dz;
    if (!(d2 < (kReach * kReach) * (sum * sum)) || left.pairs == 0 || w.pair_count >= int(w.pairs.size())) continue;
    --left.pairs;
    w.pairs[w.pair_count++] = {p, std::int32_t(q)};
    ++w.neighbours[p], ++w.neighbours[q];
    if (d2 < (kJoin * kJoin) * (sum * sum) && may_join(law, s, w, p, int(q))) w.joined[q] = p, w.joined[p] = p;
  }
}

/// The buckets a, a + 1, ..., a + n - 1, which may go round the end.
void look_at_buckets(const Law& law, const Grid& g, int p, std::uint32_t a, std::uint32_t n, const DropletState& s,
                     DropletWork& w, Budget& left) {
  a &= g.mask;
  const std::uint32_t end = a + n;
  look(law, p, w.bucket_first[a], w.bucket_first[std::min(end, g.buckets)], s, w, left);
  if (end > g.buckets) look(law, p, 0, w.bucket_first[end - g.buckets], s, w, left);
}

void look_around(const Law& law, const Grid& g, int p, const DropletState& s, DropletWork& w, Budget& left) {
  const auto own = std::uint32_t(w.bucket_of[w.sorted[p]]);
  look(law, p, std::uint32_t(p) + 1, w.bucket_first[own + 1], s, w, left);
  look_at_buckets(law, g, p, own + 1, 1, s, w, left);
  for (const std::uint32_t row : {kRow, kLayer - kRow, kLayer, kLayer + kRow})
    look_at_buckets(law, g, p, own + row - 1, 3, s, w, left);
}

/// Drop j becomes part of drop i. Flying ones meet half-way; on a surface the first stays where it is.
void join(const DropletModel& m, int i, int j, DropletState& s) {
  const float mi = float(mass(widened(s.volume[i]), m.density)), mj = float(mass(widened(s.volume[j]), m.density));
  const float part = mj / (mi + mj);
  s.vx[i] += part * (s.vx[j] - s.vx[i]), s.vy[i] += part * (s.vy[j] - s.vy[i]), s.vz[i] += part * (s.vz[j] - s.vz[i]);
  if (s.body[i] < 0) s.x[i] += part * (s.x[j] - s.x[i]), s.y[i] += part * (s.y[j] - s.y[i]);
  if (s.body[i] < 0) s.z[i] += part * (s.z[j] - s.z[i]);
  s.volume[i].blood += s.volume[j].blood, s.volume[i].saline += s.volume[j].saline;
  s.volume[i].bile += s.volume[j].bile;
  s.volume[j] = {};
  s.radius[i] = radius_of(s.volume[i].total());
}

}  // namespace

FluidReport pull_together(const DropletModel& m, double dt, DropletState& s, DropletWork& w) noexcept {
  FluidReport report;
  if (s.count < 2) return report;
  const Grid g = sort(m, s, w);
  const Law law{float(portable::pi * m.surface_tension), float(dt), m.largest};
  for (int p = 0; p < s.count; ++p) {
    Budget left;
    look_around(law, g, p, s, w, left);
    if (left.pairs == 0 || left.looks == 0) report.note(FluidReport::kCrowded, w.sorted[p]);
  }
  if (w.pair_count >= int(w.pairs.size())) report.note(FluidReport::kCrowded, 0);
  for (int k = 0; k < w.pair_count; ++k) pull(law, w.pairs[k].first, w.pairs[k].second, w);
  bool any = false;
  for (int p = 0; p < s.count; ++p) {
    const int i = w.sorted[p];
    s.vx[i] += w.jx[p] / w.sm[p], s.vy[i] += w.jy[p] / w.sm[p], s.vz[i] += w.jz[p] / w.sm[p];
  }
  for (int p = 0; p < s.count; ++p)
    if (w.joined[p] >= 0 && w.joined[p] != p) join(m, w.sorted[w.joined[p]], w.sorted[p], s), any = true;
  if (any) remove_empty(s);
  return report;
}

}  // namespace trocar::fluids::detail
