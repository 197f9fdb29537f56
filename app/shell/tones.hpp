// Short sounds, computed: what the ear is told while the eyes are on the picture. Each begins and ends in silence, so
// that nothing clicks that should not.
#pragma once

#include <cstdint>
#include <vector>

namespace trocar::app {

enum class Tone {
  step_done,  ///< two rising notes
  error,      ///< one low, rough note
  clip,       ///< a snap
  cut,        ///< two blades
  touch,      ///< a click: the more of them, the harder something presses
  beat,       ///< a dull thump: a pulse
  warning,    ///< short and high: the pull comes near its limit
  finished,   ///< three rising notes
  count
};

/// Mono, 16 bit. @param rate samples a second, 8000 or more
std::vector<std::int16_t> samples_of(Tone tone, int rate);

}  // namespace trocar::app
