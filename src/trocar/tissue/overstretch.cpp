#include <trocar/tissue/overstretch.hpp>

namespace trocar::tissue {
namespace {

constexpr int kStrandTicks = 50;  // 0.05 s at 1 ms

const NodeState& other_end(const PackedSprings& b, const HalfEdgePack& p, int lane) noexcept {
  return b.nodes[p.offset[lane] / sizeof(NodeState)];
}
Vec3f reach(const NodeState& from, const NodeState& to) noexcept {
  return {to.x - from.x, to.y - from.y, to.z - from.z};
}

/// Per row of a slice: how many of its springs are beyond.
struct Beyond {
  int of_row[kSlice] = {};
};
Beyond count(const PackedSprings& b, int slice, float limit) noexcept {
  Beyond beyond;
  const float limit2 = limit * limit;
  for (int c = b.slice_begin[std::size_t(slice)]; c < b.slice_begin[std::size_t(slice) + 1]; ++c) {
    const HalfEdgePack& p = b.packs[std::size_t(c)];
    for (int lane = 0; lane < kSlice; ++lane) {
      const NodeState& own = b.nodes[std::size_t(slice * kSlice + lane)];
      const Vec3f d = reach(own, other_end(b, p, lane));
      const float r2 = ((d.x * d.x + d.y * d.y) + d.z * d.z) * (p.inv_rest[lane] * p.inv_rest[lane]);
      const bool whole = b.scale.empty() || b.scale[std::size_t(c * kSlice + lane)] > 0;
      beyond.of_row[lane] += r2 > limit2 && p.stiffness[lane] > 0 && whole;
    }
  }
  return beyond;
}

Overstretch most_stretched(const PackedSprings& b, int row) noexcept {
  Overstretch tear;
  const int slice = row / kSlice, lane = row % kSlice;
  const NodeState& own = b.nodes[std::size_t(row)];
  float most = 0;
  for (int c = b.slice_begin[std::size_t(slice)]; c < b.slice_begin[std::size_t(slice) + 1]; ++c) {
    const HalfEdgePack& p = b.packs[std::size_t(c)];
    if (!(p.stiffness[lane] > 0) || (!b.scale.empty() && !(b.scale[std::size_t(c * kSlice + lane)] > 0))) continue;
    const Vec3f d = reach(own, other_end(b, p, lane));
    const float stretched = length(d) * p.inv_rest[lane];
    if (stretched <= most) continue;
    most = stretched;
    const Vec3d way = vec_cast<double>(d);
    tear.found = true;
    tear.length = length(way);
    tear.along = way / tear.length;
    tear.middle = b.origin + Vec3d{double(own.x), double(own.y), double(own.z)} + 0.5 * way;
  }
  return tear;
}

}  // namespace

PackedSprings springs_of(const NetworkModel& m, const NetworkState& s) noexcept {
  PackedSprings b{m.packs, m.slice_begin, {}, s.nodes, m.origin};
  if (s.version != 0) b.scale = s.scale;
  return b;
}
PackedSprings springs_of(const CuttableModel& m, const CuttableState& s, const CuttableWork& w) noexcept {
  return {w.packs, {w.slice_begin.data(), std::size_t(w.slices) + 1}, {}, s.nodes, m.origin};
}

Overstretch find_overstretch(const PackedSprings& b, double failure, std::uint64_t tick,
                             std::span<std::uint8_t> counters) noexcept {
  Overstretch tear;
  const float limit = float(1 + failure);
  const int slices = int(b.slice_begin.size()) - 1;
  for (int slice = int(tick % kLookEvery); slice < slices; slice += kLookEvery) {
    const Beyond beyond = count(b, slice, limit);
    for (int lane = 0; lane < kSlice; ++lane) {
      const int row = slice * kSlice + lane;
      std::uint8_t& looks = counters[std::size_t(row)];
      if (beyond.of_row[lane] < 2)
        looks = 0;
      else if (looks < kLooks)
        ++looks;
      if (looks < kLooks || tear.found) continue;
      tear = most_stretched(b, row);
      looks = 0;
    }
  }
  return tear;
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
