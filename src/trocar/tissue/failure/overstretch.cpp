#include <algorithm>

#include <trocar/tissue/failure/overstretch.hpp>

namespace trocar::tissue {
namespace {

constexpr int kStrandTicks = 50;  // 0.05 s at 1 ms

int other_row(const HalfEdgePack& p, int lane) noexcept { return int(p.offset[lane] / sizeof(NodeState)); }
Vec3f reach(const NodeState& from, const NodeState& to) noexcept {
  return {to.x - from.x, to.y - from.y, to.z - from.z};
}

/// visit(row, other row, reach, stretch squared) of every whole spring.
template <class Visit>
void for_each_spring(const PackedSprings& b, Visit&& visit) noexcept {
  for (int slice = 0; slice + 1 < int(b.slice_begin.size()); ++slice)
    for (int c = b.slice_begin[std::size_t(slice)]; c < b.slice_begin[std::size_t(slice) + 1]; ++c) {
      const HalfEdgePack& p = b.packs[std::size_t(c)];
      for (int lane = 0; lane < kSlice; ++lane) {
        const int row = slice * kSlice + lane, other = other_row(p, lane);
        if (!(p.stiffness[lane] > 0) || (!b.scale.empty() && !(b.scale[std::size_t(c * kSlice + lane)] > 0))) continue;
        const Vec3f d = reach(b.nodes[std::size_t(row)], b.nodes[std::size_t(other)]);
        visit(row, other, d, ((d.x * d.x + d.y * d.y) + d.z * d.z) * (p.inv_rest[lane] * p.inv_rest[lane]));
      }
    }
}

Overstretch most_stretched(const PackedSprings& b, int at) noexcept {
  Overstretch tear;
  float most = 0;
  for_each_spring(b, [&](int row, int other, Vec3f d, float stretch2) noexcept {
    if ((row != at && other != at) || stretch2 <= most) return;
    most = stretch2;
    const NodeState& own = b.nodes[std::size_t(row)];
    const Vec3d way = vec_cast<double>(d);
    tear.found = true;
    tear.length = length(way);
    tear.along = way / tear.length;
    tear.middle = b.origin + Vec3d{double(own.x), double(own.y), double(own.z)} + 0.5 * way;
  });
  return tear;
}

}  // namespace

PackedSprings springs_of(const NetworkModel& m, const NetworkState& s) noexcept {
  PackedSprings b{m.packs, m.slice_begin, {}, s.nodes, m.origin};
  if (s.version != 0) b.scale = s.scale;
  return b;
}
PackedSprings springs_of(const CuttableModel& m, const CuttableState& s, const CuttableWork& w) noexcept {
  return {w.packs, {w.slice_begin.data(), std::size_t(w.slices) + 1}, {}, s.nodes, m.origin, true};
}

Overstretch find_overstretch(const PackedSprings& b, double failure, std::uint64_t tick,
                             std::span<std::uint8_t> counters, std::span<std::uint8_t> scratch) noexcept {
  if (tick % kLookEvery != 0) return {};
  const float limit2 = float((1 + failure) * (1 + failure));
  const int rows = kSlice * (int(b.slice_begin.size()) - 1);
  const auto beyond = scratch.first(std::size_t(rows));
  std::fill(beyond.begin(), beyond.end(), std::uint8_t(0));
  const auto count = [beyond](int row) noexcept {
    std::uint8_t& n = beyond[std::size_t(row)];
    n = std::uint8_t(n < 2 ? n + 1 : 2);
  };
  for_each_spring(b, [&](int row, int other, Vec3f, float stretch2) noexcept {
    if (!(stretch2 > limit2)) return;
    count(row);
    if (!b.twice) count(other);
  });
  int torn = -1;
  for (int row = 0; row < rows; ++row) {
    std::uint8_t& looks = counters[std::size_t(row)];
    looks = beyond[std::size_t(row)] < 2 ? std::uint8_t(0) : std::uint8_t(looks < kLooks ? looks + 1 : kLooks);
    if (looks == kLooks && torn < 0) torn = row, looks = 0;
  }
  return torn < 0 ? Overstretch{} : most_stretched(b, torn);
}

int find_overstretch(const StrandModel& m, const StrandState& s, double failure,
                     std::span<std::uint8_t> counters) noexcept {
  int parts = -1;
  for (int i = 1; i + 1 < m.nodes; ++i) {
    const double before = element_strain(m, s, i - 1), after = element_strain(m, s, i);
    std::uint8_t& ticks = counters[std::size_t(i)];
    ticks = before > failure && after > failure ? std::uint8_t(ticks + 1) : std::uint8_t(0);
    if (ticks < kStrandTicks) continue;
    ticks = 0;
    if (parts < 0) parts = before >= after ? i - 1 : i;
  }
  return parts;
}

}  // namespace trocar::tissue
