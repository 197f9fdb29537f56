#include <trocar/sim/stages/posing.hpp>
#include <trocar/sim/stages/stage.hpp>

namespace trocar::sim {
namespace {

void pose_sheet(StepContext& c, size_t i) noexcept {
  const MembraneBody& m = c.model.membranes[i];
  const tissue::NodeView nodes = view_of(m.sheet.network, c.state.membranes[i].network);
  tissue::pose_skin(nodes, m.skin, c.work.sheet_poses[i]);
  c.work.sheets[i] = {{&m.skin, &c.work.sheet_poses[i], nodes},
                      c.state.torn[i],
                      m.sheet.network.fixed,
                      0.5 * m.sheet.thickness,
                      m.pinch_reach};
}

void pose_organ(StepContext& c, size_t i) noexcept {
  const size_t solids = c.model.solids.size();
  if (i < solids)
    tissue::pose_skin(c.work.nodes[i], *c.work.skins[i], c.work.poses[i]);
  else
    pose_cuttable(c, i - solids);
  const bool tears = i < c.model.solids.size() && c.model.solids[i].failure_strain > 0;
  c.work.surfaces[i] = {c.work.skins[i], &c.work.poses[i], c.work.nodes[i],
                        tears ? interactions::torn_beyond(c.model.solids[i].cell) : 0};
}

}  // namespace

void view_organs(StepContext& c) noexcept {
  for (int i = 0; i < c.model.organs(); ++i) c.work.nodes[size_t(i)] = nodes_of(c.model, c.state, i);
}

void pose_cuttable(StepContext& c, size_t i) noexcept {
  const size_t organ = c.model.solids.size() + i;
  tissue::make_current(c.model.cuttables[i].body, c.state.cuttables[i], c.work.cuttable_work[i]);
  tissue::update(c.model.cuttables[i].body, c.state.cuttables[i], c.work.cuttable_skins[i]);
  tissue::pose_skin(c.work.nodes[organ], *c.work.skins[organ], c.work.poses[organ]);
}

// Skins: x = W q, boxes.
void pose_skins(StepContext& c) noexcept {
  view_organs(c);
  const size_t organs = size_t(c.model.organs());
  for_each(c.work.pool, c.work.skin_order, [&c, organs](size_t i) noexcept {
    if (i < organs)
      pose_organ(c, i);
    else
      pose_sheet(c, i - organs);
  });
  for (size_t i = 0; i < c.model.walls.size(); ++i)
    c.work.surfaces[organs + i] = {&c.model.walls[i].skin, &c.model.walls[i].pose, {}};
}

}  // namespace trocar::sim
