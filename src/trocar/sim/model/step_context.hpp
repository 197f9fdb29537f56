// What every stage of a step is given.
#pragma once

#include <trocar/sim/model/step_report.hpp>
#include <trocar/sim/model/work.hpp>

namespace trocar::sim {

struct StepContext {
  const Model& model;
  const Input& input;
  State& state;
  Work& work;
  StepReport& report;
};

}  // namespace trocar::sim
