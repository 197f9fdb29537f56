#include <algorithm>
#include <cmath>

#include <trocar/training/observe/loops.hpp>

namespace trocar::training {
namespace {

/// A thread that broke has been cut by nobody.
bool has_cut_tail(const sim::State& state, const sim::LoopClosure& loop) {
  const interactions::SutureState& s = state.objects.sutures[size_t(loop.suture)];
  return s.sling.stage == interactions::SlingState::left && s.broken == 0;
}

}  // namespace

std::optional<LoopSeen> loop_on(const sim::Model& model, const sim::State& state, int strand, double s) {
  std::optional<LoopSeen> nearest;
  const interactions::StrandBody& body = model.strand_bodies[size_t(strand)];
  sim::visit_loops(model, state, [&](const sim::LoopClosure& loop) {
    if (loop.at.body != BodyId::strand(size_t(strand))) return;
    if (nearest && std::fabs(nearest->closure.s - s) < std::fabs(loop.s - s)) return;
    LoopSeen seen;
    seen.closure = loop;
    const interactions::SlingState& g = state.objects.sutures[size_t(loop.suture)].sling;
    seen.tension = g.tension;
    seen.off = has_cut_tail(state, loop);
    seen.pull = g.stage == interactions::SlingState::left ? 0 : std::max(0.0, g.pulled);
    seen.stump = interactions::free_end(body, state.strands[size_t(strand)], place_on_rod(loop.at)).away;
    nearest = seen;
  });
  return nearest;
}

SecuredLoops secured_loops(const sim::Model& model, const sim::State& state, int strand) {
  SecuredLoops found;
  sim::visit_loops(model, state, [&](const sim::LoopClosure& loop) {
    const bool counts = loop.at.body == BodyId::strand(size_t(strand)) && has_cut_tail(state, loop);
    if (!counts || loop.cover < LoopSeen::kCloses || found.count == sim::kMostLoops) return;
    found.at[size_t(found.count++)] = loop.s;
  });
  std::sort(found.at.begin(), found.at.begin() + found.count);
  return found;
}

int sling_of_hand(const sim::State& state, int hand) {
  int left = -1;
  for (size_t i = 0; i < state.objects.sutures.size(); ++i) {
    const interactions::SlingState& g = state.objects.sutures[i].sling;
    if (g.hand != hand || g.stage == interactions::SlingState::packed) continue;
    if (g.stage != interactions::SlingState::left) return int(i);
    left = int(i);
  }
  return left;
}

}  // namespace trocar::training
