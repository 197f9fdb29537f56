// Which bodies are drawn attached to which.
#pragma once

#include <trocar/core/body_id.hpp>
#include <trocar/sim/model/model.hpp>

namespace trocar::sim {

/// Is a membrane held by the other body, or does a rod end there?
bool is_attached(const Model& model, BodyId body, BodyId other) noexcept;

}  // namespace trocar::sim
