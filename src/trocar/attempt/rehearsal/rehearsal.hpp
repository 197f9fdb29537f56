// Rehearsing a demonstration: what its hands meet is decided by tenths of a millimetre, so where it goes wrong it is
// taken up again a little earlier with another perturbation (training/expert/perturbation.hpp), and from further back
// each time that it goes wrong at the same point, until all of it succeeds. Nothing is simulated twice: at each
// decision point the process forks, and a copy that fails is forgotten. Steps are deterministic to the bit, so the
// choices are all that has to be kept.
#pragma once

#include <string>

#include <trocar/attempt/lesson.hpp>

namespace trocar::attempt {

/// When an attempt is given up, and when all is.
struct Patience {
  double points = 8;      ///< that errors cost in all, at most
  double seconds = 3000;  ///< of simulated time, all attempts together [s]
  bool at_first = false;  ///< a try that failed is one too many, though its goal may be tried again
};

struct Rehearsal {
  bool passed = false;
  training::Choices choices;  ///< with which it succeeded, or came furthest
  double score = 0;           ///< of 100
  double lasted = 0;          ///< the demonstration, or until it failed [s]
  double seconds = 0;         ///< simulated in all [s]
  int attempts = 0;
  std::string obstacle;  ///< why the one that came farthest failed; empty: it did not
};

/// What the exercise's file keeps for this anatomy is tried first. Told on stderr as it goes. The calling process must
/// have no other thread that holds locks.
/// @throws core::BadInput where nobody knows how the exercise is done, core::EnvironmentLacks
Rehearsal rehearse(const Lesson& lesson, const Patience& patience);

}  // namespace trocar::attempt
