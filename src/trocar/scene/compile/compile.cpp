#include <algorithm>
#include <stdexcept>

#include <trocar/geometry/curves/polyline.hpp>
#include <trocar/interactions/bodies/spread.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/compile/compile_contacts.hpp>
#include <trocar/scene/compile/compile_elastostatic.hpp>
#include <trocar/scene/compile/compile_energy.hpp>
#include <trocar/scene/compile/compile_fluids.hpp>
#include <trocar/scene/compile/compile_hands.hpp>
#include <trocar/scene/compile/compile_marks.hpp>
#include <trocar/scene/compile/compile_membrane.hpp>
#include <trocar/scene/compile/compile_motion.hpp>
#include <trocar/scene/compile/compile_solid.hpp>
#include <trocar/scene/compile/compile_targets.hpp>
#include <trocar/scene/compile/compile_tets.hpp>
#include <trocar/scene/compile/compile_vessels.hpp>
#include <trocar/scene/compile/compile_warnings.hpp>
#include <trocar/scene/description/capacity.hpp>
#include <trocar/scene/description/variant.hpp>
#include <trocar/sim/model/attach_near.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/stages/containing.hpp>
#include <trocar/tissue/elastostatic/drawn_springs.hpp>

namespace trocar::scene {
namespace {

using Faults = std::vector<core::Fault>;

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

/// Over a few cells the organ takes the strand's pull.
interactions::MaterialPoint spread_on(sim::Model& model, int organ, Vec3d at) {
  const auto reach = [](double cell) { return std::max(0.005, 2.2 * cell); };
  if (const int lattice = sim::lattice_of(model, organ); lattice >= 0) {
    const sim::SolidModel& s = model.solids[size_t(lattice)];
    return interactions::spread(model, size_t(organ), s.network.mass, at, reach(s.cell));
  }
  const sim::CuttableOrgan& c = sim::cuttable_of(model, organ);
  return interactions::spread(model, size_t(organ), tissue::drawn_masses(c.body), at, reach(c.cell));
}

sim::StrandEndModel compile_end(const StrandEnd& end, Vec3d at, sim::Model& model, Faults& faults) {
  sim::StrandEndModel out;
  if (end.fixed) out.kind = sim::StrandEndModel::fixed;
  if (end.organ.empty()) return out;
  const int organ = model.organ_index(end.organ);
  if (organ < 0) return out;
  out.kind = sim::StrandEndModel::hosted;
  try {
    out.on.point = spread_on(model, organ, at);
  } catch (const std::invalid_argument&) {
    faults.push_back(
        {end.at, "expected the strand's end within a few cells of '" + end.organ + "', got a larger distance"});
  }
  return out;
}

/// What the strand does to its hosts in the drawn shape: their prestress knows nothing of it, so it is taken off.
void note_drawn_pull(const tissue::StrandModel& model, sim::StrandAnatomy& strand) {
  std::vector<tissue::StrandEnd> ends;
  for (int node : model.prescribed_nodes) ends.push_back({model.rest[size_t(node)], {0, 0, 0}});
  std::vector<tissue::StrandReaction> reactions(ends.size());
  tissue::StrandState state = tissue::rest_state(model);
  tissue::StrandWork work = tissue::make_work(model);
  tissue::advance(model, ends, {}, reactions, {}, state, work);
  size_t i = 0;
  for (sim::StrandEndModel* end : {&strand.start, &strand.end})
    if (end->kind != sim::StrandEndModel::free) end->on.drawn_pull = reactions[i++].force;
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
  sim::StrandAnatomy out;
  out.name = strand.name;
  out.look = strand.look;
  out.tissue = strand.tissue;
  out.fimbriated = strand.fimbriated;
  out.failure_strain = tissue.failure_strain;
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
  model.strand_bodies.push_back(std::move(body));
}

constexpr double kAnywhere = 1e3;  // [m] a drawn fold's base lies on its organ, however far that is

sim::DrawnFold compile_sheet(const Sheet& sheet, const sim::Model& model) {
  sim::DrawnFold out;
  out.name = sheet.name;
  out.look = sheet.look;
  out.strand = model.strand_index(sheet.strand);
  const double length = out.strand >= 0 ? model.strand_bodies[size_t(out.strand)].length() : 0;
  out.from = std::min(sheet.from, length);
  out.to = std::min(sheet.to, length);
  const sim::DrawnBodies drawn(model);
  for (Vec3d p : sheet.base) out.base.push_back(attach_near(drawn, {sheet.base_organ}, kAnywhere, p).point);
  return out;
}

void report_fat(const sim::Model& model, CompileReport& report) {
  for (const interactions::FatBody& body : model.fat) {
    BodyReport r;
    r.name = body.name;
    r.kind = "fat";
    r.nodes = body.fat.lobules();
    r.springs = body.fat.septa();
    r.substeps = body.fat.network.substeps;
    r.dt_limit = body.fat.network.dt_limit;
    r.mass = body.fat.lobules() * body.fat.mass;
    r.volume = body.fat.lobules() * body.fat.volume;
    report.bodies.push_back(r);
  }
}

void note_detail(const Description& d, sim::Model& model) {
  for (const DetailSetting& setting : d.detail) {
    std::vector<sim::DetailLevel> levels;
    for (const DetailSetting::Level& l : setting.levels) levels.push_back({l.from, l.error, l.surface});
    for (const std::string& name : setting.of) model.drawn_detail.push_back({name, levels});
  }
}

/// Which variant it is, for results.
void note_anatomy(const Description& d, sim::Model& model) {
  model.anatomy = d.anatomy;
  if (!d.variation) return;
  const VariationSetting::Variant* variant = find_variant(*d.variation, d.anatomy);
  model.anatomy_title = variant ? variant->title : d.anatomy.empty() ? "" : "The common anatomy";
}

}  // namespace

const Tissue* find_tissue(const Description& d, const std::string& name) {
  for (const Tissue& t : d.tissues)
    if (t.name == name) return &t;
  return nullptr;
}

sim::Model compile(const Description& d, CompileReport* report) {
  Faults faults;
  check_capacity(d, faults);
  if (!faults.empty()) throw core::BadInput(faults);
  sim::Model model;
  model.name = d.name;
  model.file = d.file;
  note_anatomy(d, model);
  model.gravity = d.gravity;
  for (const Solid& solid : d.solids) {
    const Tissue* tissue = find_tissue(d, solid.tissue);
    if (tissue) (of_tets(solid) ? compile_tets : compile_solid)(solid, *tissue, d.gravity, model, faults, report);
  }
  if (!faults.empty()) throw core::BadInput(faults);
  for (const Strand& strand : d.strands) {
    const Tissue* tissue = find_tissue(d, strand.tissue);
    if (tissue) compile_strand(strand, *tissue, d.gravity, model, faults, report);
  }
  for (const Wall& wall : d.walls) compile_wall(wall, model, report);
  for (const Membrane& membrane : d.membranes) {
    const Tissue* tissue = find_tissue(d, membrane.tissue);
    if (tissue) compile_membrane(membrane, *tissue, d.gravity, model, faults, report);
  }
  compile_hands(d, model, faults);
  for (const Pouch& pouch : d.pouches) {
    const Tissue* tissue = find_tissue(d, pouch.tissue);
    if (tissue) compile_pouch(pouch, *tissue, d, model, faults, report);
  }
  const size_t membranes = model.membranes.size();
  ObjectScenes::for_each([&](auto kind) { kind.compile(settings_of(kind, d.objects), d, model, faults); });
  if (report) {
    for (size_t i = membranes; i < model.membranes.size(); ++i) add_report(model.membranes[i], *report);  // leaves
    report_fat(model, *report);
  }
  for (const Sheet& sheet : d.sheets) model.drawn_folds.push_back(compile_sheet(sheet, model));
  compile_vessels(d, model, faults, report);
  compile_fluids(d, model, faults);
  compile_energy(d, model, faults);
  compile_injection(d, model);
  compile_motion(d, model, faults);
  compile_marks(d, model, faults);
  BagScene::expect_hand(settings_of(BagScene{}, d.objects), model, faults);
  compile_sutures(d, model, faults);
  if (!faults.empty()) throw core::BadInput(faults);
  compile_elastostatic(d, model, faults, report);
  if (!faults.empty()) throw core::BadInput(faults);
  compile_contacts(model);
  compile_targets(model);
  note_detail(d, model);
  model.looks = d.looks;
  model.cavity = sim::cavity_around(model);
  sim::seal(model);
  if (report) find_warnings(d, model, report->warnings);
  return model;
}

}  // namespace trocar::scene
