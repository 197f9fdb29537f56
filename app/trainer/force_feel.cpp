#include "trainer/force_feel.hpp"

#include <algorithm>
#include <cmath>

namespace trocar::app {
namespace {

constexpr double kTouched = 0.03;                          // [N] that begins to be told
constexpr double kSlowestClicks = 2, kFastestClicks = 20;  // [clicks/s] at a touch, at the limit
constexpr double kPulseFelt = 0.003, kPulseFull = 0.1;  // [N] a beat that is told; one that the motor gives its all for
constexpr double kRises = 0.5, kFalls = 0.25;           // of the highest pulse of the last seconds
constexpr double kLeastMotor = 0.15;                    // below which motors do not turn

}  // namespace

void ForceFeel::add(double now, const attempt::FeltForce& felt, double limit) {
  m_trace.push_back({now, felt});
  const auto old =
      std::find_if(m_trace.begin(), m_trace.end(), [now](const Sample& s) { return s.time >= now - kSeconds; });
  m_trace.erase(m_trace.begin(), old);
  const double share = std::clamp(felt.force / std::max(limit, 0.1), 0.0, 1.0);
  m_click = m_beat = false;
  if (felt.force < kTouched) {
    m_next_click = now;
  } else if (now >= m_next_click) {
    m_click = true;
    m_next_click = now + 1 / (kSlowestClicks + share * (kFastestClicks - kSlowestClicks));
  }
  const double highest = std::max(kPulseFelt, most_pulse() > kLeastPulseScale ? most_pulse() : felt.pulse);
  const bool rises = felt.pulse > kPulseFelt && felt.pulse > (m_high ? kFalls : kRises) * highest;
  m_beat = rises && !m_high;
  m_high = rises;
  m_level = float(0.3 + 0.7 * share);
  const double wanted = felt.force < kTouched ? 0 : kLeastMotor + (1 - kLeastMotor) * share;
  m_strong = wanted;
  m_weak = felt.pulse < kPulseFelt ? 0 : std::clamp(kLeastMotor + felt.pulse / kPulseFull, 0.0, 1.0);
}

void ForceFeel::forget() { *this = {}; }

double ForceFeel::most() const {
  double most = kLeastScale;
  for (const Sample& s : m_trace) most = std::max(most, s.felt.force);
  return most;
}

double ForceFeel::most_pulse() const {
  double most = kLeastPulseScale;
  for (const Sample& s : m_trace) most = std::max(most, s.felt.pulse);
  return most;
}

}  // namespace trocar::app
