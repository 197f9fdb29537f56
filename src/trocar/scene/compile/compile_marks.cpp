#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/scene/compile/compile_marks.hpp>
#include <trocar/sim/model/attach_near.hpp>

namespace trocar::scene {
namespace {

constexpr double kMarkReach = 0.010;  // [m] from a disc's place to what it lies on

struct OnSkin {
  std::int32_t vertex = -1;  ///< next to it
  Vec3d point, normal;
  double distance = 1e9;
};

/// The nearest place of a skin in the drawn shape.
OnSkin nearest_on(const tissue::Skin& skin, Vec3d p) {
  OnSkin best;
  for (const auto& t : skin.triangles) {
    const auto x = [&](size_t k) { return vec_cast<double>(skin.rest[size_t(t[k])]); };
    const auto at = geometry::closest_on_triangle(p, x(0), x(1), x(2));
    if (at.distance2 >= best.distance * best.distance) continue;
    const double w[] = {at.weights.x, at.weights.y, at.weights.z};
    best = {t[size_t(std::max_element(w, w + 3) - w)], at.point, normalised(cross(x(1) - x(0), x(2) - x(0))),
            std::sqrt(at.distance2)};
  }
  return best;
}

/// What a disc can lie on; null: it is neither an organ nor a wall nor a pouch. Walls do not move: that is space.
const tissue::Skin* skin_of(const sim::Model& model, const std::string& name, BodyId& body) {
  if (const int organ = model.organ_index(name); organ >= 0) {
    body = BodyId::organ(size_t(organ));
    return &model.skin(organ);
  }
  if (const int i = model.membrane_index(name); i >= 0 && model.membranes[size_t(i)].sheet.closed()) {
    body = BodyId::membrane(size_t(i));
    return &model.membranes[size_t(i)].skin;
  }
  for (const sim::WallModel& wall : model.walls)
    if (wall.name == name) return &wall.skin;
  return nullptr;
}

void lay(const MarkSetting& setting, const sim::DrawnBodies& drawn, sim::MarkModel& mark,
         std::vector<core::Fault>& faults) {
  BodyId body;
  const tissue::Skin* skin = skin_of(drawn.model(), setting.on, body);
  if (!skin) return;  // the reader has told
  const OnSkin at = nearest_on(*skin, setting.place);
  if (at.distance > kMarkReach)
    faults.push_back({setting.at, tr("expected a place within {:.0f} mm of \"{}\", got one {:.1f} mm away",
                                     kMarkReach * 1000, setting.on, at.distance * 1000)});
  mark.place = at.point;
  if (!(length(setting.normal) > 0)) mark.normal = at.normal;
  mark.at = body.is(BodyKind::organ) ? at_vertex(drawn.all(), body.index(), at.vertex, at.point)
            : body.exists()          ? attach(drawn.all(), body, at.point)
                                     : interactions::in_space(at.point);
}

void go_around(const MarkSetting& setting, const sim::DrawnBodies& drawn, sim::MarkModel& mark) {
  const int rod = drawn.model().strand_index(setting.on);
  if (rod < 0) return;
  const interactions::StrandBody& body = drawn.model().strand_bodies[size_t(rod)];
  mark.s = std::min(setting.s, body.length());
  const interactions::StrandPlace at = interactions::place_at(body, mark.s);
  mark.at = at_element(drawn.all(), size_t(rod), at.element, at.w, {});
}

}  // namespace

void compile_marks(const Description& d, sim::Model& model, std::vector<core::Fault>& faults) {
  const sim::DrawnBodies drawn(model);
  for (const MarkSetting& setting : d.marks) {
    sim::MarkModel mark;
    mark.name = setting.name;
    mark.label = setting.label;
    mark.colour = setting.colour;
    mark.look = setting.look;
    mark.high = setting.high;
    mark.place = setting.place;
    mark.at = interactions::in_space(setting.place);
    mark.normal = normalised(setting.normal, mark.normal);
    mark.half = 0.5 * setting.size;
    if (setting.stripe) {
      go_around(setting, drawn, mark);
    } else if (!setting.on.empty()) {
      lay(setting, drawn, mark, faults);
    }
    model.marks.push_back(std::move(mark));
  }
}

}  // namespace trocar::scene
