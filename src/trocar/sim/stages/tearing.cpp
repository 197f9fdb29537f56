#include <algorithm>

#include <trocar/interactions/verbs/cut.hpp>
#include <trocar/sim/stages/circulation.hpp>
#include <trocar/sim/stages/tearing.hpp>
#include <trocar/tissue/failure/overstretch.hpp>

namespace trocar::sim {
namespace {

double norm(const double (&f)[3]) noexcept { return length(Vec3d{f[0], f[1], f[2]}); }

/// The hand that did it: the one that holds the body, or else the one that pulls or presses hardest; -1: none.
int culprit(const StepContext& c, std::int32_t body) noexcept {
  int hardest = -1;
  double most = 0;
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    const interactions::ToolState& tool = c.state.tools[t];
    for (int h = 0; h < tool.holds; ++h)
      if (tool.hold[h].body == body) return int(t);
    const double force = std::max(norm(tool.pull), norm(tool.contact_force));
    if (force <= most) continue;
    most = force;
    hardest = int(t);
  }
  return hardest;
}

/// Bodies take turns, so that no tick looks at all of them.
std::uint64_t look(const StepContext& c, size_t body) noexcept { return c.state.tick + 7 * body; }

void tell_torn(StepContext& c, std::int32_t body) noexcept {
  const int hand = culprit(c, body);
  if (c.report.event_count == kMaxEvents || hand < 0) return;
  c.report.events[c.report.event_count++] = {Event::torn, hand, body};
}

/// Out of a lattice no piece can come, so it tears out of the jaws: what is torn stays with the organ.
void let_go(StepContext& c, std::int32_t body) noexcept {
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    interactions::ToolState& tool = c.state.tools[t];
    if (tool.holds == 0 || tool.hold[0].body != body) continue;
    tool.holds = 0;
    for (double& p : tool.pull) p = 0;
    if (c.report.event_count < kMaxEvents)
      c.report.events[c.report.event_count++] = {Event::released, std::int32_t(t), -1};
  }
}

/// What could not open is not tried again before its time has come once more.
bool opened(bool parted, std::vector<std::uint8_t>& counters) noexcept {
  if (!parted) std::fill(counters.begin(), counters.end(), std::uint8_t(0));
  return parted;
}

bool tear_solid(StepContext& c, size_t i) noexcept {
  const SolidModel& solid = c.model.solids[i];
  tissue::NetworkState& state = c.state.solids[i];
  const tissue::Overstretch tear =
      tissue::find_overstretch(tissue::springs_of(solid.network, state), solid.failure_strain, look(c, i),
                               c.state.overstretched_organs[i], c.work.beyond);
  if (!tear.found) return false;
  const int severed =
      interactions::cut_organ(tear.blade(), solid.network, solid.fine, state, c.state.parted[i], c.work.parts);
  if (severed > 0) open_vessels(c, tear.blade(), {Carriers::organ, std::int32_t(i)}, -1);
  return opened(severed > 0, c.state.overstretched_organs[i]);
}

bool tear_cuttable(StepContext& c, size_t i) noexcept {
  const CuttableOrgan& organ = c.model.cuttables[i];
  const size_t organ_index = c.model.solids.size() + i;
  tissue::CuttableState& state = c.state.cuttables[i];
  tissue::CuttableWork& work = c.work.cuttable_work[i];
  const tissue::Overstretch tear =
      tissue::find_overstretch(tissue::springs_of(organ.body, state, work), organ.failure_strain, look(c, organ_index),
                               c.state.overstretched_organs[organ_index], c.work.beyond);
  if (!tear.found) return false;
  const geometry::CutResult book = tissue::cut(organ.body, tear.blade(1.0), state, work);
  if (book.full) c.report.flags |= StepReport::kBookFull;
  if (book.parted > 0) open_vessels(c, tear.blade(1.0), {Carriers::organ, std::int32_t(organ_index)}, -1);
  return opened(book.parted > 0, c.state.overstretched_organs[organ_index]);
}

bool tear_membrane(StepContext& c, size_t i) noexcept {
  const MembraneBody& m = c.model.membranes[i];
  tissue::MembraneState& state = c.state.membranes[i];
  const tissue::Overstretch tear = tissue::find_overstretch(tissue::springs_of(m.sheet.network, state.network),
                                                            m.failure_strain, look(c, size_t(c.model.organs()) + i),
                                                            c.state.overstretched_membranes[i], c.work.beyond);
  if (!tear.found) return false;
  const int severed =
      interactions::cut_membrane(tear.blade(), m.sheet, m.depth, state, c.state.torn[i], c.work.parts).severed;
  if (severed > 0) open_vessels(c, tear.blade(), {Carriers::membrane, std::int32_t(i)}, -1);
  return opened(severed > 0, c.state.overstretched_membranes[i]);
}

bool tear_strand(StepContext& c, size_t i) noexcept {
  const int element = tissue::find_overstretch(c.model.strand_bodies[i].model, c.state.strands[i],
                                               c.model.strands[i].failure_strain, c.state.overstretched_strands[i]);
  if (element >= 0) tissue::cut_element(c.state.strands[i], element);
  if (element >= 0) open_vessels_within(c, int(i), element, -1);
  return element >= 0;
}

}  // namespace

// What is stretched beyond what it bears.
void tear_tissue(StepContext& c) noexcept {
  const size_t solids = c.model.solids.size();
  for (size_t i = 0; i < solids; ++i)
    if (c.model.solids[i].failure_strain > 0 && tear_solid(c, i)) {
      tell_torn(c, interactions::kSolidBase + int(i));
      let_go(c, interactions::kSolidBase + int(i));
    }
  for (size_t i = 0; i < c.model.cuttables.size(); ++i)
    if (c.model.cuttables[i].failure_strain > 0 && tear_cuttable(c, i))
      tell_torn(c, interactions::kSolidBase + int(solids + i));
  for (size_t i = 0; i < c.model.membranes.size(); ++i)
    if (c.model.membranes[i].failure_strain > 0 && tear_membrane(c, i))
      tell_torn(c, interactions::kMembraneBase + int(i));
  for (size_t i = 0; i < c.model.strands.size(); ++i)
    if (c.model.strands[i].failure_strain > 0 && tear_strand(c, i)) tell_torn(c, std::int32_t(i));
}

}  // namespace trocar::sim
