// What a hand holds up while other hands work: a strand, so that a place of it lies across another instrument's shaft
// under a gentle pull.
#pragma once

#include <trocar/numerics/vec3.hpp>

namespace trocar::training {

class Surgeon;

/// Two things to hold at once: the place across the other shaft (raising turns it), and a gentle pull on it (drawing it
/// outwards stretches it).
class Posture {
 public:
  /// How it shall lie.
  struct Aim {
    int strand = -1;
    double beyond = 0;                   ///< held nearer to the beginning than this it is no longer presented [m]
    int across = -1;                     ///< the hand whose shaft it shall lie across
    double pull_low = 0, pull_high = 0;  ///< [N]
    double slant = 0;                    ///< sine of the angle by which it dips outwards instead of lying across
  };

  void begin(Surgeon& op, int hand, const Aim& aim, double held_at, double inner);
  void end() { m_hand = -1; }
  bool up() const { return m_hand >= 0; }
  const Aim& aim() const { return m_aim; }
  Vec3d from() const { return m_from; }  ///< where the tip was when it began [m]

  bool holding(const Surgeon& op) const;
  double pull(const Surgeon& op) const;       ///< [N]
  double slant(Surgeon& op, double s) const;  ///< of the strand at s to the other shaft; + when it dips outwards
  void keep(Surgeon& op, double s);

 private:
  void keep_slanted(Surgeon& op, double s);

  Aim m_aim;
  int m_hand = -1;
  Vec3d m_from, m_up, m_outwards;
  double m_lifted = 0, m_drawn = 0;  ///< how far it was raised and drawn outwards [m]
};

}  // namespace trocar::training
