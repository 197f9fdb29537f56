#include <trocar/interactions/verbs/adhesion.hpp>

namespace trocar::interactions {
namespace {

constexpr HoldLaw kStuck{500, 0.5};  // Our choice: 2 N tear it off 4 mm away

Vec3d target_of(const ToolShape& shape, const Hold& stuck) noexcept {
  return from_jaw(shape, {stuck.local[0], stuck.local[1], stuck.local[2]});
}

}  // namespace

Hold stuck_at(const ToolShape& shape, const Bodies& bodies, const MaterialPoint& point) noexcept {
  const Vec3d local = to_jaw(shape, held_point(bodies, point));
  return {point, {float(local.x), float(local.y), float(local.z)}, {}};
}

double stuck_pull(const ToolShape& shape, const Bodies& bodies, const Hold& stuck) noexcept {
  return kStuck.stiffness * length(target_of(shape, stuck) - held_point(bodies, stuck.at));
}

void stuck_load(const ToolShape& shape, int tool_index, const Bodies& bodies, const Hold& stuck) noexcept {
  pull_to(bodies, stuck.at, target_of(shape, stuck), kStuck, {Owner::tool_contact, tool_index, 0});
}

}  // namespace trocar::interactions
