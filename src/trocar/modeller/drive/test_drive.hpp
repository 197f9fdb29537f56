// A document's bodies as they move: the real simulation, and a grasper that goes where it is told, takes hold and
// pulls.
//
//   TestDrive drive(*built.model);
//   drive.take(at);                 // the grasper goes there and closes
//   while (!drive.done()) drive.tick();
//   drive.pull_to(at + Vec3d{0, 0, 0.02});
#pragma once

#include <string>

#include <trocar/sim/model/state.hpp>
#include <trocar/sim/model/work.hpp>
#include <trocar/sim/stages/step.hpp>

namespace trocar::modeller {

class TestDrive {
 public:
  explicit TestDrive(const sim::Model& model);

  /// The hand that works; at first one with a grasper. -1: the scene has none.
  int hand() const { return m_hand; }
  /// Another instrument works from now on, exchanged first where it is not in a hand. False: no hand has it.
  bool choose(const std::string& instrument);
  /// Goes there with open jaws, from its trocar, and closes them [m]: holds, cuts, or clips, as the instrument does.
  void take(Vec3d at);
  /// Draws what it holds there, at most as fast as a hand does [m].
  void pull_to(Vec3d at) { m_goal = at; }
  void let_go();
  void tick();
  /// Blood that has left vessels so far [m^3].
  double blood_lost() const;
  /// Nothing that was asked for is still under way.
  bool done() const;

  bool holds() const;
  double pull() const;  ///< of what it holds [N]; 0: nothing
  Vec3d tip() const;
  const sim::State& state() const { return m_state; }

 private:
  enum class Phase { rest, change, approach, close, pull, open };

  const sim::Model& m_model;
  sim::State m_state;
  sim::Work m_work;
  sim::Input m_input;
  Phase m_phase = Phase::rest;
  int m_hand = -1, m_instrument = 0;
  double m_handle = 0;  ///< 1 closed
  double m_since = 0;   ///< of this phase [s]
  Vec3d m_port, m_at, m_goal, m_tip;
};

}  // namespace trocar::modeller
