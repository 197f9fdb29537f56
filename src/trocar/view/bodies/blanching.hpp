// What a drug that narrows vessels has left on an organ that is drawn: how pale its vertices are (render::Paint::tint),
// and the colour that they pale to. A fifth of the blood is left in the tissue [Beer-Lambert]:
//   C_pale = C T^-0.8,  T = exp(-mu f l)      mu of whole blood (fluids/optics.hpp), f l of the flesh's own blood
// f l 0.02 mm is our choice: a uterus goes from pink to ivory, and not to white.
#pragma once

#include <vector>

#include <trocar/sim/model/state.hpp>
#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

inline constexpr double kBloodLeft = 0.2;

/// Linear colour of blanched tissue whose own colour is `natural`.
Vec3f pale_of(Vec3f natural);

class Blanching {
 public:
  /// @param organ  its number; @param skin  that is drawn
  Blanching(const sim::Model& model, std::size_t organ, const tissue::Skin& skin);

  /// Looks again twice a second. True where something has changed since the last time.
  bool update(const sim::State& state);
  bool any() const { return m_any; }
  std::uint8_t pale(std::size_t vertex) const { return m_pale[vertex]; }

 private:
  const sim::Model* m_model;
  std::size_t m_organ;
  const tissue::Skin* m_skin;
  std::vector<std::uint8_t> m_pale;
  std::uint64_t m_turn = ~0ull;
  bool m_any = false;
};

}  // namespace trocar::view
