// Something that happened in a tick, to whom and where. What it is called, and which attributes it has, is known to its
// event (events/event.hpp).
#pragma once

#include <string>

#include <trocar/sim/model/state.hpp>
#include <trocar/training/facts/argument.hpp>

namespace trocar::training {

struct EventInstance {
  std::int32_t hand = -1;
  BodyId body;
  std::int32_t number = -1;           ///< of a clip or a cut in the State's buffer
  const std::string* name = nullptr;  ///< of the body or the vessel; null: none
  Vec3d tip, where;                   ///< the instrument's tip; the place on the body, else the tip [m]
  const char* detail = "";
  const interactions::Clip* foreseen = nullptr;  ///< a clip that is not in the buffer: it has not closed yet
};

}  // namespace trocar::training
