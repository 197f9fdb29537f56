// Which hand loads the place where tissue or a thread has given way: it is charged with it.
//
// In this order:
//   1. hands that load the torn body itself: they hold it, press on it, stick to it, inject into it, or pull a thread
//      that goes through it. Each load counts less with its distance from the torn place
//   2. nobody, where a thread that no hand pulls loads the place much more than any hand (a knotted stitch)
//   3. hands that load a body that is attached to the torn one, or any body beside the torn place: loads pass on there
//   4. nobody
#pragma once

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Where a body gave way.
struct TornPlace {
  BodyId body;
  Vec3d at;         ///< [m]
  BodyId thread{};  ///< that was torn out there; none: it tore without
  double pull = 0;  ///< of that thread [N]
};

/// @return the hand that loads the place most; -1: no hand loads it. After the stage that collects reaction forces, or
/// of a thread that was torn out, before it: then loads of hands on tissue are those of the last tick
int culprit(const StepContext& context, const TornPlace& place) noexcept;

/// The hand that pulls a needle or a thread most, with jaws or as a loop's tube; -1: none pulls.
int puller_of(const StepContext& context, BodyId suture) noexcept;

/// Whose hand broke a thread: the one that pulls it; else the one that loads the tissue that it goes through; -1: none.
int breaker_of(const StepContext& context, BodyId suture) noexcept;

}  // namespace trocar::sim
