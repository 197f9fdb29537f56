#include <algorithm>

#include <trocar/core/tick.hpp>
#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/observe/watches.hpp>

namespace trocar::training {
namespace {

bool is_tissue(BodyId body) {
  return !body.is(BodyKind::rigid) && !body.is(BodyKind::bag) && !body.is(BodyKind::suture);
}

/// What a hand pulls at tissue with [N]. Hands that hold one needle pull at each other through it: of that tissue bears
/// only what is left over, and the hand that makes most of it is to blame.
double pull_at_tissue(const sim::Model& model, const sim::State& state, std::size_t hand) {
  const auto pull_of = [&](std::size_t h) {
    const double(&pull)[3] = state.tools[h].pull;
    return Vec3d{pull[0], pull[1], pull[2]};
  };
  const BodyId body = state.tools[hand].hold[0].at.body;
  if (is_tissue(body)) return length(pull_of(hand));
  Vec3d left;
  for (std::size_t h = 0; h < hands(model); ++h)
    if (state.tools[h].holds > 0 && state.tools[h].hold[0].at.body == body) left += pull_of(h);
  return 2 * dot(pull_of(hand), left) < dot(left, left) ? 0 : length(left);
}

}  // namespace

void PullWatch::update(const Handling& limits, const Tissues& tissues, const sim::Model& model, const sim::State& state,
                       Incidents& out) {
  for (size_t h = 0; h < hands(model); ++h) {
    const interactions::ToolState& tool = state.tools[h];
    const bool delicate = tool.holds > 0 && has(tissues.delicate, tool.hold[0].at.body);
    const double limit = delicate ? limits.pull_limit : limits.pull_limit_other;
    const double before = m_over_for[h];
    m_over_for[h] = tool.holds > 0 && pull_at_tissue(model, state, h) > limit ? before + sim::kTick : 0;
    if (before < limits.pull_excursion && m_over_for[h] >= limits.pull_excursion)
      out.add({Incident::overpulled, int(h), tip_of(model, state, h), delicate ? "delicate tissue" : "other tissue"});
  }
}

void TearWatch::update(const sim::Model& model, const sim::State& state, const sim::StepReport& report,
                       Incidents& out) {
  constexpr std::uint64_t kGoesOn =
      core::kTicksPerSecond;  // [ticks] without a tear, after which the next one is another
  for (int i = 0; i < report.event_count; ++i) {
    const sim::Event& e = report.events[i];
    if (e.kind != sim::Event::torn || e.hand < 0) continue;  // what tears by itself is nobody's
    const auto known = std::find_if(m_torn.begin(), m_torn.end(), [&e](const Torn& t) { return t.body == e.body; });
    const bool goes_on = known != m_torn.end() && state.tick - known->tick < kGoesOn;
    if (known == m_torn.end())
      m_torn.push_back({e.body, state.tick});
    else
      known->tick = state.tick;
    if (!goes_on) out.add({Incident::torn, e.hand, tip_of(model, state, size_t(e.hand)), ""});
  }
}

void PinchWatch::update(const Handling& limits, const Tissues& tissues, const sim::Model& model,
                        const sim::State& state, Incidents& out) {
  for (size_t h = 0; h < hands(model); ++h) {
    const interactions::ToolState& tool = state.tools[h];
    if (tool.holds == 0 || !has(tissues.bowel, tool.hold[0].at.body)) {
      m_impulse[h] = 0;
      m_told[h] = false;
      continue;
    }
    m_impulse[h] += tool.pinch * sim::kTick;
    const bool hard = tool.pinch > limits.pinch_limit, lasting = m_impulse[h] > limits.pinch_impulse;
    if (m_told[h] || (!hard && !lasting)) continue;
    m_told[h] = true;
    out.add({Incident::overpinched, int(h), tip_of(model, state, h), hard ? "force" : "force and time"});
  }
}

SightWatch::SightWatch(const sim::Model& model) {
  for (size_t h = 0; h < hands(model); ++h) {
    const std::string& name = model.hands[h].name;
    m_targets[h] = {{model.target_index(name + ".jaw_a"), model.target_index(name + ".jaw_b")},
                    model.target_index(name + ".shaft")};
  }
}

void SightWatch::update(const Handling& limits, const sim::Model& model, const sim::State& state,
                        const std::array<Vec3d, sim::kMaxTools>& before, const std::array<Vec3d, sim::kMaxTools>& now,
                        double dt, Incidents& out) {
  constexpr double kSmoothing = 0.15;  // [s]
  for (size_t h = 0; h < hands(model); ++h) {
    const Targets& t = m_targets[h];
    m_velocity[h] += std::min(1.0, dt / kSmoothing) * ((now[h] - before[h]) / dt - m_velocity[h]);
    const bool seen = sim::visible(model, state, t.jaw[0]) || sim::visible(model, state, t.jaw[1]);
    const double depth = state.tools[h].depth;
    if (seen || depth < limits.insertion_depth) {
      if (seen && depth >= limits.insertion_depth) m_inserting[h] = false;
      m_blind_for[h] = 0;
      m_told[h] = false;
      continue;
    }
    if (m_inserting[h] && !sim::visible(model, state, t.shaft)) {
      m_inserting[h] = false;
      out.add({Incident::inserted_blind, int(h), now[h], ""});
    }
    // Drawing straight back is safe: the instrument has just been there.
    const double speed = length(m_velocity[h]), back = dot(m_velocity[h], model.hands[h].port - now[h]) / depth;
    if (speed > limits.blind_speed && back < 0.9 * speed) m_blind_for[h] += dt;
    if (m_blind_for[h] <= limits.blind_time || m_told[h]) continue;
    m_told[h] = true;
    out.add({Incident::moved_blind, int(h), now[h], ""});
  }
}

void CollisionWatch::update(const Handling& limits, const sim::Model& model, const sim::State& state, double dt,
                            Incidents& out) {
  Parts now;
  for (size_t h = 0; h < hands(model); ++h) now[h] = sim::shape_of(model, state, h);
  constexpr double kApart = 0.002;  // [m] between two meetings
  const auto velocity = [&](size_t hand, int part, double s) {
    const bool was_there = part < end_of(m_before[hand]);  // another instrument may have fewer links
    const collision::Capsule &b = now[hand].rod(part), &a = was_there ? m_before[hand].rod(part) : b;
    return ((b.a + s * (b.b - b.a)) - (a.a + s * (a.b - a.a))) / dt;
  };
  for (size_t i = 0; i < hands(model); ++i)
    for (size_t j = i + 1; j < hands(model); ++j) {
      bool near = false, fast = false;
      Vec3d where;
      for (int p = interactions::kShaft; p < end_of(now[i]); p = interactions::next(p))
        for (int q = interactions::kShaft; q < end_of(now[j]); q = interactions::next(q)) {
          Vec3f side{};
          const collision::RodContact c = collision::touch(now[i].rod(p), now[j].rod(q), side);
          if (c.depth <= -kApart) continue;
          near = true;
          if (c.depth <= 0) continue;
          where = c.on_first;
          if (m_begun && length(velocity(i, p, c.s) - velocity(j, q, c.t)) > limits.collision_speed) fast = true;
        }
      bool& told = m_touching[i][j];
      if (fast && !told) {
        told = true;
        out.add({Incident::collided, int(i), where, ""});
      }
      if (!near) told = false;
    }
  m_before = now;
  m_begun = true;
}

}  // namespace trocar::training
