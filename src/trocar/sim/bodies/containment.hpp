// Nothing leaves the cavity: what has is slowed down and turned back.
#pragma once

#include <trocar/tissue/network/network.hpp>
#include <trocar/tissue/network/skin.hpp>
#include <trocar/tissue/strand/strand.hpp>

namespace trocar::sim {

/// Of a body of springs: a part of its rows is looked at, in turn, and all of them where one of those has left.
void turn_back(const tissue::Box& cavity, std::span<const int> row_of_node, Vec3d origin, std::uint64_t tick,
               std::span<tissue::NodeState> rows) noexcept;
void turn_back(const tissue::Box& cavity, tissue::StrandState& strand) noexcept;

}  // namespace trocar::sim
