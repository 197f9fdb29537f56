// What fat still does to what lies in it: what it covers, and what it ties to what.
#pragma once

#include <array>
#include <vector>

#include <trocar/sim/model/state.hpp>

namespace trocar::training {

/// A strand is bare at a place where it is free in so many of eight sectors around it.       shared figures:
/// docs/fat.md
inline constexpr int kSectors = 8, kBareSectors = 7;

/// The longest stretch of a strand along which it is bare [m].
double bared_length(const sim::Model& model, const sim::State& state, int strand);

/// The share of 64 sights across a triangle that meet no lobule. @param reach  to both sides of its plane [m]
double open_share(const sim::Model& model, const sim::State& state, const std::array<Vec3d, 3>& corners, double reach);

/// Bodies that fat, septum by septum, leads to from this one; without it.
std::vector<BodyId> bridged_from(const sim::Model& model, const sim::State& state, BodyId body);

/// The share of a body of fat that has not boiled away.
double fat_left(const sim::Model& model, const sim::State& state, BodyId fat);

}  // namespace trocar::training
