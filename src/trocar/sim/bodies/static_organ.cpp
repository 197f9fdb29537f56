#include <trocar/sim/bodies/breathing.hpp>
#include <trocar/sim/bodies/static_organ.hpp>

namespace trocar::sim {
namespace {

/// Its number among the Model's statics; -1: it is none.
int static_number(const Model& model, std::size_t organ) noexcept {
  for (std::size_t i = 0; i < model.statics.size(); ++i)
    if (model.statics[i].organ == std::int32_t(organ)) return int(i);
  return -1;
}

std::vector<tissue::NodeState>& rows_of(StepContext& c, SolidRef s) noexcept { return c.state.solids[s.index].nodes; }
std::vector<tissue::NodeState>& rows_of(StepContext& c, CuttableRef r) noexcept {
  return c.state.cuttables[r.index].nodes;
}

template <class Ref>
bool advance_one(StepContext& c, Ref r) noexcept {
  const int i = static_number(c.model, r.organ());
  if (i < 0 || !c.state.statics[std::size_t(i)].at_once()) return false;
  const StaticOrgan& organ = c.model.statics[std::size_t(i)];
  interactions::StaticOrganState& state = c.state.statics[std::size_t(i)];
  interactions::NetworkLoads& loads = c.work.organs[r.organ()].loads;
  loads.keep_order();
  c.work.organs[r.organ()].report =
      tissue::advance(organ.solver, loads.sorted, loads.point, loads.reaction, {carried(c, r).x}, state.body,
                      rows_of(c, r), c.work.statics[std::size_t(i)].solver);
  if (state.body.turn <= organ.beyond) return true;
  if (organ.hands_over)
    switch_to_dynamic(c, r);
  else
    c.work.organs[r.organ()].report.flags |= tissue::StepReport::kBeyondLinear;
  return true;
}

template <class Ref>
void place_one(StepContext& c, Ref r) noexcept {
  const int i = static_number(c.model, r.organ());
  if (i >= 0 && c.state.statics[std::size_t(i)].at_once())
    tissue::place_inner_nodes(c.model.statics[std::size_t(i)].solver, c.state.statics[std::size_t(i)].body,
                              rows_of(c, r));
}

template <class Ref>
void switch_one_to_dynamic(StepContext& c, Ref r) noexcept {
  const int i = static_number(c.model, r.organ());
  if (i < 0 || !c.state.statics[std::size_t(i)].at_once()) return;
  place_one(c, r);
  c.state.statics[std::size_t(i)].handed_over = 1;
}

/// The organ's state while the difference comes in; null: it does not.
template <class Ref>
interactions::StaticOrganState* fading(StepContext& c, Ref r, std::size_t& i) noexcept {
  const int number = static_number(c.model, r.organ());
  if (number < 0) return nullptr;
  i = std::size_t(number);
  interactions::StaticOrganState& state = c.state.statics[i];
  return state.at_once() || state.handed_over > interactions::kFadeTicks ? nullptr : &state;
}

template <class Ref>
void before_one(StepContext& c, Ref r) noexcept {
  std::size_t i = 0;
  if (fading(c, r, i)) c.work.statics[i].before = rows_of(c, r);
}

template <class Ref>
void after_one(StepContext& c, Ref r) noexcept {
  std::size_t i = 0;
  interactions::StaticOrganState* state = fading(c, r, i);
  if (!state) return;
  const float share = float(state->handed_over) / float(interactions::kFadeTicks);
  const std::vector<tissue::NodeState>& before = c.work.statics[i].before;
  std::vector<tissue::NodeState>& rows = rows_of(c, r);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    tissue::NodeState& n = rows[k];
    n.x = before[k].x + share * (n.x - before[k].x);
    n.y = before[k].y + share * (n.y - before[k].y);
    n.z = before[k].z + share * (n.z - before[k].z);
    n.vx *= share, n.vy *= share, n.vz *= share;
  }
  ++state->handed_over;
}

}  // namespace

bool is_quasi_static(const StepContext& c, std::size_t organ) noexcept {
  const int i = static_number(c.model, organ);
  return i >= 0 && c.state.statics[std::size_t(i)].at_once();
}

bool advance_at_once(StepContext& c, SolidRef s) noexcept { return advance_one(c, s); }
bool advance_at_once(StepContext& c, CuttableRef r) noexcept { return advance_one(c, r); }
void place_inner_nodes(StepContext& c, SolidRef s) noexcept { place_one(c, s); }
void place_inner_nodes(StepContext& c, CuttableRef r) noexcept { place_one(c, r); }
void switch_to_dynamic(StepContext& c, SolidRef s) noexcept { switch_one_to_dynamic(c, s); }
void switch_to_dynamic(StepContext& c, CuttableRef r) noexcept { switch_one_to_dynamic(c, r); }
void before_network(StepContext& c, SolidRef s) noexcept { before_one(c, s); }
void before_network(StepContext& c, CuttableRef r) noexcept { before_one(c, r); }
void after_network(StepContext& c, SolidRef s) noexcept { after_one(c, s); }
void after_network(StepContext& c, CuttableRef r) noexcept { after_one(c, r); }

}  // namespace trocar::sim
