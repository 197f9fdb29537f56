// The expert who demonstrates an exercise: closed-loop, it looks at the State as an eye would (where is the tube, how
// does it lie, how hard do I pull, has the clip closed) and writes only Input, as hands do.
//
//   Surgeon surgeon(exercise, model);
//   while (!surgeon.done()) step(model, surgeon.next(model, state), state, work);
#pragma once

#include <array>
#include <string>

#include <trocar/sim/state.hpp>
#include <trocar/training/exercise.hpp>

namespace trocar::training {

class Surgeon {
 public:
  /// Throws core::BadInput when the scene lacks the exercise's strand or instruments.
  Surgeon(const Exercise& exercise, const sim::Model& model);

  /// The hands for this tick.
  sim::Input next(const sim::Model& model, const sim::State& state);

  bool done() const { return m_phase == Phase::finished; }
  bool gave_up() const { return m_gave_up; }
  /// What it is doing, in words: "approach the ampulla".
  const char* doing() const;

 private:
  enum class Phase {
    look,
    reach_ampulla,
    enter_ampulla,
    grasp,
    lift,
    reach_clip,
    enter_clip,
    close_clip,
    open_clip,
    leave_clip,
    reach_cut,
    enter_cut,
    close_cut,
    open_cut,
    leave_cut,
    finished
  };

  /// A hand's intention: where the tip is wanted, how the jaws are turned, how far the handle is closed.
  struct Hand {
    Vec3d tip;
    double roll = 0, handle = 0;
  };

  void go(Phase next);
  void steer(const sim::Model& model, const sim::State& state);
  void steer_clip(const sim::Model& model, const sim::State& state);
  void steer_cut(const sim::Model& model, const sim::State& state);
  void lift(const sim::Model& model, const sim::State& state);
  void follow_with_scope(const sim::Model& model, const sim::State& state, sim::Input& input);
  /// Moves hand `tool` so that the tube at arc length s would lie `inside` from the hinge, less `back` along the shaft.
  /// True when it is there.
  bool aim(const sim::Model& model, const sim::State& state, int tool, double s, double inside, double back,
           double speed);
  bool move_handle(int tool, double to, double seconds);

  Exercise m_exercise;
  Phase m_phase = Phase::look;
  double m_in_phase = 0;  ///< [s]
  bool m_gave_up = false;
  int m_tube = -1, m_grasper = -1, m_applier = -1, m_scissors = -1;
  int m_clips = 0;  ///< set so far
  std::array<double, 2> m_clip_at{};
  double m_cut_at = 0, m_grasp_at = 0;
  std::array<Hand, sim::kMaxTools> m_hand;
  Vec3d m_lift_from;
  double m_lifted = 0;
  sim::ScopeInput m_scope;
  Vec3d m_scope_tip;
};

}  // namespace trocar::training
