#include <trocar/interactions/contact/piece_contact.hpp>
#include <trocar/sim/stages/contacts.hpp>
#include <trocar/sim/stages/stage.hpp>

namespace trocar::sim {
namespace {

/// An instrument on folds. Far from one that it was not near before there is nothing to do, and nothing to forget.
void touch_sheets(StepContext& c, size_t t, interactions::Touching& touching) noexcept {
  size_t triangles = 0;
  for (const MembraneBody& m : c.model.membranes) triangles += m.sheet.triangles.size();
  size_t at = t * triangles * size_t(interactions::kSheetParts);
  const interactions::ToolShape& shape = c.work.shapes[t];
  for (size_t i = 0; i < c.model.membranes.size(); ++i) {
    const size_t sides = c.model.membranes[i].sheet.triangles.size() * size_t(interactions::kSheetParts);
    interactions::SheetBond& bond = c.state.sheet_bond[t * c.model.membranes.size() + i];
    const tissue::Box& box = c.work.sheet_poses[i].bounds;
    double& gap = c.work.sheet_gaps[t * c.model.membranes.size() + i];
    gap = kNearSheet;
    if (bond != interactions::SheetBond::none ||
        interactions::meets_box(box, shape.part[interactions::kShaft].a, shape.frame.tip, kNearSheet))
      interactions::tool_on_sheet(touching, c.state.tools[t], interactions::kMembraneBase + int(i), c.work.sheets[i],
                                  {c.state.sheet_side.data() + at, sides}, bond, c.work.membrane_loads[i], gap);
    at += sides;
  }
}

/// (vertices) Which piece of it each belongs to; empty where it hangs together.
std::span<const std::int32_t> pieces_of(const StepContext& c, size_t organ) noexcept {
  const size_t solids = c.model.solids.size();
  if (organ < solids) return {};
  const tissue::CuttableWork& work = c.work.cuttable_work[organ - solids];
  return work.parts > 1 ? work.part : std::span<const std::int32_t>{};
}

std::span<const std::uint8_t> folded_of(StepContext& c, size_t organ) noexcept {
  const size_t solids = c.model.solids.size(), i = organ - solids;
  if (organ < solids)
    return folded_rows(c.model.solids[organ].network, c.state.solids[organ], c.work.solid_work[organ]);
  return folded_rows(c.model.cuttables[i].body, c.state.cuttables[i], c.work.cuttable_work[i]);
}

}  // namespace

// Instruments on tissue: contact and hold.
void touch_tissue(StepContext& c) noexcept {
  const interactions::TissueView view = tissue_of(c);
  size_t at = 0;
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    const interactions::ToolShape& shape = c.work.shapes[t];
    const interactions::ToolModel& tool = c.model.tool(c.state, t);
    const interactions::TouchBook& last = c.state.touches[t];
    interactions::ToolShape& before = c.work.shapes_before[t];
    before = interactions::shape_before(tool, last);
    interactions::Touching touching(tool.rubbing, before, shape, int(t), last, c.work.touches[t]);
    interactions::note_wall(c.work.wall_stops[t], touching);
    for (size_t i = 0; i < size_t(c.model.organs()); ++i)
      interactions::tool_on_surface(touching, interactions::kSolidBase + int(i), c.work.surfaces[i],
                                    c.work.organ_loads[i]);
    for (size_t i = 0; i < c.model.strands.size(); ++i) {
      const size_t sides = size_t(c.model.strand_bodies[i].nodes() - 1) * size_t(interactions::kToolParts);
      interactions::tool_on_strand(tool, touching, c.state.tools[t], c.model.strand_bodies[i], int(i),
                                   c.state.strands[i], {c.state.tool_side.data() + at, sides}, c.work.strand_loads[i]);
      at += sides;
    }
    touch_sheets(c, t, touching);
    interactions::hold_loads(shape, int(t), view, c.state.tools[t], c.work.strand_loads, c.work.organ_loads,
                             c.work.membrane_loads);
  }
}

// Organs on organs.
void touch_organs(StepContext& c) noexcept {
  State& s = c.state;
  for (size_t i = 0; i < c.model.cuttables.size(); ++i) {
    const size_t organ = c.model.solids.size() + i;
    const tissue::CuttableWork& work = c.work.cuttable_work[i];
    const tissue::CuttableModel& body = c.model.cuttables[i].body;
    const geometry::CuttableTets& tets = s.cuttables[i].tets;
    if (work.parts > 1) piece_on_piece(c.work.surfaces[organ], work.part, work.largest_part, c.work.organ_loads[organ]);
    lip_on_lip(c.work.surfaces[organ], work.part, tets.source, body.own_nodes, tets.nodes, c.work.organ_loads[organ]);
  }
  size_t at = 0;
  for (const interactions::SurfacePair& p : c.model.surface_pairs) {
    const std::span<std::int32_t> nearest{s.nearest.data() + at, p.sample.size()};
    at += p.sample.size();
    const interactions::Surface& surface = c.work.surfaces[size_t(p.surface)];
    interactions::NetworkLoads* back = surface.moves() ? &c.work.organ_loads[size_t(p.surface)] : nullptr;
    if (p.strand >= 0) {
      const size_t i = size_t(p.strand);
      strand_on_surface(p, c.model.strand_bodies[i], s.strands[i], surface, s.tick, nearest, c.work.strand_loads[i],
                        back);
    } else if (p.membrane >= 0) {
      const size_t i = size_t(p.membrane);
      solid_on_surface(p, c.work.sheets[i].surface, surface, s.tick, nearest, c.work.membrane_loads[i], back);
    } else {
      const size_t i = size_t(p.solid);
      solid_on_surface(p, c.work.surfaces[i], surface, s.tick, nearest, c.work.organ_loads[i], back);
    }
  }
  size_t side = 0;
  for (const interactions::StrandPair& p : c.model.strand_pairs) {
    const size_t n = p.overlap.size(), a = size_t(p.a), b = size_t(p.b);
    strand_on_strand(p, c.model.strand_bodies[a], s.strands[a], c.model.strand_bodies[b], s.strands[b],
                     {s.nearest.data() + at, n}, {s.strand_side.data() + side, n}, c.work.strand_loads[a],
                     c.work.strand_loads[b]);
    at += n;
    side += n;
  }
  for (const interactions::SelfPair& p : c.model.self_pairs) {
    const size_t organ = size_t(p.organ);
    const std::span<std::int32_t> nearest{s.nearest.data() + at, p.sample.size()};
    self_contact(p, c.work.surfaces[organ], pieces_of(c, organ), folded_of(c, organ), s.tick, nearest,
                 c.work.organ_loads[organ]);
    at += p.sample.size();
  }
}

}  // namespace trocar::sim
