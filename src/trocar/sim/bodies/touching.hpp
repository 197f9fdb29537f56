// An instrument among all bodies, in a tick: what it was near, and where the State keeps what it remembers of each.
#pragma once

#include <trocar/interactions/instrument/tool_contact.hpp>
#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

struct HandContact {
  size_t hand;
  const interactions::ToolModel& tool;
  interactions::Touching& touching;
  size_t tool_side, sheet_side;  ///< of the next body, in State::tool_side and State::sheet_side

  /// The next `n` entries.
  static std::span<Vec3f> next(std::vector<Vec3f>& all, size_t& at, size_t n) noexcept {
    const std::span<Vec3f> part{all.data() + at, n};
    at += n;
    return part;
  }
};

/// What the hand's jaws hold of a body.
inline interactions::HeldVertices held_by(const StepContext& c, const HandContact& hand, BodyId body) noexcept {
  return {bodies_of(c), body, c.state.tools[hand.hand]};
}

}  // namespace trocar::sim
