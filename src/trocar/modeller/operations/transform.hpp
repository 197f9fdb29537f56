// Things moved, turned, scaled and mirrored: every place, direction and length that their texts hold.
#pragma once

#include <functional>

#include <trocar/numerics/vec3.hpp>
#include <trocar/scene/json/json.hpp>

namespace trocar::modeller {

/// What a number or three in a file mean to a movement of space.
enum class Role { none, place, vector, length };
Role role_of(std::string_view key, const scene::JsonValue& value);

/// What becomes of them [mm].
struct Movement {
  std::function<Vec3d(Vec3d)> place, vector;
  double length = 1;     ///< factor
  bool mirrors = false;  ///< right hands become left ones
};
/// Calls `put` with the path (from `path` on) and the new value of all that changes.
void moved_values(const scene::JsonValue& value, const std::string& path, const Movement& movement,
                  const std::function<void(std::string path, scene::JsonValue value)>& put);

/// In place, by a vector [mm].
void move_value(scene::JsonValue& value, Vec3d by);

/// The middle of all places in it [mm]; 0 where there is none.
Vec3d middle_of(const scene::JsonValue& value);

}  // namespace trocar::modeller
