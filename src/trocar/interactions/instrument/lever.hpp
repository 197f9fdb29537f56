// What the tissue's forces do at the trocar: an instrument is a lever about the point where it goes through the
// abdominal wall. A force across the shaft at `s` inside is borne by the hand with s/L of it, L being the length
// outside, and by the abdominal wall with 1 + s/L of it; a force along the shaft is the hand's alone. The instrument's
// own weight and the seal's friction (0.25 to 3 N in the literature) are left out.
#pragma once

#include <trocar/interactions/instrument/touch.hpp>

namespace trocar::interactions {

struct TrocarLoad {
  Vec3d force;     ///< of tissue and walls on the instrument, all together [N]
  Vec3d moment;    ///< of these about the fulcrum [N m]
  Vec3d on_wall;   ///< what the abdominal wall bears at the trocar [N]
  Vec3d by_hand;   ///< what the hand applies at the handle [N]
  double turning;  ///< moment about the shaft that the hand bears [N m]
};

/// Of the last tick. Contacts are taken together at the mean of their points, weighted with their normal forces.
TrocarLoad load_at_trocar(const ToolModel& model, const ToolState& tool, const TouchBook& book) noexcept;

}  // namespace trocar::interactions
