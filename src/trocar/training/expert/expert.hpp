// Whoever demonstrates an exercise: reads the State as an eye would and writes only Input, as hands do.
#pragma once

#include <memory>
#include <string>

#include <trocar/sim/model/state.hpp>
#include <trocar/training/exercise/exercise.hpp>
#include <trocar/training/expert/arms.hpp>

namespace trocar::training {

/// How an expert works. A flaw is the code of an error that it makes once (tests; empty: none).
struct Manner {
  Tremor tremor;
  std::string flaw;
};

class Expert {
 public:
  virtual ~Expert() = default;

  /// The hands for this tick.
  virtual sim::Input next(const sim::Model& model, const sim::State& state) = 0;
  virtual bool done() const = 0;
  virtual bool gave_up() const = 0;
  /// What it is doing, in words: "approach the ampulla".
  virtual const char* doing() const = 0;
};

/// The one who knows this kind of exercise. Throws core::BadInput when the scene lacks what the exercise names, or a
/// hand the instrument it needs.
std::unique_ptr<Expert> make_expert(const Exercise& exercise, const sim::Model& model, const Manner& manner = {});

}  // namespace trocar::training
