#include <algorithm>

#include <trocar/modeller/document/outline.hpp>
#include <trocar/modeller/operations/brush.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/modeller/picture/painted.hpp>
#include <trocar/scene/json/json_edit.hpp>

namespace trocar::modeller {

double Painted::at(Vec3d place) const {
  if (stiffness) return scene::stiffness_at(balls, place);
  return std::any_of(balls.begin(), balls.end(),
                     [&](const scene::StiffnessRegion& b) { return length(b.centre - place) < b.radius; });
}

Painted painted_on(const Document& document, const std::string& name, const std::string& what,
                   const std::string& bonds) {
  const Thing thing = thing_named(document, name);
  const scene::JsonValue value = value_of(document, thing);
  Painted out;
  out.stiffness = what == "stiffness";
  const std::string list = list_of_brush(value, thing.kind, what, bonds);
  const scene::JsonValue* items = list.empty() ? nullptr : scene::json_at(value, list);
  if (!items) return out;
  for (const scene::JsonValue& item : items->items) {
    const scene::JsonMember* centre = item.find("centre_mm");
    if (!centre || !is_point(centre->value)) continue;
    scene::StiffnessRegion ball;
    ball.centre = point_of(centre->value) * 1e-3;
    ball.radius = number_in(item, "radius_mm", 0) * 1e-3;
    ball.stiffness = number_in(item, "stiffness", 1);
    out.balls.push_back(ball);
  }
  return out;
}

}  // namespace trocar::modeller
