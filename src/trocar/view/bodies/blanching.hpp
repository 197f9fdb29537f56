// What a drug that narrows vessels has left on an organ that is drawn: how pale its vertices are (render::Paint::tint),
// and the colour that they pale to. A fifth of the blood is left in the tissue [Beer-Lambert]:
//   C_pale = C T^-0.8,  T = exp(-mu f l)      mu of whole blood (fluids/optics.hpp), f l of the flesh's own blood
// f l 0.02 mm is our choice: a uterus goes from pink to ivory, and not to white.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <trocar/fluids/optics.hpp>
#include <trocar/sim/stages/injecting.hpp>
#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

inline constexpr double kBloodLeft = 0.2;

inline constexpr double kFleshBlood = 2e-5;  ///< f l [m]
inline constexpr float kVesselsLeft =
    0.3f;  ///< of what is seen of a skin's small vessels: they have closed. Our choice

/// Linear colour of blanched tissue whose own colour is `natural`.
inline Vec3f pale_of(Vec3f natural) {
  const fluids::Rgb t = fluids::transmission(fluids::Optics{}, {.blood = 1}, kFleshBlood);
  const auto paler = [](float c, double through) {
    return float(std::min(0.9, double(c) * std::pow(through, kBloodLeft - 1)));
  };
  return {paler(natural.x, t.r), paler(natural.y, t.g), paler(natural.z, t.b)};
}

class Blanching {
 public:
  /// @param organ  its number; @param skin  that is drawn
  Blanching(std::size_t organ, const tissue::Skin& skin) : m_organ(organ), m_skin(&skin), m_pale(skin.rest.size(), 0) {}

  /// Looks again twice a second. True where something has changed since the last time.
  bool update(const sim::State& state) {
    constexpr std::uint64_t kEvery = 500;  // ticks
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
  bool any() const { return m_any; }
  std::uint8_t pale(std::size_t vertex) const { return m_pale[vertex]; }

 private:
  std::size_t m_organ;
  const tissue::Skin* m_skin;
  std::vector<std::uint8_t> m_pale;
  std::uint64_t m_turn = ~0ull;
  bool m_any = false;
};

}  // namespace trocar::view
