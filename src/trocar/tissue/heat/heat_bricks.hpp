// The bricks of heat.hpp: which are remembered, which are awake, who lies beside whom. Internal to heat*.cpp.
#pragma once

#include <trocar/tissue/heat/heat.hpp>

namespace trocar::tissue::heat {

/// HeatState::marks.
enum Mark : std::uint8_t {
  kWarmFace = 1,  ///< << 0 .. 5: a cell at that face is warm enough to wake the neighbour
  kDried = 64,    ///< water boiled in this step: conduction is to be made again
  kFed = 128,     ///< heat was given since the last step's end: not to fall asleep
};

/// HeatState::link: a slot, or one of these; kSleeping - brick.
enum Link : std::int32_t { kUnknown = -1, kEmpty = -2, kSleeping = -3 };

inline constexpr int kNeighbours = 6;
BrickKey neighbour(const BrickKey& key, int face) noexcept;

inline constexpr std::int32_t kNobody = -1;
/// The brick there; kNobody if it is not known, kEmpty - n if it is the n-th without tissue.
std::int32_t find(const HeatModel& model, const HeatState& state, const BrickKey& key) noexcept;

/// Makes the table by which bricks are found again.
void index_bricks(const HeatModel& model, HeatState& state) noexcept;

/// The slot of the brick there, woken or made if need be; -1 if it holds no tissue or there is no room (flagged).
std::int32_t wake(const HeatModel& model, const BrickKey& key, const TissueShape& shape, HeatState& state,
                  std::uint32_t& flags) noexcept;

/// Between two steps: what has cooled falls asleep, whom warmth has reached wakes; then lists and links the awake ones.
void settle(const HeatModel& model, const TissueShape& shape, HeatState& state, std::uint32_t& flags) noexcept;

/// Conductivity of a cell, h x cell if it is not tissue: that is always less.
inline float conduction_of(const HeatModel& m, std::uint8_t cell, float water) noexcept {
  if (!(cell & HeatState::kTissue)) return float(m.surface * m.cell);
  return float(m.dry_conductivity) + float(m.conductivity - m.dry_conductivity) * water;
}
inline float gas_of(const HeatModel& m) noexcept { return float(m.gas - kBodyHeat); }

/// Computes slots order[first .. last) of this step.
void step_bricks(const HeatModel& model, int first, int last, HeatState& state, HeatWork& work,
                 HeatReport& report) noexcept;

}  // namespace trocar::tissue::heat
