// Hands that measure how an organ gives way: one instrument goes to where the organ faces its trocar best
// (the middle of a triangle, as a thin tip slips off vertices),
// presses in along the surface's inward normal in steps, holds, and withdraws. All others stay where they were placed.
//
//   PressSource hands(model, plan_press(model, organ, 0.05 * organ_size(model, organ)));
//   while (hands.next(state, input)) sim::step(model, input, state, work);
#pragma once

#include <trocar/attempt/lesson.hpp>

namespace trocar::attempt {

/// Edge of the cube that is as large as the box around its drawn skin [m].
double organ_size(const sim::Model& model, int organ);

struct Press {
  int organ = -1, hand = -1;
  int triangle = -1;  ///< of the skin that is touched
  Vec3d at;           ///< its middle, in the drawn shape [m]
  Vec3d out;          ///< unit, the surface's normal there
  double depth = 0;   ///< how far the instrument's front goes in, from where it touches [m]
  bool clear = true;  ///< nothing that is drawn lies on its way
};
/// The first hand that can reach, at the triangle that gives way whose normal points to its trocar best and to which
/// the way is clear.
/// @throws core::BadInput where none can
Press plan_press(const sim::Model& model, int organ, double depth);

class PressSource : public InputSource {
 public:
  PressSource(const sim::Model& model, const Press& press);
  bool next(const sim::State& state, sim::Input& input) override;
  Json describe() const override;

  /// Pressed in fully, and at rest?
  bool settled() const;

 private:
  enum class Phase { back, swing, forth, down, in, out, over };
  void go_on(Phase phase);
  bool turn_to(Vec3d target);
  void go_there();
  void go_down(const sim::State& state);
  void go_in();
  void go_out();
  void aim();

  const sim::Model& m_model;
  Press m_press;
  sim::Input m_input;
  kinematics::FulcrumPose m_pose;  ///< wanted
  Phase m_phase = Phase::back;
  int m_ticks = 0;      ///< in this phase
  double m_front = 0;   ///< tip to front [m]
  double m_offset = 0;  ///< of the front from where it touches, outside > 0 [m]
  Vec3d m_touched;      ///< where the skin was then [m]
};

}  // namespace trocar::attempt
