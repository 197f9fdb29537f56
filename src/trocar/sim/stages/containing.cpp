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
  for (const SolidModel& s : model.solids)
    for (Vec3d p : s.network.rest) box.add(vec_cast<float>(p));
  for (int i = 0; i < model.organs(); ++i) add(model.skin(i), box);
  for (const interactions::StrandBody& b : model.strand_bodies)
    for (Vec3d p : b.model.rest) box.add(vec_cast<float>(p));
  for (const MembraneBody& m : model.membranes) add(m.skin, box);
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
