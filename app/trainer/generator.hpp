// What the generator's panel reads, in words for people.
#pragma once

#include <string>
#include <vector>

#include <trocar/sim/model/state.hpp>

namespace trocar::app {

struct GeneratorLine {
  std::string text;
  bool on = false;       ///< current flows
  bool warning = false;  ///< a hot tip touches, or sticks
};
/// The presets, then a line for each hand that has an electrode; none in scenes without a generator.
std::vector<GeneratorLine> generator_lines(const sim::Model& model, const sim::State& state);

}  // namespace trocar::app
