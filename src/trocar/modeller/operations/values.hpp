// What operations write: numbers as a person would type them, in millimetres.
#pragma once

#include <vector>

#include <trocar/numerics/vec3.hpp>
#include <trocar/scene/json/json.hpp>
#include <trocar/scene/json/json_text.hpp>

namespace trocar::modeller {

/// To a ten-thousandth: finer than any tissue is known, and short in a file.
scene::JsonValue number(double value);
scene::JsonValue point(Vec3d value);
scene::JsonValue points(const std::vector<Vec3d>& values);

bool is_point(const scene::JsonValue& value);   ///< three numbers
Vec3d point_of(const scene::JsonValue& value);  ///< of one that is
std::vector<Vec3d> points_of(const scene::JsonValue& value);

/// The member's number, else the fallback.
double number_in(const scene::JsonValue& object, std::string_view key, double fallback);

}  // namespace trocar::modeller
