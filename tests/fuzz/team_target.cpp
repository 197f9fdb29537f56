// What a team's programs say to each other, once it is opened.
#include <cmath>

#include <trocar/attempt/team/message.hpp>

#include "targets.hpp"

namespace trocar::fuzz {

namespace m = attempt::message;

void team_message(Bytes bytes) {
  const std::optional<m::Message> message = m::decoded(bytes);
  if (!message) return;
  if (const auto* ticks = std::get_if<m::Ticks>(&*message)) {
    require(ticks->inputs.size() <= m::kMostTicks, "ticks are bounded");
    for (const sim::Input& input : ticks->inputs) require(std::isfinite(input.scope.yaw), "inputs are finite");
  }
  const std::optional<m::Message> again = m::decoded(m::coded(*message));
  require(again.has_value(), "what was understood can be said");
  require(again->index() == message->index(), "and is the same kind");
  require(m::coded(*again) == m::coded(*message), "with the same content");
}

std::vector<Seed> team_seeds() {
  sim::Input input;
  input.tools[1].yaw = 0.25f, input.pedals = sim::kBlue;
  return {{"hello", m::coded(m::Hello{"camera", "0.1.0", 12345})},
          {"share", m::coded(m::Share{300, 1u << 30, input})},
          {"done", m::coded(m::Done{1000, 900, 0x0123456789abcdefull, 20000})},
          {"attempt", m::coded(m::Attempt{"gynaecology/sterilisation", "0.1.0", 3, 99})},
          {"ticks", m::coded(m::Ticks{1000, {input, input, {}, input}, 7, 8})},
          {"waits", m::coded(m::Waits{"the camera is not here"})},
          {"end", m::coded(m::End{m::kFinished})}};
}

}  // namespace trocar::fuzz
