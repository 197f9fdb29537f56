// What fat still does to what lies in it: what it covers, and what it ties to what.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <trocar/sim/model/state.hpp>

namespace trocar::training {

/// A strand is bare at a place where it is free in so many of eight sectors around it.       shared figures:
/// docs/science/fat.md
inline constexpr int kSectors = 8, kBareSectors = 7;

/// The longest stretch of a strand along which it is bare and lay in fat in the drawn shape: what never lay in it has
/// not been bared. The Model outlives it.
class BaredStretch {
 public:
  BaredStretch(const sim::Model& model, int strand);
  double longest(const sim::State& state) const;  ///< [m]

 private:
  const sim::Model* m_model;
  int m_strand;
  std::vector<std::uint8_t> m_lay_in_fat;  ///< (places along it)
};

/// The share of 64 sights across a triangle that meet no lobule. @param reach  to both sides of its plane [m]
double open_share(const sim::Model& model, const sim::State& state, const std::array<Vec3d, 3>& corners, double reach);

/// Bodies that fat, septum by septum, leads to from this one; without it.
std::vector<BodyId> bridged_from(const sim::Model& model, const sim::State& state, BodyId body);

/// A place beside a strand.
struct NearStrand {
  BodyId strand;
  double apart = 1;         ///< of the place from its surface [m]
  Vec3d outwards{0, 0, 1};  ///< unit, from its middle to the place
  Vec3d along{1, 0, 0};     ///< unit, of the strand there
};
/// The nearest strand but for these; at most 1 m away.
NearStrand nearest_strand(const sim::Model& model, const sim::State& state, Vec3d place,
                          std::span<const BodyId> but = {});

/// The share of a body of fat that is still there: that has not boiled away and hangs, septum by septum, on something.
double fat_left(const sim::Model& model, const sim::State& state, BodyId fat);

}  // namespace trocar::training
