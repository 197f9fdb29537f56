#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/kinematics/fulcrum.hpp>
#include <trocar/scene/compile/compile_hands.hpp>
#include <trocar/scene/mechanisms/instrument_mechanism.hpp>
#include <trocar/sim/model/bodies.hpp>

namespace trocar::scene {
namespace {

interactions::ElectrodeModel electrode_of(const Instrument& i) {
  interactions::ElectrodeModel out;
  if (!i.can().coagulate) return out;
  out.there = true;
  if (i.can().bipolar) out.current = tissue::bipolar_jaws();
  out.current.radius = i.electrode.radius;
  out.current.efficiency = i.electrode.efficiency;
  out.current.stick_force = i.electrode.stick_force;
  if (i.electrode.seals > 0) (out.current.bipolar ? out.seal.pressed : out.seal.bare) = i.electrode.seals;
  return out;
}

interactions::NeedleModel needle_of(const Instrument& i) {
  interactions::NeedleModel out;
  if (!i.can().inject) return out;
  out.there = true;
  out.length = i.needle.length;
  out.radius = 0.5 * i.needle.diameter;
  out.bore = i.needle.bore;
  out.plunger = i.needle.plunger;
  out.holds = i.needle.holds;
  out.flow = i.needle.flow / 60;
  out.most_force = i.needle.most_force;
  out.units = i.needle.units;
  return out;
}

interactions::ToolModel tool_of(const Instrument& i, std::vector<core::Fault>& faults) {
  interactions::ToolModel tool;
  tool.name = i.name;
  tool.kind = i.kind;
  tool.shaft_radius = i.shaft_radius;
  tool.shaft_length = i.shaft_length;
  tool.jaw_length = i.jaw_length;
  tool.jaw_width = i.jaw_width;
  tool.jaw_thickness = i.jaw_thickness;
  tool.opening = i.opening;
  tool.parallel_gap = i.parallel_gap;
  tool.foot = i.foot;
  tool.pinch_max = i.pinch_max;
  tool.friction = i.friction;
  tool.clip_length = i.clip_length;
  tool.clips = i.clips;
  tool.electrode = electrode_of(i);
  tool.needle = needle_of(i);
  take_linkage(i, tool, faults);
  take_wrist(i, tool, faults);
  return tool;
}

template <class List>
const auto* named(const List& list, const std::string& name) {
  for (const auto& entry : list)
    if (entry.name == name) return &entry;
  return static_cast<decltype(list.data())>(nullptr);
}

constexpr double kPlay = 1e-4;  // [m] a shaft of the trocar's own nominal size fits

/// The placed instrument first, then the others in the scene's order.
/// @param tools  (instruments of the scene)
std::vector<interactions::ToolModel> rack_of(const std::vector<interactions::ToolModel>& tools,
                                             const Instrument& placed, const Port& port) {
  std::vector<interactions::ToolModel> rack;
  for (const interactions::ToolModel& tool : tools)
    if (tool.name == placed.name && rack.empty()) rack.push_back(tool);
  for (const interactions::ToolModel& tool : tools) {
    const bool fits = 2 * tool.shaft_radius <= port.diameter + kPlay;
    if (fits && tool.name != placed.name && rack.size() < size_t(sim::kMaxRack)) rack.push_back(tool);
  }
  for (interactions::ToolModel& tool : rack) tool.port = port.position;
  return rack;
}

/// It wanders across the instrument as that is placed: in the skin, nearly.
kinematics::PortModel give_of(const Port& port, const kinematics::TipFrame& placed) {
  kinematics::PortModel give{port.stiffness, port.drift, 0, {}};
  if (!give.moves()) return {};
  give.seed = port.seed;
  give.across[0] = any_perpendicular(placed.axis());
  give.across[1] = cross(placed.axis(), give.across[0]);
  return give;
}

const Tissue* tissue_named(const Description& d, const std::string& name) {
  const auto found = std::find_if(d.tissues.begin(), d.tissues.end(), [&](const Tissue& t) { return t.name == name; });
  return found == d.tissues.end() ? nullptr : &*found;
}

}  // namespace

void compile_hands(const Description& d, sim::Model& model, std::vector<core::Fault>& faults) {
  std::vector<interactions::ToolModel> tools;
  for (const Instrument& i : d.instruments) tools.push_back(tool_of(i, faults));
  for (const Placement& p : d.placements) {
    if (model.hands.size() == size_t(sim::kMaxTools)) {
      faults.push_back({p.at, "expected at most " + std::to_string(sim::kMaxTools) + " tools, got another"});
      return;
    }
    const Instrument* instrument = named(d.instruments, p.instrument);
    const Port* port = named(d.ports, p.port);
    if (!instrument || !port) continue;  // the reader has told
    const bool holds = !p.holds.empty();
    if (holds && !instrument->can().grip)
      faults.push_back(
          {p.at, tr("expected an instrument that grips where one holds '{}', got '{}'", p.holds, p.instrument)});
    model.start.tools[model.hands.size()] =
        sim::tool_input(kinematics::inverse(port->position, p.tip, p.roll), holds ? 1.0f : 0.0f);
    sim::HandModel& hand = model.hands.emplace_back();
    hand.name = port->name;
    hand.port = port->position;
    hand.seal_friction = port->seal_friction;
    hand.give = give_of(*port, kinematics::forward(port->position, pose_of(model.start.tools[model.hands.size() - 1])));
    hand.rack = rack_of(tools, *instrument, *port);
  }
  const Port* port = named(d.ports, d.scope_placement.port);
  model.scope.port = port ? port->position : Vec3d{};
  model.scope.angle = d.scope.angle;
  model.scope.field_of_view = d.scope.field_of_view;
  model.scope.shaft_radius = d.scope.shaft_radius;
  const kinematics::FulcrumPose pose =
      kinematics::inverse(model.scope.port, d.scope_placement.tip, d.scope_placement.roll);
  model.start.scope = {float(pose.yaw), float(pose.pitch), float(pose.roll), float(pose.depth), 0.0f};
}

bool has_needle(const sim::Model& model) {
  for (std::size_t t = 0; t < model.hands.size(); ++t)
    if (model.syringe_of(t) > 0) return true;
  return false;
}

void compile_injection(const Description& d, sim::Model& model) {
  if (!has_needle(model)) return;
  model.injection.organs.resize(std::size_t(model.organs()));
  // What has no cells, or cells that blades change, takes nothing up: no needle gets in.
  for (std::size_t i = 0; i < model.solids.size(); ++i) {
    const sim::SolidModel& solid = model.solids[i];
    const Tissue* tissue = tissue_named(d, solid.tissue);
    if (!tissue || solid.network.tets.empty()) continue;
    model.injection.organs[i].puncture = tissue->puncture;
    model.injection.organs[i].infusion = tissue::infusion_of(solid.network, tissue->young);
  }
}

}  // namespace trocar::scene
