// Why a key does nothing here, in one line: the one place that knows. Pure logic; the window shows the line near the
// hint for some seconds.
//
//   if (const std::string why = refusal({model, state, ...}, sample, layout_key); !why.empty()) show(why);
#pragma once

#include <string>

#include <trocar/core/controls/control_keys.hpp>
#include <trocar/devices/mouse_keyboard.hpp>
#include <trocar/sim/model/state.hpp>

namespace trocar::app {

struct KeySituation {
  const sim::Model& model;
  const sim::State& state;
  int led = 0;            ///< a hand, or devices::kScope
  bool scored = false;    ///< the attempt counts
  bool declares = false;  ///< the exercise asks for a declaration
  bool seen = false;      ///< the controlled instrument is in view
  core::KeyDevice device = core::KeyDevice::mouse_and_keys;
};

/// @param sample  with what went down since the last one  @param before  the gamepad of the sample before
/// @param layout  the key for another layout went down
/// @returns empty: nothing was pressed that does nothing
std::string refusal(const KeySituation& situation, const devices::HandSample& sample, const devices::Gamepad& before,
                    bool layout);

}  // namespace trocar::app
