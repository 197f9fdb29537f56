// A haptic device controls one of the hands and feels; the other inputs control the rest.
//
//   HapticSource source(hands, haptic_hand);        // both must outlive it
#pragma once

#include <trocar/attempt/haptics/haptic_hand.hpp>
#include <trocar/attempt/lesson.hpp>

namespace trocar::attempt {

class HapticSource : public InputSource {
 public:
  HapticSource(InputSource& own, HapticHand& hand) : m_own(own), m_hand(hand) {}
  bool ready() override { return m_own.ready(); }
  std::string waits_for() const override { return m_own.waits_for(); }
  std::uint64_t behind() const override { return m_own.behind(); }
  bool next(const sim::State& state, sim::Input& input) override {
    if (!m_own.next(state, input)) return false;
    m_hand.lead(state, input);
    return true;
  }
  void after(const sim::State& state, const sim::StepReport& report) override {
    m_own.after(state, report);
    m_hand.after(state);
  }
  std::optional<DeviceNews> device() const override { return m_own.device(); }
  Json describe() const override {
    Json out = m_own.describe();
    out["haptics"] = m_hand.describe();
    return out;
  }

 private:
  InputSource& m_own;
  HapticHand& m_hand;
};

}  // namespace trocar::attempt
