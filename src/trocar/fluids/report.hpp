// What the fluids say about a tick: bit flags, each with its remedy, and the first place where something was wrong.
// None of them loses a picolitre: what does not fit is booked elsewhere, what is nonsense is refused before it is
// booked.
#pragma once

#include <cstdint>

namespace trocar::fluids {

struct FluidReport {
  enum Flag : std::uint32_t {
    kFine = 0,
    kDropletsFull = 1,   ///< no room for more droplets: what flowed went straight into the pool; raise the capacity
    kFlowBounded = 2,    ///< an opening gave more than kMostAtOnce or less than nothing in a tick: cut to that
    kBadOpening = 4,     ///< an opening's place or direction is not finite: its flow went into the pool
    kBadDroplet = 8,     ///< a droplet's place or velocity is not finite or far outside: it went into the pool
    kBadContact = 16,    ///< a contact plane, film cell or capsule is not finite or does not exist: left out
    kBadFloor = 32,      ///< the floor is not finite or beyond 10 m somewhere, or not given: taken as flat there
    kPoolHeldBack = 64,  ///< cells of the pool are full: the rest waits and flows in as there is room
    kBadDrain = 128,     ///< a drain or port that does not exist or is not finite: left out
    kCrowded = 256,      ///< too many droplets in one place to look at every pair: some forces left out
  };
  std::uint32_t flags = kFine;
  std::int32_t first_bad = -1;  ///< index of the first thing that was wrong, in its own array; -1 = none

  void note(Flag flag, std::int32_t index) noexcept {
    flags |= flag;
    if (first_bad < 0) first_bad = index;
  }
};

inline FluidReport operator|(FluidReport a, FluidReport b) noexcept {
  return {a.flags | b.flags, a.first_bad >= 0 ? a.first_bad : b.first_bad};
}

}  // namespace trocar::fluids
