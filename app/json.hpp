// Results are JSON objects that keep the order in which we say things.
#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

namespace trocar::app {

using Json = nlohmann::ordered_json;

/// Prints one JSON object and a newline on standard output.
void print(const Json& object);

/// 16 hex digits.
std::string hex(std::uint64_t hash);

}  // namespace trocar::app
