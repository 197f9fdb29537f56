// Who knows one kind of exercise: watches its steps and its own errors, and writes both on the board.
#pragma once

#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include <trocar/sim/stages/step.hpp>
#include <trocar/training/exercise/scoreboard.hpp>

namespace trocar::training {

class Judge {
 public:
  virtual ~Judge() = default;

  /// After every tick, when what the hands did wrong is on the board.
  virtual void tick(const sim::Model& model, const sim::State& state, const sim::StepReport& report) = 0;
  /// Every `dt` [s]. @param tips  of the hands' instruments [m]
  virtual void sample(const sim::Model& model, const sim::State& state, std::span<const Vec3d> tips, double dt) = 0;

  /// Number of the step to be done next; the number of steps when none is left.
  virtual int current() const = 0;
  /// Name of the side of the patient that a held body (interactions::Hold::body) belongs to; empty: of none.
  virtual const std::string& side_of_hold(std::int32_t body) const = 0;
  /// Adds what it found out to the result.
  virtual void tell(nlohmann::ordered_json& result) const = 0;
};

}  // namespace trocar::training
