// Where clips belong on a tube, and which of them count. The judge, the scripted surgeon and the outlook for learners
// ask the same questions.
#pragma once

#include <trocar/interactions/couplings/strand_body.hpp>
#include <trocar/training/exercise/exercise.hpp>

namespace trocar::training {

/// Set rightly, wherever on the isthmus it is: across, closed slowly, in view, around the whole tube.
bool well_set(const Sterilisation& goal, const interactions::Clip& clip);

/// A place of the first or of the second clip. @param s  from the cornu [m]
bool place_of_a_clip(const Sterilisation& goal, double s);

/// Two clips, each in its place and as far apart as they should be.
bool are_a_pair(const Sterilisation& goal, double inner, double outer);

}  // namespace trocar::training
