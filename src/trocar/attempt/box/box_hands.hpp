// Between what a box says and the Input of the simulation, both ways: which hand of the scene each of the box's leads,
// and where its angles count from.
#pragma once

#include <trocar/devices/box/reading.hpp>
#include <trocar/sim/model/model.hpp>

namespace trocar::attempt {

class BoxHands {
 public:
  BoxHands(const sim::Model& model, const devices::BoxWiring& wiring);

  /// The scene's hand that it leads; -1: the scene has none for it, or it is not wired.
  int hand_of(devices::BoxActor actor) const { return m_hand[std::size_t(actor)]; }
  const devices::BoxWiring& wiring() const { return m_wiring; }

  /// Sets what the box leads: poses within the trocars' limits, handles, pedals and valves. Instruments stay as they
  /// are in `input`.
  void lead(const devices::BoxPose& pose, sim::Input& input) const;

  /// What a box whose hands do `input` would measure (without next_instrument and reset).
  devices::BoxBlock block_of(const sim::Input& input) const;
  /// By how much every axis of `input` is beyond what its channel can say: [rad], [m] or 0 .. 1; 0: it is not.
  devices::BoxAngles beyond(const sim::Input& input) const;

 private:
  double deflection(const sim::Input& input, int hand, devices::BoxActor actor, devices::BoxAxis axis) const;
  double zero(devices::BoxActor actor, devices::BoxAxis axis) const;
  template <class F>
  void for_wired(F&& f) const;

  const sim::Model& m_model;
  devices::BoxWiring m_wiring;
  std::array<int, devices::kBoxActors> m_hand{};
};

}  // namespace trocar::attempt
