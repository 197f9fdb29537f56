#include <trocar/sim/bodies/bodies.hpp>
#include <trocar/sim/stages/posing.hpp>
#include <trocar/sim/stages/stage.hpp>

namespace trocar::sim {

void view_walls(StepContext& c) noexcept {
  const size_t organs = size_t(c.model.organs());
  for (size_t i = 0; i < c.model.walls.size(); ++i)
    c.work.surfaces[organs + i] = {&c.model.walls[i].skin, &c.model.walls[i].pose, {}};
}

void view_organs(StepContext& c) noexcept {
  for (int i = 0; i < c.model.organs(); ++i) c.work.organs[size_t(i)].nodes = nodes_of(c.model, c.state, i);
}

// Skins: x = W q, boxes.
void pose_skins(StepContext& c) noexcept {
  view_organs(c);
  for_each(c.work.pool, c.work.skin_order,
           [&c](size_t i) noexcept { visit_skinned(c.model, i, [&c](auto body) { pose(c, body); }); });
}

}  // namespace trocar::sim
