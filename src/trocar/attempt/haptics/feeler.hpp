// What a hand would feel now, for eyes, ears and gamepads of those who have no device.
#pragma once

#include <trocar/attempt/haptics/contact_modeller.hpp>
#include <trocar/sim/stages/pulse_feel.hpp>

namespace trocar::attempt {

struct FeltForce {
  double force = 0;  ///< of tissue on the instrument, at its tip [N]
  double pulse = 0;  ///< of it, what the pulse of arteries below pushes with just now [N]
};

class Feeler {
 public:
  explicit Feeler(const sim::Model& model) : m_model(model), m_pulse(model) {}
  FeltForce feel(const sim::State& state, int hand) {
    const TipForces f = forces_at_tip(m_model, state, hand);
    return {length(f.contact + f.pull), m_model.vessels.there() ? m_pulse.force(state, hand) : 0.0};
  }

 private:
  const sim::Model& m_model;
  sim::PulseReader m_pulse;
};

}  // namespace trocar::attempt
