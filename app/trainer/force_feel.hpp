// The force on a hand as those get it who have no haptic device: a trace of the last seconds, clicks that come the
// faster the harder it presses, a thump with each beat of an artery, and the motors of a gamepad. Pure logic; panel.hpp
// draws the trace, sound.hpp and rumble.hpp do the rest.
//
//   feel.add(now, felt, limit);
//   if (feel.click()) sound.play(Tone::touch, feel.click_level());
//   rumble.set(feel.strong(), feel.weak());
#pragma once

#include <vector>

#include <trocar/attempt/haptics/feeler.hpp>

namespace trocar::app {

class ForceFeel {
 public:
  struct Sample {
    double time = 0;  ///< [s]
    attempt::FeltForce felt;
  };

  /// One picture's. @param now real time [s]  @param limit of the pull, that all motors and the fastest clicks stand
  /// for [N]
  void add(double now, const attempt::FeltForce& felt, double limit);
  /// Time stands still, or another hand is led: nothing is felt any more.
  void forget();

  const std::vector<Sample>& trace() const { return m_trace; }  ///< of the last kSeconds, oldest first
  double most() const;                                          ///< force in it, at least kLeastScale [N]
  double most_pulse() const;                                    ///< likewise [N]

  bool click() const { return m_click; }      ///< is due with this picture
  bool beat() const { return m_beat; }        ///< the pulse has just risen
  float level() const { return m_level; }     ///< how loud either is, 0..1
  double strong() const { return m_strong; }  ///< of the slow motor, 0..1: the force
  double weak() const { return m_weak; }      ///< of the quick one: the pulse

  static constexpr double kSeconds = 6, kLeastScale = 0.5, kLeastPulseScale = 0.02;

 private:
  std::vector<Sample> m_trace;
  double m_next_click = 0, m_strong = 0, m_weak = 0;
  float m_level = 0;
  bool m_click = false, m_beat = false, m_high = false;
};

}  // namespace trocar::app
