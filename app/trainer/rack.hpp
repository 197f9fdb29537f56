// Which hand is controlled, which instrument it has, and the generator's panel.
#pragma once

#include <cstdint>

#include <trocar/attempt/hand_pilot.hpp>
#include <trocar/attempt/live.hpp>

namespace trocar::app {

/// The rack: which hand, which instrument in it; and the generator's panel where there is one.
struct RackChoice {
  bool close = false, pause = false, insert = false, ratchet = false, fine = false;
  bool both = false, exchange = false;  ///< the other of: one hand, both; of both: what the mouse leads
  int hand = -2;                        ///< control this one (devices::kScope: the endoscope); -2: no choice
  int instrument = -1;                  ///< for the controlled hand
  std::uint32_t panel_keys = 0;         ///< tissue::PanelKey bits pressed
};
RackChoice draw_rack(const sim::Model& model, const sim::State& state, const devices::BothHands& both,
                     float picture_width);

}  // namespace trocar::app
