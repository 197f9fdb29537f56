// Results are JSON objects that keep the order in which we say things.
#pragma once

#include <nlohmann/json.hpp>

namespace trocar {

using Json = nlohmann::ordered_json;

}  // namespace trocar
