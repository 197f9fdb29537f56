// Springs from an organ's nodes to space: the fat and folds that carry it and are no bodies themselves.
#pragma once

#include <trocar/interactions/bodies/loads.hpp>
#include <trocar/sim/bodies/breathing.hpp>

namespace trocar::sim {

/// @param by_breath  how far what they hang from has been carried
void hang(std::span<const tissue::Anchor> anchors, size_t organ, const Carried& by_breath,
          interactions::NetworkLoads& loads) noexcept;

}  // namespace trocar::sim
