// Following a tube from its fimbriae back to the uterus, with the eye or with an instrument's tip: how a tube is told
// from the ligaments beside it. The followed place moves along the tube no faster than an eye can, over what is in view
// or near a tip; a short covered stretch is skipped; lost for too long, it starts over at the fimbriae.
#pragma once

#include <span>
#include <vector>

#include <trocar/sim/model/state.hpp>
#include <trocar/training/exercise/exercise.hpp>

namespace trocar::training {

class Following {
 public:
  Following() = default;
  /// @param strand  a tube with a landmark "fimbria" and a visibility target "NAME.trace"
  Following(const Sterilisation& goal, const sim::Model& model, int strand);

  /// Once a sample. @param tips  of instruments that are in the body; @param dt  since the last call [s]
  void update(const sim::Model& model, const sim::State& state, std::span<const Vec3d> tips, double dt);

  bool done() const { return m_done; }
  bool begun() const { return m_front >= 0; }
  double reached() const;  ///< arc length of the followed place [m]; the tube's length before it has begun

 private:
  bool followed(const sim::Model& model, const sim::State& state, std::span<const Vec3d> tips, int sample) const;

  double m_to = 0, m_speed = 0, m_gap = 0, m_pause = 0, m_touch = 0;
  int m_strand = -1, m_target = -1, m_fimbria = -1;
  std::vector<double> m_arc;  ///< of the trace's samples, rising [m]
  int m_first = 0;            ///< sample at the fimbriae, where following begins
  int m_front = -1;
  double m_credit = 0, m_lost_for = 0;
  bool m_done = false;
};

}  // namespace trocar::training
