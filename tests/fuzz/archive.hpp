// Several text files in one input: each begins with a line "=== NAME"; what stands before the first such line is the
// file main.json.
#pragma once

#include <trocar/scene/json/json.hpp>

#include "target.hpp"

namespace trocar::fuzz {

inline constexpr const char* kMainFile = "main.json";

scene::MemoryFiles unpacked(std::string_view archive);
std::string packed(const scene::MemoryFiles& files);

}  // namespace trocar::fuzz
