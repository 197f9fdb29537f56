// What an exercise's file says about how it is done, in one scene: to be performed, or to be changed before that.
//
//   Demonstration d = read_demonstration(exercise, model, seed);
//   Performer performer(model, std::move(d));
#pragma once

#include <trocar/training/exercise/monitor.hpp>
#include <trocar/training/expert/plan.hpp>

namespace trocar::training {

struct Demonstration {
  Plan plan;
  Choices choices;                       ///< that went well with this seed's anatomy
  std::unique_ptr<FactWatches> watches;  ///< the facts that its conditions ask for
  std::unique_ptr<Monitor> judge;        ///< who knows the steps that they ask for; null: they ask for none
};

/// Throws core::BadInput with all that the file says wrongly, and all that the scene lacks for it.
Demonstration read_demonstration(const Exercise& exercise, const sim::Model& model, std::uint64_t seed = 0);
/// The same for who only wants to know: nothing is simulated. @param model  null: all but what only a scene can tell
void check_demonstration(const Exercise& exercise, const sim::Model* model, Faults& faults, std::uint64_t seed = 0);

}  // namespace trocar::training
