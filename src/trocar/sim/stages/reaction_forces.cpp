#include <trocar/sim/bodies/suture.hpp>
#include <trocar/sim/stages/instruments.hpp>
#include <trocar/sim/stages/reaction_forces.hpp>
#include <trocar/sim/stages/stage.hpp>

namespace trocar::sim {
namespace {

using interactions::Owner;

void add_force(double (&sum)[3], Vec3d f) noexcept {
  sum[0] += f.x;
  sum[1] += f.y;
  sum[2] += f.z;
}

void account(StepContext& c, interactions::Tag tag, Vec3d force) noexcept {
  if (tag.owner == Owner::tool_contact) {
    add_force(c.state.tools[size_t(tag.index)].contact_force, -force);
    interactions::press_on(c.work.touches[size_t(tag.index)], tag.sub, force);
  }
  if (tag.owner != Owner::tool_hold) return;
  float(&on_tissue)[3] = c.state.tools[size_t(tag.index)].hold[tag.sub].force;
  on_tissue[0] += float(force.x);
  on_tissue[1] += float(force.y);
  on_tissue[2] += float(force.z);
}

void account(StepContext& c, const interactions::NetworkLoads& loads) noexcept {
  for (size_t i = 0; i < loads.sorted.size(); ++i) account(c, loads.owner[i], vec_cast<double>(loads.reaction[i]));
}

}  // namespace

void collect_reaction_forces(StepContext& c) noexcept {
  for (interactions::ToolState& tool : c.state.tools) {
    for (double& f : tool.contact_force) f = 0;
    for (interactions::Hold& h : tool.hold) h.force[0] = h.force[1] = h.force[2] = 0;
  }
  for (const interactions::StrandBodyWork& w : c.work.strands)
    for (size_t i = 0; i < w.loads.list.size(); ++i) account(c, w.loads.tag[i], w.loads.reaction[i]);
  for (const interactions::OrganWork& w : c.work.organs) account(c, w.loads);
  for (const interactions::MembraneBodyWork& w : c.work.membranes) account(c, w.loads);
  interactions::ObjectKinds::for_each([&c](auto kind) {
    kind.account(interactions::part_of<decltype(kind)>(c.work), kTick,
                 [&c](interactions::Tag tag, Vec3d force) { account(c, tag, force); });
  });
  feel_instruments(c);
  const interactions::Bodies bodies = bodies_of(c);
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    interactions::ToolState& tool = c.state.tools[t];
    const interactions::WallStop& wall = c.work.wall_stops[t];
    if (wall.stopped) add_force(tool.contact_force, wall.force * wall.normal);
    const int held = tool.holds, slips = tool.slipped;
    slip_in_jaws(c, t);
    interactions::slip(c.model.tool(c.state, t), c.work.shapes[t], bodies, tool);
    if (held > 0 && tool.holds == 0) emit_grip_end(c, t, slips);
    interactions::remember(tool, joints_of(c.state, t), c.work.touches[t], c.state.touches[t], port_shift(c.state, t));
  }
}

}  // namespace trocar::sim
