// Where tissue tears: at a node two of whose springs have been stretched beyond the failure strain for 0.05 s. One
// spring alone, or a jerk, tears nothing. (The rule is our choice; failure strains are the tissue table's.)
//
//   const Overstretch tear = find_overstretch(springs, failure_strain, tick, counters);
//   if (tear.found) part the body by tear.blade();
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/geometry/tets/blade.hpp>
#include <trocar/tissue/network/network.hpp>
#include <trocar/tissue/strand/strand.hpp>
#include <trocar/tissue/tets/cuttable.hpp>

namespace trocar::tissue {

/// A body is looked at every so many ticks, and tears where a node was found overstretched in so many looks in a row.
inline constexpr int kLookEvery = 25, kLooks = 3;

/// The springs of a body as the kernel reads them.
struct PackedSprings {
  std::span<const HalfEdgePack> packs;
  std::span<const int> slice_begin;  ///< (slices + 1)
  std::span<const float> scale;      ///< per place in packs; empty: all whole
  std::span<const NodeState> nodes;  ///< (rows)
  Vec3d origin;
  bool twice = false;  ///< packs have every spring at both of its ends
};
PackedSprings springs_of(const NetworkModel& model, const NetworkState& state) noexcept;
/// @param work  as advance() left it
PackedSprings springs_of(const CuttableModel& model, const CuttableState& state, const CuttableWork& work) noexcept;

struct Overstretch {
  bool found = false;
  Vec3d middle, along;  ///< of the spring that is stretched most [m], unit
  double length = 0;    ///< of that spring as it is [m]

  /// What opens: a square across the spring, about as large as the cells there. @param half  of its edge over `length`
  geometry::Blade blade(double half = 0.6) const noexcept {
    return geometry::square_blade(middle, along, half * length);
  }
};

/// Looks, when it is time, and counts. @param failure  strain [-], > 0
/// @param counters  (rows) State  @param scratch  (rows or more)
/// @return at the first row whose time is over; it starts counting again
Overstretch find_overstretch(const PackedSprings& springs, double failure, std::uint64_t tick,
                             std::span<std::uint8_t> counters, std::span<std::uint8_t> scratch) noexcept;

/// The same for strands, every tick: two neighbouring elements beyond failure.
/// @param counters  (nodes) State  @return the element that parts, or -1
int find_overstretch(const StrandModel& model, const StrandState& state, double failure,
                     std::span<std::uint8_t> counters) noexcept;

}  // namespace trocar::tissue
