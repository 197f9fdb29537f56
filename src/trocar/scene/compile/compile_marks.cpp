#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/scene/compile/compile_marks.hpp>

namespace trocar::scene {
namespace {

constexpr double kMarkReach = 0.010;  // [m] from a disc's place to what it lies on

struct SkinPlace {
  std::array<std::int32_t, 3> vertex{};
  Vec3d weight, point, normal;
  double distance = 1e9;
};

/// The nearest place of a skin in the drawn shape.
SkinPlace nearest_on(const tissue::Skin& skin, Vec3d p) {
  SkinPlace best;
  for (const auto& t : skin.triangles) {
    const auto x = [&](size_t k) { return vec_cast<double>(skin.rest[size_t(t[k])]); };
    const auto at = geometry::closest_on_triangle(p, x(0), x(1), x(2));
    if (at.distance2 >= best.distance * best.distance) continue;
    best = {{t[0], t[1], t[2]}, at.weights, at.point, {}, std::sqrt(at.distance2)};
    best.normal = normalised(cross(x(1) - x(0), x(2) - x(0)));
  }
  return best;
}

/// Null: it is neither an organ nor a wall nor a pouch.
const tissue::Skin* skin_of(const sim::Model& model, const std::string& name, sim::MarkModel& mark) {
  mark.body = model.organ_index(name);
  mark.on = sim::MarkModel::organ;
  if (mark.body >= 0) return &model.skin(mark.body);
  mark.on = sim::MarkModel::membrane;
  for (const sim::MembraneBody& membrane : model.membranes)
    if (++mark.body; membrane.name == name && membrane.sheet.closed()) return &membrane.skin;
  mark.body = -1;
  mark.on = sim::MarkModel::space;  // walls do not move
  for (const sim::WallModel& wall : model.walls)
    if (wall.name == name) return &wall.skin;
  return nullptr;
}

void lay(const MarkSetting& setting, const sim::Model& model, sim::MarkModel& mark, std::vector<core::Fault>& faults) {
  const tissue::Skin* skin = skin_of(model, setting.on, mark);
  if (!skin) return;  // the reader has told
  const SkinPlace at = nearest_on(*skin, setting.place);
  if (at.distance > kMarkReach)
    faults.push_back({setting.at, tr("expected a place within {:.0f} mm of \"{}\", got one {:.1f} mm away",
                                     kMarkReach * 1000, setting.on, at.distance * 1000)});
  mark.place = at.point;
  if (!(length(setting.normal) > 0)) mark.normal = at.normal;
  if (mark.body < 0) return;
  mark.vertex = at.vertex;
  mark.weight = at.weight;
}

void go_around(const MarkSetting& setting, const sim::Model& model, sim::MarkModel& mark) {
  mark.body = model.strand_index(setting.on);
  if (mark.body < 0) return;
  const interactions::StrandBody& body = model.strand_bodies[size_t(mark.body)];
  mark.on = sim::MarkModel::strand;
  mark.s = std::min(setting.s, body.length());
  mark.at = interactions::place_at(body, mark.s);
}

}  // namespace

void compile_marks(const Description& d, sim::Model& model, std::vector<core::Fault>& faults) {
  for (const MarkSetting& setting : d.marks) {
    sim::MarkModel mark;
    mark.name = setting.name;
    mark.label = setting.label;
    mark.colour = setting.colour;
    mark.look = setting.look;
    mark.high = setting.high;
    mark.place = setting.place;
    mark.normal = normalised(setting.normal, mark.normal);
    mark.half = 0.5 * setting.size;
    if (setting.stripe) {
      go_around(setting, model, mark);
    } else if (!setting.on.empty()) {
      lay(setting, model, mark, faults);
    }
    model.marks.push_back(std::move(mark));
  }
}

}  // namespace trocar::scene
