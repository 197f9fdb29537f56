// The demonstration of an exercise: reads the State as an eye would and writes only Input, as hands do.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <trocar/sim/model/state.hpp>
#include <trocar/sim/model/step_report.hpp>
#include <trocar/training/exercise/exercise.hpp>
#include <trocar/training/surgeon/arms.hpp>

namespace trocar::training {

/// How an expert works.
struct Manner {
  Tremor tremor;
  /// Asked at each decision point, by its number: the perturbation from there on (perturbation.hpp). Null: as the
  /// exercise's file says.
  std::function<int(int choice)> perturbation = {};
};

class Expert {
 public:
  virtual ~Expert() = default;

  /// The hands for this tick.
  virtual sim::Input next(const sim::Model& model, const sim::State& state) = 0;
  /// What the tick made of it.
  virtual void after(const sim::Model&, const sim::State&, const sim::StepReport&) {}
  virtual bool done() const = 0;
  virtual bool gave_up() const = 0;
  /// What it is doing, in words: "approach the tissue".
  virtual const char* doing() const = 0;
  /// The goal that it works on, for people; empty: none.
  virtual std::string goal() const { return {}; }
  /// Failed first tries, when and why; the first hundred.
  virtual const std::vector<std::string>& difficulties() const = 0;
};

/// Who performs the exercise's demonstration. Throws core::BadInput when its file has none, or the scene lacks what it
/// needs.
/// @param seed  of the anatomy: draws sets "by_seed"
std::unique_ptr<Expert> make_expert(const Exercise& exercise, const sim::Model& model, const Manner& manner = {},
                                    std::uint64_t seed = 0);

}  // namespace trocar::training
