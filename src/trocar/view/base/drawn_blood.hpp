// Blood that is only drawn: nothing of it is simulated.
#pragma once

namespace trocar::view {

inline constexpr float kDrawnDark = 0.7f;  ///< of 0 fresh .. 1 clotted: venous, not yet clotted.  Our choice, by eye

}  // namespace trocar::view
