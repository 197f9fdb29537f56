#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include <trocar/core/log.hpp>
#include <trocar/core/text.hpp>
#include <trocar/scene/cache/compliance_cache.hpp>
#include <trocar/scene/compile/compile_elastostatic.hpp>
#include <trocar/scene/description/fibres.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/tissue/elastostatic/compliance_check.hpp>
#include <trocar/tissue/elastostatic/condense.hpp>
#include <trocar/tissue/elastostatic/drawn_springs.hpp>
#include <trocar/tissue/network/volume_force.hpp>

namespace trocar::scene {
namespace {

constexpr double kMostBytes = 3e9;     // that making a compliance may take
constexpr double kWorthTelling = 5e8;  // [B] from here on it is reported before it is allocated

/// An organ as both kinds of body have it.
struct OrganAsDrawn {
  std::span<const Vec3d> points;
  std::vector<std::uint8_t> held;
  std::span<const int> row_of_node;
  Vec3d origin;
  std::vector<tissue::SpringDescription> springs;
  std::vector<std::array<int, 4>> cells;
  std::vector<double> mass;
  std::span<const tissue::Anchor> anchors;
  double kappa = 0;
  std::vector<const tissue::Skin*> skins;

  bool floats() const {
    return std::all_of(held.begin(), held.end(), [](std::uint8_t h) { return h == tissue::kFree; });
  }
};

OrganAsDrawn as_drawn(const sim::SolidModel& s) {
  const tissue::NetworkModel& n = s.network;
  return {n.rest, n.fixed,   n.row_of_node, n.origin,          tissue::drawn_springs(n), tissue::drawn_cells(n),
          n.mass, s.anchors, n.bulk.kappa,  {&s.skin, &s.fine}};
}
OrganAsDrawn as_drawn(const sim::CuttableOrgan& c) {
  const tissue::CuttableModel& b = c.body;
  const std::size_t nodes = std::size_t(b.own_nodes);
  return {{b.drawn.rest.data(), nodes},
          {b.fixed.begin(), b.fixed.begin() + std::ptrdiff_t(nodes)},
          {b.row_of_node.data(), nodes},
          b.origin,
          tissue::drawn_springs(b),
          tissue::drawn_cells(b),
          tissue::drawn_masses(b),
          b.anchors,
          b.bulk.kappa,
          {&c.skin.skin}};
}

void keep(std::int32_t node, std::vector<std::uint8_t>& kept) {
  if (node >= 0 && std::size_t(node) < kept.size()) kept[std::size_t(node)] = 1;
}

/// Nodes of the row of a point of the organ.
void keep_row(const sim::Model& model, int organ, const interactions::MaterialPoint& p,
              std::vector<std::uint8_t>& kept) {
  if (p.body != BodyId::organ(std::size_t(organ))) return;
  const bool tetrahedral = sim::lattice_of(model, organ) < 0;
  for (std::size_t k = 0; k < std::size_t(p.count); ++k)
    keep(tetrahedral ? sim::cuttable_of(model, organ).body.drawn.cells[std::size_t(p.element)][std::size_t(p.node[k])]
                     : p.node[k],
         kept);
}

/// Nodes that a hand, a neighbour, or whatever hangs on the organ can pull at.
std::vector<int> kept_nodes(const sim::Model& model, int organ, const OrganAsDrawn& d) {
  std::vector<std::uint8_t> kept(d.points.size(), 0);
  for (const tissue::Skin* skin : d.skins)
    for (int v = 0; v < skin->size(); ++v)
      if (skin->at_surface(v))
        skin->each_carrier(v, [&](int node, int, float weight) {
          if (weight > 0) keep(node, kept);
        });
  for (const sim::StrandAnatomy& strand : model.strands)
    for (const sim::StrandEndModel* end : {&strand.start, &strand.end})
      if (end->organ() == organ)
        for (const std::int32_t node : model.rows[std::size_t(end->on.point.element)].node) keep(node, kept);
  for (const sim::Vessel& vessel : model.vessels.list)
    for (const interactions::VesselPoint& p : vessel.path.points) keep_row(model, organ, p.rides, kept);
  for (const sim::MembraneBody& membrane : model.membranes)
    for (const interactions::Attachment& hold : membrane.holds) keep_row(model, organ, hold.point, kept);
  for (const interactions::BondSet& set : model.bonds)
    for (const interactions::Bond& bond : set.bonds) keep_row(model, organ, bond.far, kept);
  std::vector<int> nodes;
  for (std::size_t i = 0; i < kept.size(); ++i)
    if (kept[i]) nodes.push_back(int(i));
  return nodes;
}

/// Of any length in files.
Vec3d unit_fibre(const Solid& solid) { return length(solid.fibre) > 0 ? normalised(solid.fibre) : Vec3d{}; }

/// Each with the stiffness and the fibres of its middle.
void add_local_tetrahedra(const Solid& solid, const Tissue& tissue, const OrganAsDrawn& d,
                          tissue::StiffnessBuilder& builder) {
  const double ratio = std::max(1.0, solid.fibre_ratio);
  std::vector<Vec3d> middles;
  for (const std::array<int, 4>& c : d.cells) {
    Vec3d sum;
    for (const int node : c) sum += d.points[std::size_t(node)] / double(c.size());
    middles.push_back(sum);
  }
  const std::vector<Vec3d> fibres = fibres_in(solid, middles);
  for (std::size_t i = 0; i < d.cells.size(); ++i)
    builder.add_tetrahedra({&d.cells[i], 1}, tissue.young * stiffness_at(solid.regions, middles[i]), tissue.poisson,
                           fibres.empty() ? unit_fibre(solid) : fibres[i], ratio);
}

tissue::Stiffness stiffness_of(const Solid& solid, const Tissue& tissue, const OrganAsDrawn& d) {
  tissue::StiffnessBuilder builder(d.points, d.held);
  if (solid.elasticity == Elasticity::tetrahedra && solid.differs_by_place()) {
    add_local_tetrahedra(solid, tissue, d, builder);
  } else if (solid.elasticity == Elasticity::tetrahedra) {
    builder.add_tetrahedra(d.cells, tissue.young, tissue.poisson, unit_fibre(solid), std::max(1.0, solid.fibre_ratio));
  } else {
    builder.add_springs(d.springs);
    if (d.kappa > 0) builder.add_volume(d.cells, d.kappa);
  }
  builder.add_anchors(d.anchors);
  return builder.build();
}

std::string megabytes(double bytes) { return fmt::format("{:.0f} MB", bytes / 1e6); }

/// @return whether there is room for it
bool there_is_room(const Solid& solid, const ComplianceReport& r, std::vector<core::Fault>& faults) {
  if (r.most_bytes <= kMostBytes) {
    if (r.most_bytes > kWorthTelling)
      core::log::info("'{}': its static solver has {} surface nodes and takes {} during its computation, {} afterwards",
                      solid.name, r.kept, megabytes(r.most_bytes), megabytes(r.bytes));
    return true;
  }
  faults.push_back(
      {solid.solver_at, tr("expected an organ whose static solver fits into {}, got {} surface nodes of {}, "
                           "which take {}: make its cells larger, or let its solver be \"dynamic\"",
                           megabytes(kMostBytes), r.kept, r.nodes, megabytes(r.most_bytes))});
  return false;
}

/// From the cache, or made and kept there.
Compliance compliance_of(const tissue::Stiffness& k, std::span<const int> kept, std::span<const double> loads,
                         const CompileReport* report, ComplianceReport& r) {
  const ContentKey key = content_key(k, kept, loads);
  const int fields = int(loads.size() / (3 * k.points.size()));
  CachedCompliance cached = read_compliance(key, int(kept.size()), fields);
  r.file = cached.file.string();
  r.note = cached.damage;
  if (cached.found)
    r.note = tissue::fault_of_compliance(k, kept, loads, cached.compliance.columns, cached.compliance.fields);
  if (!r.note.empty()) core::log::warn("{}: {}; computed again", r.file, r.note);
  if (cached.found && r.note.empty()) return std::move(cached.compliance);
  r.computed = true;
  const tissue::Condensed made = tissue::condense(k, kept, loads, nullptr, [&](double share) {
    if (report && report->said) report->said(r.organ, share);
  });
  const Compliance compliance{{made.compliance.begin(), made.compliance.end()},
                              {made.fields.begin(), made.fields.end()}};
  if (const std::string lack = keep_compliance(key, int(kept.size()), compliance); !lack.empty()) {
    r.file.clear();
    r.note = lack;
    core::log::warn("'{}': {}; its static solver will be computed again the next time", r.organ, lack);
  }
  return compliance;
}

bool contracts(const sim::Model& model, int organ) {
  return std::any_of(model.motion.peristalsis.begin(), model.motion.peristalsis.end(),
                     [organ](const sim::PeristalsisModel& p) { return p.solid == organ; });
}

void compile_one(const Solid& solid, const Tissue& tissue, int organ, const OrganAsDrawn& d, Vec3d gravity,
                 sim::Model& model, std::vector<core::Fault>& faults, CompileReport* report) {
  const auto began = std::chrono::steady_clock::now();
  const std::vector<int> kept = kept_nodes(model, organ, d);
  ComplianceReport r;
  r.organ = solid.name;
  r.nodes = int(d.points.size());
  r.kept = int(kept.size());
  r.bytes = 36.0 * double(kept.size()) * double(kept.size());
  r.most_bytes = tissue::memory_to_condense(r.nodes, r.kept);
  if (!there_is_room(solid, r, faults)) return;
  std::vector<double> loads;
  if (d.floats()) {
    Vec3d centre{0, 0, 0};
    for (const int node : kept) centre += d.points[std::size_t(node)] / double(kept.size());
    loads = tissue::frame_loads(d.points, d.mass, d.anchors, centre);
  }
  const tissue::Stiffness k = stiffness_of(solid, tissue, d);
  const Compliance c = compliance_of(k, kept, loads, report, r);
  sim::StaticOrgan out;
  out.organ = organ;
  out.beyond = solid.beyond_angle;
  out.hands_over = solid.beyond == BeyondLinear::switch_to_dynamic;
  out.solver = tissue::make_elastostatic({d.points, d.held, d.row_of_node, d.origin, gravity}, kept, c.columns,
                                         c.fields, sim::kTick);
  model.statics.push_back(std::move(out));
  r.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  if (report) report->compliances.push_back(r);
}

std::string in_mm(Vec3d p) { return fmt::format("({:.1f}, {:.1f}, {:.1f}) mm", 1e3 * p.x, 1e3 * p.y, 1e3 * p.z); }

void compile_organ(const Solid& solid, const Tissue& tissue, Vec3d gravity, sim::Model& model,
                   std::vector<core::Fault>& faults, CompileReport* report) {
  const int organ = model.organ_index(solid.name);
  if (organ < 0) return;
  if (contracts(model, organ))
    return faults.push_back({solid.solver_at, "expected the dynamic solver for '" + solid.name +
                                                  "', in which waves of contraction run, got the static one"});
  const std::int32_t lattice = sim::lattice_of(model, organ);
  const OrganAsDrawn d =
      lattice >= 0 ? as_drawn(model.solids[std::size_t(lattice)]) : as_drawn(sim::cuttable_of(model, organ));
  try {
    compile_one(solid, tissue, organ, d, gravity, model, faults, report);
  } catch (const tissue::NotHeld& e) {
    const bool known = e.node >= 0 && std::size_t(e.node) < d.points.size();
    faults.push_back(
        {solid.solver_at,
         tr("expected '{}' to be held everywhere, as a static solver needs, got: {}{}; anchor that "
            "part, or let its solver be \"dynamic\"",
            solid.name, e.what(), known ? ", near " + in_mm(d.points[std::size_t(e.node)]) : std::string())});
  } catch (const std::invalid_argument& e) {
    faults.push_back(
        {solid.solver_at, "expected '" + solid.name + "' to be an organ that suits a static solver, got: " + e.what()});
  }
}

}  // namespace

void compile_elastostatic(const Description& d, sim::Model& model, std::vector<core::Fault>& faults,
                          CompileReport* report) {
  for (const Solid& solid : d.solids)
    for (const Tissue& tissue : d.tissues)
      if (solid.is_quasi_static() && tissue.name == solid.tissue)
        compile_organ(solid, tissue, d.gravity, model, faults, report);
}

}  // namespace trocar::scene
