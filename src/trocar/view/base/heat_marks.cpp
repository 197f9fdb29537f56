#include <algorithm>

#include <trocar/tissue/heat/heat_look.hpp>
#include <trocar/view/base/heat_marks.hpp>

namespace trocar::view {

constexpr float kHeatBelow = 0.0003f;  // [m] skins' flat triangles cut through cells of the border
constexpr double kHeatMargin =
    0.0028;  // [m] so far around what is coagulated tissue is drawn paler than it was (our choice)
constexpr double kSmoothing = 0.0044;  // [m]
constexpr int kMostMargin = 100;       // Paint::burn: coagulated, no more

std::uint8_t burn_of(const tissue::HeatReading& reading) {
  const tissue::HeatLook l = tissue::look(reading);
  return std::uint8_t(std::clamp(100 * l.pale + 80 * l.tan + 75 * l.char_, 0.0f, 255.0f));
}

std::vector<Vec3d> below_skin(const tissue::Skin& skin) {
  std::vector<Vec3d> places;
  for (std::size_t i = 0; i < skin.rest.size(); ++i)
    places.push_back(vec_cast<double>(skin.rest[i] - kHeatBelow * skin.rest_normal[i]));
  return places;
}

HeatMarks::HeatMarks(const sim::Model& model, BodyId body, std::vector<Vec3d> places)
    : m_model(&model), m_body(body), m_places(std::move(places)), m_burn(m_places.size(), 0) {}

bool HeatMarks::stirred(const sim::State& state) {
  if (!m_model->energy.there || state.heat.tick == m_tick) return false;
  m_tick = state.heat.tick;
  Vec3d low, high;
  const bool heated = heated_box(m_model->energy.heat, state.heat, m_body, low, high), before = m_any;
  m_any = heated;
  return heated || before;
}

/// Blanching fades over some millimetres, finer than heat's cells tell: the margin of what lies beside counts.
std::uint8_t HeatMarks::burn_at(const sim::State& state, Vec3d place) const {
  const auto at = [&](Vec3d p) { return int(burn_of(reading(m_model->energy.heat, state.heat, m_body, p))); };
  int burn = at(place);
  constexpr Vec3d kWays[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (const double far : {0.3, 0.65})
    for (const Vec3d& way : kWays) {
      if (burn >= kMostMargin) return std::uint8_t(burn);
      const int beside = std::min(at(place + far * kHeatMargin * way), kMostMargin);
      burn = std::max(burn, int((1 - far) * beside));
    }
  return std::uint8_t(burn);
}

/// Skins are coarser than a burn's border: a vertex shows what is around it, too, or the border would follow triangles.
std::uint8_t HeatMarks::smoothed(std::span<const std::size_t> there, std::span<const float> burn, Vec3d place) const {
  float sum = 0, weight = 0;
  for (std::size_t k = 0; k < there.size(); ++k) {
    const Vec3d off = m_places[there[k]] - place;
    const double far2 = dot(off, off) / (kSmoothing * kSmoothing);
    if (far2 >= 1) continue;
    const float w = float((1 - far2) * (1 - far2));
    sum += w * burn[k], weight += w;
  }
  return std::uint8_t(weight > 0 ? sum / weight + 0.5f : 0);
}

bool HeatMarks::update(const sim::State& state) {
  if (!stirred(state)) return false;
  Vec3d low{0, 0, 0}, high{0, 0, 0};
  heated_box(m_model->energy.heat, state.heat, m_body, low, high);
  low -= Vec3d{kHeatMargin, kHeatMargin, kHeatMargin}, high += Vec3d{kHeatMargin, kHeatMargin, kHeatMargin};
  const auto inside = [&](Vec3d p) {
    return m_any && p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y && p.z <= high.z;
  };
  std::vector<std::size_t> there;
  std::vector<float> own;
  std::vector<std::uint8_t> before = m_burn;
  std::fill(m_burn.begin(), m_burn.end(), std::uint8_t(0));
  for (std::size_t i = 0; i < m_places.size(); ++i)
    if (inside(m_places[i])) there.push_back(i), own.push_back(float(burn_at(state, m_places[i])));
  for (const std::size_t i : there) m_burn[i] = smoothed(there, own, m_places[i]);
  return m_burn != before;
}

}  // namespace trocar::view
