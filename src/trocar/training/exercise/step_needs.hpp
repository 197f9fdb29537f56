// What a step takes: the endoscope, which hand, which verbs. Derived from its conditions and acts, never written down
// in an exercise. The window begins with what the first step needs, and names the keys of these verbs beside the hint.
//
//   const StepNeeds needs = needs_of(rules, rules.current(), {model, state});
//   if (needs.endoscope) control(kScope); else if (needs.hand >= 0) control(needs.hand);
#pragma once

#include <trocar/training/exercise/rules.hpp>

namespace trocar::training {

struct StepNeeds {
  bool endoscope = false;  ///< only what the picture shows counts
  int hand = -1;           ///< the hand that the step is about; -1: no single one
  bool grasp = false, clip = false, divide = false;
  bool energy = false;   ///< an electrode, so the foot switches
  bool suction = false;  ///< liquid has to be removed
  bool inject = false;
  bool declare = false;  ///< the trainee has to declare something
};

/// @param step  of the board; one beyond the last needs nothing
StepNeeds needs_of(const Rules& rules, int step, const Snapshot& snapshot);

/// Is anything declared in this exercise? Else the key for it does nothing.
bool asks_for_declaration(const Rules& rules);

}  // namespace trocar::training
