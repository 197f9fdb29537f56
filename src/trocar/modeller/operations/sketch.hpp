// Lines drawn on a body's surface: each point is laid on the nearest place of it.
#pragma once

#include <vector>

#include <trocar/modeller/operations/operation.hpp>

namespace trocar::modeller {

/// Keys for operations that draw lines: "sketched_on" and "lift_mm".
std::vector<scene::Key> sketch_keys();

/// The points [mm], laid on the surface where the step says so; a body without a surface is told through `o`.
std::vector<Vec3d> sketched(const scene::JsonObject& o, const Draft& draft, std::vector<Vec3d> points);

}  // namespace trocar::modeller
