// Rehearsing a demonstration: what its hands meet is decided by hundredths of a millimetre, so each part of the plan is
// tried in several ways (training/expert/ways.hpp) until all of it comes off. Nothing is simulated twice: where a part
// begins the process forks, and a copy that fails is forgotten. Steps are deterministic to the bit, so the numbers of
// the ways are all that has to be kept.
#pragma once

#include <string>

#include <trocar/attempt/lesson.hpp>
#include <trocar/training/expert/ways.hpp>

namespace trocar::attempt {

/// When a way is given up, and when all is.
struct Patience {
  int ways = 4;              ///< in which a part is tried before the one before it is done otherwise
  int failures = 20;         ///< of skills in a part
  double points = 4;         ///< that errors cost in a part, at most
  double seconds = 3000;     ///< of simulated time, all tries together [s]
  double demonstration = 0;  ///< that it may last; 0: as long as the exercise [s]
};

struct Rehearsal {
  bool passed = false;
  training::Ways ways;
  double score = 0;      ///< of 100
  double lasted = 0;     ///< the demonstration [s]
  double seconds = 0;    ///< simulated in all [s]
  int tries = 0;         ///< of parts
  std::string farthest;  ///< where it did not come off: the last part that was begun, and why it failed
};

/// Told on stderr as it goes. The calling process must have no other thread that holds locks.
/// @throws core::BadInput where nobody knows how the exercise is done, core::EnvironmentLacks
Rehearsal rehearse(const Lesson& lesson, const Patience& patience);

}  // namespace trocar::attempt
