#include <algorithm>
#include <cmath>
#include <optional>

#include <trocar/interactions/verbs/cut.hpp>
#include <trocar/sim/bodies/bodies.hpp>
#include <trocar/sim/bodies/bonds.hpp>
#include <trocar/sim/bodies/fat.hpp>
#include <trocar/sim/bodies/suture.hpp>
#include <trocar/sim/bodies/vessel_wounds.hpp>
#include <trocar/sim/bodies/views.hpp>
#include <trocar/sim/model/seen.hpp>
#include <trocar/sim/verbs/cutting.hpp>

namespace trocar::sim {
namespace {

void record_organ_cut(StepContext& c, size_t t, size_t organ) noexcept {
  State& s = c.state;
  interactions::Cut& cut = s.cuts[size_t(s.cut_count++)];
  cut = {};
  cut.solid = std::int32_t(organ);
  cut.tool = std::int32_t(t);
  cut.tips_visible = jaw_tips_visible(c.model, c.state, int(t));
  cut.tick = s.tick;
}

bool blades_near(const StepContext& c, size_t t, size_t organ, double margin) noexcept {
  const interactions::ToolShape& shape = c.work.shapes[t];
  return c.work.organs[organ].pose.bounds.near_segment(shape.pivot, shape.frame.tip, margin);
}

/// What cannot be recorded is not cut, and reported: blades are at something that they would cut.
bool has_no_room(StepContext& c, int place) noexcept {
  if (place < interactions::kMaxCuts) return false;
  c.report.flags |= StepReport::kRecordsFull;
  return true;
}

/// Blades that have just closed sever springs of lattices.
void cut_lattices(StepContext& c, size_t t) noexcept {
  const geometry::Blade blade = interactions::closed_blades(c.model.tool(c.state, t), c.work.shapes[t]);
  visit_solids(c.model, [&](SolidRef solid) {
    if (!blades_near(c, t, solid.organ(), 0.005) || has_no_room(c, c.state.cut_count)) return;
    if (cut(c, solid, blade).parted) record_organ_cut(c, t, solid.organ());
  });
}

/// Closing blades part the cells of organs that can be cut.
void cut_cuttables(StepContext& c, size_t t, const geometry::Blade& blade) noexcept {
  visit_cuttables(c.model, [&](CuttableRef organ) {
    if (!blades_near(c, t, organ.organ(), c.model.tool(c.state, t).jaw_length)) return;
    if (has_no_room(c, c.state.cut_count)) return;
    const Parting parting = cut(c, organ, blade);
    if (parting.moved > 0) pose_again(c, organ);  // nodes have moved to the blade
    if (!parting.parted) return;
    record_organ_cut(c, t, organ.organ());
    open_vessels(c, organ.id(), parting, int(t));
  });
}

/// Index in the buffer of these blades' cut of a fold's strand in this tick, where no other fold is recorded with it;
/// else the buffer's end: an organ, a closed wall and a fold without a strand have records of their own.
int place_in_buffer(const State& s, size_t t, std::int32_t strand) noexcept {
  for (int i = 0; strand >= 0 && i < s.cut_count; ++i) {
    const interactions::Cut& cut = s.cuts[size_t(i)];
    if (cut.tick == s.tick && cut.tool == std::int32_t(t) && cut.strand == strand && cut.membrane < 0) return i;
  }
  return s.cut_count;
}

/// Blades that have just closed part the folds they closed in; blades that are closing part closed walls, which they
/// would push away.
void cut_folds(StepContext& c, size_t t, const geometry::Blade& blade, bool closed_walls) noexcept {
  State& s = c.state;
  const interactions::ToolShape& shape = c.work.shapes[t];
  visit_membranes(c.model, [&](MembraneRef r) {
    const MembraneBody& m = model_of(c.model, r);
    if (m.sheet.closed() != closed_walls) return;
    if (!m.cuttable || !c.work.membranes[r.index].pose.bounds.near_segment(shape.pivot, shape.frame.tip, 0.005)) return;
    const int place = place_in_buffer(s, t, m.strand);
    if (has_no_room(c, place)) return;
    const Parting fold = cut(c, r, blade);
    if (!fold.parted) return;
    if (closed_walls) open_vessels(c, r.id(), fold, int(t));
    interactions::Cut& cut = s.cuts[size_t(place)];
    if (place == s.cut_count) {
      ++s.cut_count;
      cut = {};
      cut.tick = s.tick;
      cut.tool = std::int32_t(t);
    }
    cut.membrane = std::int32_t(r.index);
    cut.fold = fold.depth;
    cut.tips_visible = jaw_tips_visible(c.model, c.state, int(t));
  });
}

/// Vessels within strands that these blades have just cut through.
void open_with_strands(StepContext& c, size_t t, int first_cut) noexcept {
  for (int i = first_cut; i < c.state.cut_count; ++i) {
    const interactions::Cut& cut = c.state.cuts[size_t(i)];
    if (cut.strand < 0 || cut.fraction < interactions::kThrough) continue;
    open_vessels_within(c, cut.strand, place_at(c.model.strand_bodies[size_t(cut.strand)], cut.s).element, int(t));
  }
}

/// What closing blades cut before they meet.
void cut_flesh(StepContext& c, size_t t) noexcept {
  const auto closed = [](const MembraneBody& m) { return m.sheet.closed(); };
  const bool walls = std::any_of(c.model.membranes.begin(), c.model.membranes.end(), closed);
  if (c.model.cuttables.empty() && c.model.bonds.empty() && !walls && c.model.fat.empty()) return;
  const std::optional<geometry::Blade> blade =
      interactions::sweep_of_blades(c.model.tool(c.state, t), c.work.shapes[t], c.state.tools[t]);
  if (!blade) return;
  cut_cuttables(c, t, *blade);
  sever_bonds(c, *blade);
  sever_septa(c, *blade);
  if (walls) cut_folds(c, t, *blade, true);
}

}  // namespace

void Cutting::work(StepContext& c, std::size_t t) noexcept {
  State& s = c.state;
  const interactions::ToolModel& model = c.model.tool(s, t);
  interactions::ToolState& tool = s.tools[t];
  const int before = s.cut_count;
  cut_flesh(c, t);
  const bool armed = tool.armed != 0;
  bool refused = false;
  update_scissors(model, c.work.shapes[t], int(t), bodies_of(c), s.strands, jaw_tips_visible(c.model, s, int(t)),
                  s.tick, tool, {s.cuts, s.cut_count, &refused});
  if (refused) c.report.flags |= StepReport::kRecordsFull;
  if (armed && !tool.armed) {
    cut_threads(c, t);
    cut_lattices(c, t);
    const geometry::Blade blade = interactions::closed_blades(model, c.work.shapes[t]);
    cut_folds(c, t, blade, false);
    open_with_strands(c, t, before);
    open_vessels(c, blade, {}, int(t));
  }
  for (int cut = before; cut < s.cut_count; ++cut)
    emit_event(c, Event::recorded(Event::cut, int(t), cut, s.cuts[size_t(cut)].body()));
}

bool Cutting::sound(const Model& model, const interactions::Cut& cut) noexcept {
  return cut.strand >= -1 && cut.strand < std::int32_t(model.strands.size()) && std::isfinite(cut.s) &&
         cut.solid >= -1 && cut.solid < model.organs() && cut.membrane >= -1 &&
         cut.membrane < std::int32_t(model.membranes.size()) && std::isfinite(cut.fold);
}

}  // namespace trocar::sim
