// What a compiled body takes in memory: counted from its arrays as they are, not from a formula.
#pragma once

#include <string>
#include <vector>

#include <trocar/scene/compile/compile.hpp>

namespace trocar::modeller {

/// Of every body of the report, in its order: its part of the Model and of one State as it begins, scratch of the step
/// and what is drawn from it beside [bytes]. Of vessels: the whole flow.
std::vector<std::size_t> memory_of_bodies(const sim::Model& model, const scene::CompileReport& report);

/// "820 kB", "1.4 MB"; of 1000 bytes each.
std::string memory_in_words(std::size_t bytes);

}  // namespace trocar::modeller
