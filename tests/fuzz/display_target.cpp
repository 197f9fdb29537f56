// Display keyframes: what a recording holds of a State, given to the Model of a small scene.
#include <trocar/scene/compile/compile.hpp>
#include <trocar/sim/recording/keyframe.hpp>

#include "../sim/small_scene.hpp"
#include "targets.hpp"

namespace trocar::fuzz {

void display_keyframe(Bytes bytes) {
  const sim::Model& model = small::model();
  const sim::State before = sim::initial_state(model);
  sim::State state = before;
  if (!sim::restore_display(model, {bytes.begin(), bytes.end()}, state)) {
    require(sim::hash_of(state) == sim::hash_of(before), "what does not fit changes nothing");
    return;
  }
  require(finite(model, state), "a restored place is a number");
  const std::vector<std::uint8_t> again = sim::display_bytes(model, state);
  sim::State other = before;
  require(sim::restore_display(model, again, other), "a restored State can be shown again");
  require(sim::display_bytes(model, other) == again, "and shows the same");
}

std::vector<Seed> display_seeds() {
  const sim::Model& model = small::model();
  std::vector<Seed> seeds;
  small::Hands hands(model);
  sim::State state = sim::initial_state(model);
  sim::Work work = sim::make_work(model);
  for (int t = 0; !hands.done(); ++t) {
    if (t % 1400 == 0) seeds.push_back({"tick" + std::to_string(t), sim::display_bytes(model, state)});
    sim::step(model, hands.next(state), state, work);
  }
  seeds.push_back({"done", sim::display_bytes(model, state)});
  return seeds;
}

}  // namespace trocar::fuzz
