// Somebody who leads one hand tick by tick, on the simulation's thread, whoever leads the others.
#pragma once

#include <trocar/sim/model/state.hpp>

namespace trocar::attempt {

class LedHand {
 public:
  virtual ~LedHand() = default;
  /// Before a tick: changes what is its own in the input.
  virtual void lead(const sim::State& state, sim::Input& input) noexcept = 0;
  /// What the tick made of it.
  virtual void after(const sim::State& state) noexcept = 0;
};

}  // namespace trocar::attempt
