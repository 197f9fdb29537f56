#include <trocar/sim/bodies/bodies.hpp>
#include <trocar/sim/stages/advancing.hpp>
#include <trocar/sim/stages/posing.hpp>
#include <trocar/sim/stages/stage.hpp>

namespace trocar::sim {

// Loads start afresh with the springs that hang organs in space.
void apply_anchor_loads(StepContext& c) noexcept {
  visit_bodies(c.model, [&c](auto body) { hang(c, body); });
  hang_objects(c);
}

// Folds pull on what carries them.
void apply_border_loads(StepContext& c) noexcept {
  for_each(c.work.pool, c.work.membrane_order, [&c](size_t i) noexcept { find_pulls(c, MembraneRef{i}); });
  visit_membranes(c.model, [&c](auto body) { pull_on_holders(c, body); });
}

// Strands: implicit, ends where their hosts put them, pulling on them.
void advance_strands(StepContext& c) noexcept {
  for_each(c.work.pool, c.work.strand_order, [&c](size_t i) noexcept { advance(c, StrandRef{i}); });
  visit_strands(c.model, [&c](auto body) { pull_on_hosts(c, body); });
}

// Organs: explicit networks in their own sub-steps.
void advance_organs(StepContext& c) noexcept {
  for_each(c.work.pool, c.work.organ_order,
           [&c](size_t i) noexcept { visit_organ(c.model, i, [&c](auto body) { advance(c, body); }); });
  view_organs(c);
}

// Folds: borders go where their holders have gone.
void advance_membranes(StepContext& c) noexcept {
  for_each(c.work.pool, c.work.membrane_order, [&c](size_t i) noexcept { advance(c, MembraneRef{i}); });
}

}  // namespace trocar::sim
