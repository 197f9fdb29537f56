#include <algorithm>
#include <cmath>

#include <trocar/fluids/optics.hpp>
#include <trocar/sim/stages/injecting.hpp>
#include <trocar/view/bodies/blanching.hpp>

namespace trocar::view {
namespace {

constexpr double kFleshBlood = 2e-5;  // [m] f l
constexpr std::uint64_t kEvery = 500;  // ticks

}  // namespace

Vec3f pale_of(Vec3f natural) {
  const fluids::Rgb t = fluids::transmission(fluids::Optics{}, {.blood = 1}, kFleshBlood);
  const auto paler = [](float c, double through) {
    return float(std::min(0.9, double(c) * std::pow(through, kBloodLeft - 1)));
  };
  return {paler(natural.x, t.r), paler(natural.y, t.g), paler(natural.z, t.b)};
}

Blanching::Blanching(const sim::Model& model, std::size_t organ, const tissue::Skin& skin)
    : m_model(&model), m_organ(organ), m_skin(&skin), m_pale(skin.rest.size(), 0) {}

bool Blanching::update(const sim::State& state) {
  if (!state.injection.there() || m_organ >= state.injection.organs.size()) return false;
  if (state.tick / kEvery == m_turn || (state.injection.account.drugged == 0 && !m_any)) return false;
  m_turn = state.tick / kEvery;
  bool changed = false;
  m_any = false;
  for (std::size_t v = 0; v < m_pale.size(); ++v) {
    const double share = sim::blanched_at(state, m_organ, *m_skin, int(v));
    const auto pale = std::uint8_t(255 * std::clamp(share, 0.0, 1.0) + 0.5);
    changed = changed || pale != m_pale[v];
    m_any = m_any || pale > 0;
    m_pale[v] = pale;
  }
  return changed;
}

}  // namespace trocar::view
