// A source of inputs, one of whose hands a simulated device stands in for: what a hand would do that feels, without a
// window, a clock or a device.
#pragma once

#include <trocar/attempt/haptics/haptic_hand.hpp>
#include <trocar/attempt/lesson.hpp>

namespace trocar::attempt {

class HapticSource : public InputSource {
 public:
  HapticSource(std::unique_ptr<InputSource> inner, std::unique_ptr<HapticHand> hand)
      : m_inner(std::move(inner)), m_hand(std::move(hand)) {}
  bool next(const sim::State& state, sim::Input& input) override {
    if (!m_inner->next(state, input)) return false;
    m_hand->lead(state, input);
    return true;
  }
  void after(const sim::State& state, const sim::StepReport& report) override {
    m_inner->after(state, report);
    m_hand->after(state);
  }
  Json describe() const override {
    Json out = m_inner->describe();
    out["haptics"] = m_hand->describe();
    return out;
  }

 private:
  std::unique_ptr<InputSource> m_inner;
  std::unique_ptr<HapticHand> m_hand;
};

}  // namespace trocar::attempt
