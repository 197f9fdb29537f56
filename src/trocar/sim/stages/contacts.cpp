#include <trocar/sim/bodies/bag.hpp>
#include <trocar/sim/bodies/bodies.hpp>
#include <trocar/sim/bodies/suture.hpp>
#include <trocar/sim/stages/contacts.hpp>
#include <trocar/sim/stages/stage.hpp>

namespace trocar::sim {
namespace {

/// How much of what an instrument remembers of bodies is one hand's.
size_t sides_of(size_t all, size_t hands) noexcept { return hands > 0 ? all / hands : 0; }

}  // namespace

// Instruments on tissue: contact and hold.
void resolve_instrument_contacts(StepContext& c) noexcept {
  const interactions::Bodies bodies = bodies_of(c);
  const size_t hands = c.model.hands.size();
  for (size_t t = 0; t < hands; ++t) {
    const interactions::ToolShape& shape = c.work.shapes[t];
    const interactions::ToolModel& tool = c.model.tool(c.state, t);
    const interactions::TouchBook& last = c.state.touches[t];
    interactions::ToolShape& before = c.work.shapes_before[t];
    before = interactions::shape_before(tool, last);
    interactions::Touching touching(tool.rubbing, before, shape, int(t), last, c.work.touches[t]);
    interactions::note_wall(c.work.wall_stops[t], touching);
    HandContact hand{t, tool, touching, t * sides_of(c.state.tool_side.size(), hands),
                     t * sides_of(c.state.sheet_side.size(), hands)};
    visit_bodies(c.model, [&](auto body) { touch(c, body, hand); });
    touch_objects(c, hand);
    interactions::hold_loads(shape, int(t), bodies, c.state.tools[t]);
  }
}

// Organs on organs.
void resolve_body_contacts(StepContext& c) noexcept {
  State& s = c.state;
  const interactions::Bodies bodies = bodies_of(c);
  visit_cuttables(c.model, [&c](auto organ) { touch_itself(c, organ); });
  size_t at = 0;
  for (const interactions::SurfacePair& p : c.model.surface_pairs) {
    const std::span<std::int32_t> nearest{s.nearest.data() + at, p.sample.size()};
    at += p.sample.size();
    const interactions::Surface& surface = c.work.surfaces[size_t(p.surface)];
    interactions::NetworkLoads* back = surface.moves() ? &c.work.organs[size_t(p.surface)].loads : nullptr;
    if (p.strand >= 0) {
      const size_t i = size_t(p.strand);
      strand_on_surface(p, c.model.strand_bodies[i], s.strands[i], surface, s.tick, nearest, c.work.strands[i].loads,
                        back);
    } else if (p.membrane >= 0) {
      const size_t i = size_t(p.membrane);
      solid_on_surface(p, c.work.membranes[i].sheet.surface, surface, s.tick, nearest, c.work.membranes[i].loads, back);
    } else {
      const size_t i = size_t(p.solid);
      solid_on_surface(p, c.work.surfaces[i], surface, s.tick, nearest, c.work.organs[i].loads, back);
    }
  }
  size_t side = 0;
  for (const interactions::StrandPair& p : c.model.strand_pairs) {
    const size_t n = p.overlap.size(), a = size_t(p.a), b = size_t(p.b);
    strand_on_strand(p, c.model.strand_bodies[a], s.strands[a], c.model.strand_bodies[b], s.strands[b], s.tick,
                     {s.nearest.data() + at, n}, {s.strand_side.data() + side, n}, c.work.strands[a].loads,
                     c.work.strands[b].loads);
    at += n;
    side += n;
  }
  for (const interactions::SelfPair& p : c.model.self_pairs) {
    const size_t organ = size_t(p.organ);
    const std::span<std::int32_t> nearest{s.nearest.data() + at, p.sample.size()};
    visit_organ(c.model, organ, [&](auto body) {
      self_contact(p, c.work.surfaces[organ], pieces_of(c, body), folded_of(c, body), s.tick, nearest,
                   c.work.organs[organ].loads);
    });
    at += p.sample.size();
  }
  for (size_t i = 0; i < c.model.carried_pairs.size(); ++i)
    interactions::carried_contact(bodies, c.model.carried_pairs[i], s.tick, s.carried[i]);
  rest_objects(c);
  rest_bags(c);
  rest_sutures(c);
}

}  // namespace trocar::sim
