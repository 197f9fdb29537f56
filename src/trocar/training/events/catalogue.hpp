// Vocabulary of exercises, as JSON for people and programs: every fact and every event with its arguments, and what a
// scene lacks for it.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <trocar/sim/model/model.hpp>

namespace trocar::training {

/// {"facts": [...], "events": [...]}. With a Model each says in "lacks" what the scene has not, where that is
/// something, and "names" lists what arguments may name there.
nlohmann::ordered_json catalogue(const sim::Model* model = nullptr);

}  // namespace trocar::training
