#include <algorithm>

#include <trocar/training/observe/energy_watch.hpp>
#include <trocar/training/observe/hands.hpp>

namespace trocar::training {
namespace {

constexpr double kApart = 0.0005;     // [m] places nearer to each other are one
constexpr double kHotTouch = 0.1;     // [s] a hot tip that only brushes past does no harm. Our choice
constexpr double kHotApart = 0.5;     // [s] without a touch, and the next one is another: tips bounce. Our choice
constexpr std::size_t kPlaces = 256;  // of a body; more are not told from each other by anyone

}  // namespace

EnergyWatch::EnergyWatch(std::vector<BodyId> targets, std::vector<BodyId> never)
    : m_targets(std::move(targets)), m_never(std::move(never)) {}

void EnergyWatch::update(const EnergyLimits& limits, const sim::Model& model, const sim::State& state, Incidents& out) {
  for (size_t h = 0; h < state.electrodes.size(); ++h) {
    const sim::ElectrodeHand& electrode = state.electrodes[h];
    Activation& a = m_activation[h];
    judge_touch(int(h), electrode, out);
    if (electrode.current.now.mode == tissue::EnergyMode::off) {
      a = {};
      continue;
    }
    if (electrode.current.now.flows) {
      a.idle_for = 0;
      if (!a.told_place) judge_place(int(h), electrode, out);
      note_place(int(h), limits, model, state);
      continue;
    }
    a.idle_for += sim::kTick;
    if (a.told_idle || a.idle_for <= limits.idle_time) continue;
    a.told_idle = true;
    out.add({Incident::idle, int(h), tip_of(model, state, h), ""});
  }
}

void EnergyWatch::judge_touch(int hand, const sim::ElectrodeHand& electrode, Incidents& out) {
  HotTip& tip = m_hot[size_t(hand)];
  const bool hot = electrode.current.now.hot_touch && electrode.body.exists();
  const bool flows = electrode.current.now.flows;
  if (flows) tip.treated = electrode.body;
  tip.left_for = flows || (hot && electrode.body == tip.treated) ? 0 : tip.left_for + sim::kTick;
  if (tip.left_for >= kHotApart) tip.treated = {};
  const bool touches = hot && electrode.body != tip.treated && !has(m_targets, electrode.body);
  tip.touches_for = touches ? tip.touches_for + sim::kTick : 0;
  tip.away_for = touches ? 0 : tip.away_for + sim::kTick;
  if (tip.away_for >= kHotApart) tip.told = false;
  if (tip.told || tip.touches_for <= kHotTouch) return;
  tip.told = true;
  out.add({Incident::hot_tip, hand, electrode.at, ""});
}

void EnergyWatch::judge_place(int hand, const sim::ElectrodeHand& electrode, Incidents& out) {
  if (!electrode.body.exists() || has(m_targets, electrode.body)) return;
  m_activation[size_t(hand)].told_place = true;
  out.add({has(m_never, electrode.body) ? Incident::never_there : Incident::off_target, hand, electrode.at, ""});
}

void EnergyWatch::note_place(int hand, const EnergyLimits& limits, const sim::Model& model, const sim::State& state) {
  const sim::ElectrodeHand& electrode = state.electrodes[size_t(hand)];
  if (!electrode.body.exists()) return;
  auto at = std::find_if(m_heated.begin(), m_heated.end(), [&](const Heated& h) { return h.body == electrode.body; });
  if (at == m_heated.end()) at = m_heated.insert(at, Heated{electrode.body, hand, electrode.at, 0, false, {}});
  const tissue::ElectrodeDescription& tool = model.tool(state, size_t(hand)).electrode.current;
  at->hand = hand;
  at->where = electrode.at;
  at->allowed = tool.radius + (tool.bipolar ? limits.bipolar_spread : limits.hook_spread);
  const auto near = [&](const tissue::Treated& t) {
    return length(t.a - electrode.a) < kApart && length(t.b - electrode.b) < kApart;
  };
  if (at->places.size() < kPlaces && std::none_of(at->places.begin(), at->places.end(), near))
    at->places.push_back({electrode.a, electrode.b});
}

void EnergyWatch::look_at_spread(const sim::Model& model, const sim::State& state, Incidents& out) {
  for (Heated& h : m_heated) {
    if (h.told || tissue::spread(model.energy.heat, state.heat, h.body, h.places) <= h.allowed) continue;
    h.told = true;
    out.add({Incident::spread, h.hand, h.where, ""});
  }
}

}  // namespace trocar::training
