#include <algorithm>
#include <stdexcept>

#include <trocar/geometry/polyline.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/compile.hpp>
#include <trocar/scene/compile_contacts.hpp>
#include <trocar/scene/compile_solid.hpp>

namespace trocar::scene {
namespace {

using Faults = std::vector<core::Fault>;

const Tissue* find_tissue(const Description& d, const std::string& name) {
  for (const Tissue& t : d.tissues)
    if (t.name == name) return &t;
  return nullptr;
}

/// Linear interpolation of the stations at arc length s.
StrandStation station_at(const std::vector<StrandStation>& stations, double s) {
  if (s <= stations.front().s) return stations.front();
  for (size_t i = 1; i < stations.size(); ++i) {
    const StrandStation &a = stations[i - 1], &b = stations[i];
    if (s > b.s) continue;
    const double f = (s - a.s) / std::max(b.s - a.s, 1e-12);
    return {s, a.radius + f * (b.radius - a.radius), a.lumen + f * (b.lumen - a.lumen)};
  }
  return stations.back();
}

sim::StrandEndModel compile_end(const StrandEnd& end, Vec3d at, const sim::Model& model, Faults& faults) {
  sim::StrandEndModel out;
  if (end.fixed) out.kind = sim::StrandEndModel::fixed;
  if (end.organ.empty()) return out;
  for (size_t i = 0; i < model.solids.size(); ++i) {
    if (model.solids[i].name != end.organ) continue;
    out.kind = sim::StrandEndModel::hosted;
    out.solid = std::int32_t(i);
    const double reach = std::max(0.005, 2.2 * model.solids[i].cell);  // over which the organ takes the strand's pull
    try {
      out.patch = interactions::make_patch(model.solids[i].network, at, reach);
    } catch (const std::invalid_argument&) {
      faults.push_back(
          {end.at, "expected the strand's end within a few cells of '" + end.organ + "', got one farther away"});
    }
  }
  return out;
}

/// What the strand does to its hosts in the drawn shape: their prestress knows nothing of it, so it is taken off.
void note_drawn_pull(const tissue::StrandModel& model, sim::StrandModel& strand) {
  std::vector<tissue::StrandEnd> ends;
  for (int node : model.prescribed_nodes) ends.push_back({model.rest[size_t(node)], {0, 0, 0}});
  std::vector<tissue::StrandReaction> reactions(ends.size());
  tissue::StrandState state = tissue::rest_state(model);
  tissue::StrandWork work = tissue::make_work(model);
  tissue::advance(model, ends, {}, reactions, {}, state, work);
  size_t i = 0;
  for (sim::StrandEndModel* end : {&strand.start, &strand.end})
    if (end->kind != sim::StrandEndModel::free) end->patch.drawn_pull = reactions[i++].force;
}

constexpr double kStrandDamping = 0.004;      // [s] times stiffness, stretch and bending
constexpr double kFoundationDamping = 0.030;  // [s] times stiffness: fat and peritoneum yield slowly

void compile_strand(const Strand& strand, const Tissue& tissue, Vec3d gravity, sim::Model& model, Faults& faults,
                    CompileReport* report) {
  const geometry::NurbsCurve curve = geometry::interpolated(strand.centreline);
  const double drawn = geometry::length(curve);
  const int elements = std::max(4, int(drawn / strand.spacing + 0.5));
  tissue::StrandDescription d;
  d.positions = geometry::sampled_by_arc(curve, elements + 1);
  interactions::StrandBody body;
  body.cuttable = strand.cuttable;
  body.arc.push_back(0);
  for (int e = 0; e < elements; ++e)
    body.arc.push_back(body.arc.back() + length(d.positions[size_t(e) + 1] - d.positions[size_t(e)]));
  sim::StrandModel out;
  out.name = strand.name;
  out.look = strand.look;
  out.tissue = strand.tissue;
  out.fimbriated = strand.fimbriated;
  bool hollow = false;
  for (double s : body.arc) {
    const StrandStation at = station_at(strand.stations, s);
    out.outer.push_back(at.radius);
    out.inner.push_back(at.lumen);
    hollow = hollow || at.lumen > 0;
  }
  for (int e = 0; e < elements; ++e) {
    const StrandStation at = station_at(strand.stations, 0.5 * (body.arc[size_t(e)] + body.arc[size_t(e) + 1]));
    d.radius.push_back(at.radius);
    if (hollow) d.lumen.push_back(at.lumen);
  }
  d.youngs_modulus = tissue.young;
  d.law = {tissue.p1, tissue.p2, tissue.strain_cap};
  d.density = tissue.density;
  d.lumen_density = 1000;
  for (size_t i = 0; i < body.arc.size(); ++i) {
    const double before = i > 0 ? body.arc[i] - body.arc[i - 1] : 0;
    const double after = i + 1 < body.arc.size() ? body.arc[i + 1] - body.arc[i] : 0;
    d.foundation.push_back(strand.foundation * 0.5 * (before + after));
  }
  if (strand.foundation_limit > 0) d.foundation_stiffening = 1 / (strand.foundation_limit * strand.foundation_limit);
  out.start = compile_end(strand.start, d.positions.front(), model, faults);
  out.end = compile_end(strand.end, d.positions.back(), model, faults);
  d.prescribed.assign(d.positions.size(), 0);
  d.prescribed.front() = out.start.kind != sim::StrandEndModel::free;
  d.prescribed.back() = out.end.kind != sim::StrandEndModel::free;
  d.damping_time = kStrandDamping;
  d.foundation_damping_time = kFoundationDamping;
  d.gravity = gravity;
  try {
    body.model = tissue::build(d, sim::kTick);
  } catch (const std::invalid_argument& e) {
    faults.push_back({strand.at, "strand '" + strand.name + "': expected a sound strand, got: " + e.what()});
    body.model = {};
    return;
  }
  note_drawn_pull(body.model, out);
  for (const Landmark& l : strand.landmarks)
    out.landmarks.push_back({l.name, std::min(l.from, body.length()), std::min(l.to, body.length())});
  if (report) {
    BodyReport r;
    r.name = strand.name;
    r.kind = "strand";
    r.nodes = elements + 1;
    r.springs = elements;
    for (double m : body.model.mass) r.mass += m;
    report->bodies.push_back(r);
  }
  model.strands.push_back(std::move(out));
  model.bodies.push_back(std::move(body));
}

/// The place on a strand nearest to p (as drawn).
interactions::StrandPlace nearest_place(const interactions::StrandBody& body, Vec3d p) {
  interactions::StrandPlace best;
  double least = 1e30;
  for (int e = 0; e + 1 < body.nodes(); ++e) {
    const Vec3d a = body.model.rest[size_t(e)], ab = body.model.rest[size_t(e) + 1] - a;
    const double w = std::clamp(dot(p - a, ab) / dot(ab, ab), 0.0, 1.0);
    const double distance = length(a + w * ab - p);
    if (distance >= least) continue;
    least = distance;
    best = {e, w};
  }
  return best;
}

sim::SheetModel compile_sheet(const Sheet& sheet, const sim::Model& model) {
  sim::SheetModel out;
  out.name = sheet.name;
  out.look = sheet.look;
  out.strand = model.strand_index(sheet.strand);
  const double length = out.strand >= 0 ? model.bodies[size_t(out.strand)].length() : 0;
  out.from = std::min(sheet.from, length);
  out.to = std::min(sheet.to, length);
  for (Vec3d p : sheet.base) {
    sim::BasePoint point;
    point.rest = p;
    for (size_t i = 0; i < model.solids.size(); ++i) {
      if (model.solids[i].name != sheet.base_organ) continue;
      point.solid = std::int32_t(i);
      double least = 1e30;
      const tissue::Skin& skin = model.solids[i].skin;
      for (int v = 0; v < skin.size(); ++v) {
        const double distance = trocar::length(vec_cast<double>(skin.rest[size_t(v)]) - p);
        if (distance >= least) continue;
        least = distance;
        point.vertex = v;
      }
    }
    point.strand = model.strand_index(sheet.base_organ);
    if (point.strand >= 0) point.place = nearest_place(model.bodies[size_t(point.strand)], p);
    out.base.push_back(point);
  }
  return out;
}

interactions::ToolKind tool_kind(InstrumentKind kind) {
  switch (kind) {
    case InstrumentKind::grasper:
      return interactions::ToolKind::grasper;
    case InstrumentKind::clip_applier:
      return interactions::ToolKind::clip_applier;
    case InstrumentKind::scissors:
      return interactions::ToolKind::scissors;
    case InstrumentKind::probe:
      break;
  }
  return interactions::ToolKind::probe;
}

Vec3d port_position(const Description& d, const std::string& name) {
  for (const Port& p : d.ports)
    if (p.name == name) return p.position;
  return {};
}

void compile_tools(const Description& d, sim::Model& model, Faults& faults) {
  for (const Placement& p : d.placements) {
    if (model.tools.size() == size_t(sim::kMaxTools)) {
      faults.push_back({p.at, "expected at most " + std::to_string(sim::kMaxTools) + " tools, got another"});
      return;
    }
    for (const Instrument& i : d.instruments) {
      if (i.name != p.instrument) continue;
      interactions::ToolModel tool;
      tool.name = i.name;
      tool.kind = tool_kind(i.kind);
      tool.port = port_position(d, p.port);
      tool.shaft_radius = i.shaft_radius;
      tool.shaft_length = i.shaft_length;
      tool.jaw_length = i.jaw_length;
      tool.jaw_width = i.jaw_width;
      tool.jaw_thickness = i.jaw_thickness;
      tool.opening = i.opening;
      tool.parallel_gap = i.parallel_gap;
      tool.pinch_max = i.pinch_max;
      tool.friction = i.friction;
      tool.clip_length = i.clip_length;
      tool.clips = i.clips;
      model.start.tools[model.tools.size()] = sim::tool_input(kinematics::inverse(tool.port, p.tip, p.roll), 0.0f);
      model.tools.push_back(tool);
    }
  }
  model.scope.port = port_position(d, d.scope_placement.port);
  model.scope.angle = d.scope.angle;
  model.scope.field_of_view = d.scope.field_of_view;
  model.scope.shaft_radius = d.scope.shaft_radius;
  const kinematics::FulcrumPose pose =
      kinematics::inverse(model.scope.port, d.scope_placement.tip, d.scope_placement.roll);
  model.start.scope = {float(pose.yaw), float(pose.pitch), float(pose.roll), float(pose.depth), 0.0f};
}

void add_target(sim::Model& model, sim::VisibilityTarget target, const std::vector<sim::VisibilitySample>& samples) {
  target.first = std::int32_t(model.samples.size());
  target.count = std::int32_t(samples.size());
  for (sim::VisibilitySample s : samples) {
    s.target = std::int32_t(model.targets.size());
    model.samples.push_back(s);
  }
  model.targets.push_back(target);
}

/// What exercises may ask to be seen: jaws, named stretches of strands, organs.
void compile_targets(sim::Model& model) {
  for (size_t t = 0; t < model.tools.size(); ++t)
    for (std::int32_t jaw = 0; jaw < 2; ++jaw)
      add_target(
          model,
          {sim::VisibilityTarget::jaw, model.tools[t].name + (jaw == 0 ? ".jaw_a" : ".jaw_b"), std::int32_t(t), 0, 0},
          {{0, jaw, 0}});
  for (size_t i = 0; i < model.strands.size(); ++i)
    for (const sim::LandmarkModel& l : model.strands[i].landmarks) {
      std::vector<sim::VisibilitySample> samples;
      constexpr int kSamples = 5;
      for (int k = 0; k < kSamples; ++k) {
        const interactions::StrandPlace p =
            interactions::place_at(model.bodies[i], l.from + (l.to - l.from) * (k + 0.5) / kSamples);
        samples.push_back({0, p.element, p.w});
      }
      add_target(model, {sim::VisibilityTarget::strand, model.strands[i].name + "." + l.name, std::int32_t(i), 0, 0},
                 samples);
    }
  for (size_t i = 0; i < model.solids.size(); ++i) {
    std::vector<sim::VisibilitySample> samples;
    constexpr int kSamples = 16;
    const int n = model.solids[i].skin.size();
    for (int k = 0; k < kSamples; ++k) samples.push_back({0, std::int32_t((2 * k + 1) * n / (2 * kSamples)), 0});
    add_target(model, {sim::VisibilityTarget::solid, model.solids[i].name, std::int32_t(i), 0, 0}, samples);
  }
}

}  // namespace

sim::Model compile(const Description& d, CompileReport* report) {
  Faults faults;
  sim::Model model;
  model.name = d.name;
  model.file = d.file;
  model.gravity = d.gravity;
  for (const Solid& solid : d.solids) {
    const Tissue* tissue = find_tissue(d, solid.tissue);
    if (tissue) compile_solid(solid, *tissue, d.gravity, model, faults, report);
  }
  if (!faults.empty()) throw core::BadInput(faults);
  for (const Strand& strand : d.strands) {
    const Tissue* tissue = find_tissue(d, strand.tissue);
    if (tissue) compile_strand(strand, *tissue, d.gravity, model, faults, report);
  }
  for (const Wall& wall : d.walls) compile_wall(wall, model, report);
  for (const Sheet& sheet : d.sheets) model.sheets.push_back(compile_sheet(sheet, model));
  compile_tools(d, model, faults);
  if (!faults.empty()) throw core::BadInput(faults);
  compile_contacts(model);
  compile_targets(model);
  sim::seal(model);
  return model;
}

}  // namespace trocar::scene
