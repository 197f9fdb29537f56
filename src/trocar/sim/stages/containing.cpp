#include <trocar/sim/bodies/bodies.hpp>
#include <trocar/sim/stages/containing.hpp>

namespace trocar::sim {
namespace {

constexpr float kRoomAround = 0.03f;  // [m]

void add(const tissue::Skin& skin, tissue::Box& box) {
  for (int v = 0; v < skin.size(); ++v)
    if (skin.at_surface(v)) box.add(skin.rest[size_t(v)]);
}

}  // namespace

tissue::Box cavity_around(const Model& model) {
  tissue::Box box;
  const auto add_all = [&box](std::span<const Vec3d> places) {
    for (const Vec3d& p : places) box.add(vec_cast<float>(p));
  };
  visit_bodies(model,
               Overloaded{[&](SolidRef r) { add_all(network_of(model, r).rest), add(model_of(model, r).skin, box); },
                          [&](CuttableRef r) { add(model.skin(int(r.organ())), box); },
                          [&](StrandRef r) { add_all(rod_of(model, r).model.rest); },
                          [&](MembraneRef r) { add(model_of(model, r).skin, box); }});
  for (const WallModel& w : model.walls) add(w.skin, box);
  for (const HandModel& h : model.hands) box.add(vec_cast<float>(h.port));
  box.add(vec_cast<float>(model.scope.port));
  const Vec3f more{kRoomAround, kRoomAround, kRoomAround};
  return {box.low - more, box.high + more};
}

void clamp_to_cavity(StepContext& c) noexcept {
  visit_bodies(c.model, [&c](auto body) { clamp_to_cavity(c, body); });
}

}  // namespace trocar::sim
