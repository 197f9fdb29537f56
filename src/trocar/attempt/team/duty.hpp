// What each of a team leads: the operator's hands, an assistant's, the camera. Inputs of several people become one.
//
//   const Duty camera = duty_of("camera", model);            // "assistant", "left", "right", or a trocar's name
//   copy(camera, theirs, input);
#pragma once

#include <string>
#include <string_view>

#include <trocar/sim/model/model.hpp>

namespace trocar::attempt {

struct Duty {
  std::uint32_t hands = 0;  ///< bit h: hand h, its handle's valves included
  bool scope = false;       ///< and wiping it
  bool pedals = false;      ///< foot switches, the generator's panel, declaring

  bool overlaps(const Duty& other) const;
};

/// "camera"; "assistant": the hands but the first two; "left", "right": one of the first two, as seen from the
/// endoscope sees them; a trocar's name: the hand there.
/// @throws core::BadInput naming `where` when the scene has none such
Duty duty_of(std::string_view role, const sim::Model& model, const std::string& where);

/// What it leads first: a hand, or devices::kScope.
int first_of(const Duty& duty);

/// What that duty leads goes from one input into the other; all else stays.
void copy(const Duty& duty, const sim::Input& from, sim::Input& to);

}  // namespace trocar::attempt
