#include <algorithm>

#include <trocar/training/observe/hands.hpp>
#include <trocar/training/surgeon/surgeon.hpp>

namespace trocar::training {

void Posture::begin(Surgeon& op, int hand, const Aim& aim, double held_at, double inner) {
  m_aim = aim;
  m_hand = hand;
  m_from = op.arm(hand).tip;
  m_lifted = m_drawn = 0;
  const Vec3d held = op.point(aim.strand, held_at);
  const Vec3d out = held - op.point(aim.strand, inner);
  m_outwards = normalised(Vec3d{out.x, out.y, 0});
  m_up = normalised(Vec3d{held.x > 0 ? 0.35 : -0.35, 0.10, 1.0});  // away from the middle of the patient
}

bool Posture::holding(const Surgeon& op) const {
  return held_arc(op.model(), op.state(), size_t(m_hand), m_aim.strand) > m_aim.beyond;
}

double Posture::pull(const Surgeon& op) const { return norm(op.tool_state(m_hand).pull); }

double Posture::slant(Surgeon& op, double s) const {
  return dot(normalised(op.point(m_aim.strand, s) - op.arm(m_aim.across).port), op.tangent(m_aim.strand, s));
}

void Posture::keep(Surgeon& op, double s) {
  if (!holding(op)) return;
  if (m_aim.slant > 0) return keep_slanted(op, s);
  constexpr double kHighest = 0.040, kFarthest = 0.020, kPace = 0.010;  // [m] [m] [m/s]
  constexpr double kLevel = 0.03;                                       // [rad] of slope that is let be
  const double now = pull(op), slope = slant(op, s);
  double rise = std::fabs(slope) < kLevel ? 0 : std::clamp(6 * slope, -1.0, 1.0);  // the outer end dips: up
  double out = 0;
  if (now < m_aim.pull_low + 0.15) (slope < -kLevel ? out : rise) = 0.6;
  if (now > 0.7 * m_aim.pull_high) {
    rise = std::min(rise, 0.0);
    out = -0.6;
  }
  if (now > 0.9 * m_aim.pull_high) rise = -1;
  m_lifted = std::clamp(m_lifted + rise * kPace * sim::kTick, 0.0, kHighest);
  m_drawn = std::clamp(m_drawn + out * kPace * sim::kTick, std::min(0.0, m_drawn), kFarthest);
  op.arm(m_hand).tip = m_from + m_lifted * m_up + m_drawn * m_outwards;
}

void Posture::keep_slanted(Surgeon& op, double s) {
  // Pushed down instead of raised: it dips outwards, along the other shaft instead of across it.
  constexpr double kLowest = 0.045, kOut = 0.006, kPace = 0.010;  // [m] [m] [m/s]
  const double missing = m_aim.slant - slant(op, s);
  m_drawn = std::min(kOut, m_drawn + kPace * sim::kTick);
  m_lifted = std::clamp(m_lifted - std::clamp(10 * missing, -1.0, 1.0) * kPace * sim::kTick, -kLowest, 0.0);
  op.arm(m_hand).tip = m_from + Vec3d{0, 0, m_lifted} + m_drawn * m_outwards;
}

}  // namespace trocar::training
