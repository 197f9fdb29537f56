// Points of bodies that instruments hold or stick to: where they are, drawn and now, how they are pulled, and how they
// keep jaws apart. Tissue is held at material points; objects that are no tissue know their places by number.
#pragma once

#include <trocar/interactions/bodies/bodies.hpp>
#include <trocar/interactions/instrument/tool.hpp>
#include <trocar/interactions/objects/object_kinds.hpp>

namespace trocar::interactions {

/// Where a held point is now [m].
Vec3d held_point(const Bodies& bodies, const MaterialPoint& point) noexcept;
/// Where it was drawn, in its body's frame of heat [m].
Vec3d drawn_point(const Bodies& bodies, const MaterialPoint& point) noexcept;
/// Does it keep its shape between jaws? Objects do.
inline bool is_hard(BodyId body) noexcept {
  bool hard = false;
  visit_object(body, [&hard](auto kind) { hard = kind.kRigidInJaws; });
  return hard;
}
/// Is it a place of its body any more?
bool is_whole(const Bodies& bodies, const MaterialPoint& point) noexcept;

/// Pulls a held point towards `target` [m].
void pull_to(const Bodies& bodies, const MaterialPoint& point, Vec3d target, HoldLaw law, Tag tag) noexcept;

/// How thick what is held keeps jaws apart [m].
double held_thickness(const Bodies& bodies, const MaterialPoint& point) noexcept;
/// How far beside the jaws it may be held [m].
double held_reach(const Bodies& bodies, BodyId body) noexcept;

}  // namespace trocar::interactions
