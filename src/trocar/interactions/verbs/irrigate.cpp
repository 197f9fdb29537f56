#include <algorithm>

#include <trocar/interactions/verbs/irrigate.hpp>

namespace trocar::interactions {
namespace {

/// Jaws of this kind are round rods that lie together: their ends are the tube's.
Vec3d end_of(const ToolModel& tool, const ToolShape& shape) noexcept {
  return shape.frame.tip + (0.5 * tool.jaw_thickness) * shape.frame.axis();
}

}  // namespace

Bore bore_of(const ToolModel& tool, const ToolShape& now, const ToolShape& before, double dt) noexcept {
  const Vec3d end = end_of(tool, now);
  return {end, now.frame.axis(), (end - end_of(tool, before)) / dt};
}

fluids::Capsule tube_of(const ToolModel& tool, const ToolShape& now, const ToolShape& before, double dt) noexcept {
  const Bore bore = bore_of(tool, now, before, dt);
  fluids::Capsule tube;
  tube.a = vec_cast<float>(now.part[kShaft].a);
  tube.b = vec_cast<float>(bore.end - tool.shaft_radius * bore.axis);
  tube.radius = float(tool.shaft_radius);
  tube.va = vec_cast<float>((now.part[kShaft].a - before.part[kShaft].a) / dt);
  tube.vb = vec_cast<float>(bore.velocity);
  return tube;
}

MaterialPoint film_point(const Bodies& bodies, std::span<const std::int32_t> first, const WetOrder& order,
                         std::int32_t body, std::int32_t place) noexcept {
  if (body < 0 || body + 1 >= std::int32_t(first.size())) return {};
  const std::int32_t number = place - first[std::size_t(body)];
  if (number < 0 || place >= first[std::size_t(body) + 1]) return {};
  const std::size_t i = order.index(body);
  if (order.is_surface(body)) {
    if (i >= bodies.organ_count() || number >= skin_of(bodies, i).size()) return {};
    return on_vertex(bodies, i, number);
  }
  if (order.is_sheet(body)) return at_node(bodies, BodyId::membrane(i), number / 2);
  const std::int32_t last = bodies.strand(i).nodes() - 2;
  return at_element(bodies, i, std::min(number, last), number > last ? 1 : 0, {});
}

}  // namespace trocar::interactions
