// What a tissue body says about the tick it has just made: bit flags, each with its remedy, and where it went wrong.
#pragma once

#include <cstdint>

namespace trocar::tissue {

struct StepReport {
  enum Flag : std::uint32_t {
    kFine = 0,
    kNonFinite = 1,  ///< a position or velocity is NaN, infinite or beyond 1e6: restore an earlier State
    kInverted = 2,   ///< volume protection is at work on at least one cell: nothing to do, unless it lasts
    kBadLoad =
        4,  ///< a load names a node or element that does not exist or is not finite (left out), or is out of order
    kBeyondLinear = 16,  ///< an elastostatic organ has turned too far for it: expect its forces and shape to be off
    kIndefinite = 8,  ///< a strand's matrix lost a pivot (non-finite or negative stiffness given): state not advanced
  };
  std::uint32_t flags = kFine;
  int first_bad = -1;  ///< first offending node (load for kBadLoad), in the Description's numbering; -1 = none

  bool fine() const { return (flags & (kNonFinite | kBadLoad | kIndefinite)) == 0; }
};

/// Joins two reports; the first fault's place wins.
inline StepReport operator|(StepReport a, StepReport b) {
  return {a.flags | b.flags, a.first_bad >= 0 ? a.first_bad : b.first_bad};
}

}  // namespace trocar::tissue
