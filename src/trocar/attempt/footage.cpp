#include <algorithm>

#include <trocar/attempt/footage.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/recording/keyframe.hpp>

namespace trocar::attempt {
namespace {

template <class T>
T mixed(T a, T b, double f) {
  return T(a + f * (b - a));
}

void blend_network(const tissue::NetworkModel& model, const tissue::NetworkState& a, const tissue::NetworkState& b,
                   double f, tissue::NetworkState& out) {
  for (int n = 0; n < model.nodes; ++n) {
    const Vec3d from = tissue::position(model, a, n);
    tissue::set_position(model, out, n, from + f * (tissue::position(model, b, n) - from));
  }
}

/// Between a cut and the keyframe before it there is nothing to blend: the body is shown as it was.
void blend_body(const tissue::CuttableModel& model, const tissue::CuttableState& a, const tissue::CuttableState& b,
                double f, tissue::CuttableState& out) {
  if (a.version != b.version) return;
  for (int n = 0; n < a.tets.nodes; ++n) {
    const Vec3d from = tissue::position(model, a, n);
    tissue::set_position(model, out, n, from + f * (tissue::position(model, b, n) - from));
  }
}

void blend_tool(const interactions::ToolState& a, const interactions::ToolState& b, double f,
                interactions::ToolState& out) {
  for (double interactions::ToolState::*part :
       {&interactions::ToolState::yaw, &interactions::ToolState::pitch, &interactions::ToolState::roll,
        &interactions::ToolState::depth, &interactions::ToolState::aperture, &interactions::ToolState::handle})
    out.*part = mixed(a.*part, b.*part, f);
}

void blend_scope(const sim::ScopeInput& a, const sim::ScopeInput& b, double f, sim::ScopeInput& out) {
  for (float sim::ScopeInput::*part : {&sim::ScopeInput::yaw, &sim::ScopeInput::pitch, &sim::ScopeInput::roll,
                                       &sim::ScopeInput::depth, &sim::ScopeInput::post})
    out.*part = mixed(a.*part, b.*part, f);
}

/// A wipe that began in between begins at `b`.
void blend_lens(const fluids::SmokeState& a, const fluids::SmokeState& b, double f, fluids::SmokeState& out) {
  out.fog = mixed(a.fog, b.fog, f);
  if (a.wipe_left >= b.wipe_left) out.wipe_left = mixed(a.wipe_left, b.wipe_left, f);
}

}  // namespace

void blend(const sim::Model& model, const sim::State& a, const sim::State& b, double f, sim::State& out) {
  if (f >= 1) {
    out = b;
    return;
  }
  out = a;
  if (!(f > 0)) return;
  out.tick = a.tick + std::uint64_t(f * double(b.tick - a.tick));
  const auto mix = [&](auto r) {
    blend_network(network_of(model, r), network_state_of(a, r), network_state_of(b, r), f, network_state_of(out, r));
  };
  sim::visit_bodies(model, sim::Overloaded{[&](sim::SolidRef r) { mix(r); }, [&](sim::MembraneRef r) { mix(r); },
                                           [&](sim::CuttableRef r) {
                                             blend_body(model_of(model, r).body, state_of(a, r), state_of(b, r), f,
                                                        state_of(out, r));
                                           },
                                           [&](sim::StrandRef r) {
                                             std::vector<Vec3d>& x = state_of(out, r).x;
                                             for (std::size_t n = 0; n < x.size(); ++n)
                                               x[n] += f * (state_of(b, r).x[n] - x[n]);
                                           }});
  interactions::ObjectKinds::for_each([&](auto kind) {
    using K = decltype(kind);
    kind.blend(interactions::part_of<K>(a), interactions::part_of<K>(b), f, interactions::part_of<K>(out));
  });
  for (std::size_t t = 0; t < out.tools.size(); ++t) blend_tool(a.tools[t], b.tools[t], f, out.tools[t]);
  for (std::size_t t = 0; t < out.joints.size(); ++t)
    for (int j = 0; j < kinematics::kMaxJoints; ++j)
      out.joints[t].angle[j] = mixed(a.joints[t].angle[j], b.joints[t].angle[j], f);
  for (std::size_t t = 0; t < out.ports.size(); ++t)
    out.ports[t].shift = a.ports[t].shift + f * (b.ports[t].shift - a.ports[t].shift);
  blend_scope(a.scope, b.scope, f, out.scope);
  blend_lens(a.fluids.smoke, b.fluids.smoke, f, out.fluids.smoke);
}

Footage::Footage(const sim::Model& model, const std::vector<sim::Keyframe>& keyframes)
    : m_model(model), m_keyframes(keyframes), m_between(sim::initial_state(model)) {
  const auto backwards =
      std::adjacent_find(keyframes.begin(), keyframes.end(),
                         [](const sim::Keyframe& a, const sim::Keyframe& b) { return a.tick >= b.tick; });
  m_sound = backwards == keyframes.end();
  m_count = m_sound ? keyframes.size() : std::size_t(backwards - keyframes.begin()) + 1;
  m_cache[0].state = m_cache[1].state = m_between;
}

/// The keyframe's State, from the cache or decoded into the slot that is not `keep`.
const Footage::Shown& Footage::shown(std::size_t index, const Shown* keep) {
  for (const Shown& s : m_cache)
    if (s.index == index) return s;
  Shown& slot = m_cache[&m_cache[0] == keep ? 1 : 0];
  slot.index = index;
  if (!sim::restore_display(m_model, m_keyframes[index].bytes, slot.state)) {
    m_sound = false;
    m_count = std::min(m_count, index);
  }
  slot.state.tick = m_keyframes[index].tick;
  return slot;
}

const sim::State& Footage::at(std::uint64_t tick) {
  if (m_count == 0) return m_between;
  const auto begin = m_keyframes.begin(), end = begin + std::ptrdiff_t(m_count);
  const auto after =
      std::upper_bound(begin, end, tick, [](std::uint64_t t, const sim::Keyframe& k) { return t < k.tick; });
  const std::size_t next = std::size_t(after - begin), now = next == 0 ? 0 : next - 1;
  const Shown& a = shown(now, nullptr);
  if (now >= m_count || next == 0 || next >= m_count) return a.state;
  const Shown& b = shown(next, &a);
  if (next >= m_count) return a.state;
  const double span = double(m_keyframes[next].tick - m_keyframes[now].tick);
  blend(m_model, a.state, b.state, double(tick - m_keyframes[now].tick) / span, m_between);
  return m_between;
}

}  // namespace trocar::attempt
