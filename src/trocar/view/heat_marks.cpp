#include <algorithm>

#include <trocar/tissue/heat_look.hpp>
#include <trocar/view/heat_marks.hpp>

namespace trocar::view {

constexpr float kBelow = 0.0003f;  // [m] skins' flat triangles cut through cells of the border

std::uint8_t burn_of(const tissue::HeatReading& reading) {
  const tissue::HeatLook l = tissue::look(reading);
  return std::uint8_t(std::clamp(100 * l.pale + 80 * l.tan + 75 * l.char_, 0.0f, 255.0f));
}

std::vector<Vec3d> below_skin(const tissue::Skin& skin) {
  std::vector<Vec3d> places;
  for (std::size_t i = 0; i < skin.rest.size(); ++i)
    places.push_back(vec_cast<double>(skin.rest[i] - kBelow * skin.rest_normal[i]));
  return places;
}

HeatMarks::HeatMarks(const sim::Model& model, std::int32_t body, std::vector<Vec3d> places)
    : m_model(&model), m_body(body), m_places(std::move(places)), m_burn(m_places.size(), 0) {}

bool HeatMarks::stirred(const sim::State& state) {
  if (!m_model->energy.there || state.heat.tick == m_tick) return false;
  m_tick = state.heat.tick;
  Vec3d low, high;
  const bool heated = heated_box(m_model->energy.heat, state.heat, m_body, low, high), before = m_any;
  m_any = heated;
  return heated || before;
}

std::uint8_t HeatMarks::burn_at(const sim::State& state, Vec3d place) const {
  return burn_of(reading(m_model->energy.heat, state.heat, m_body, place));
}

bool HeatMarks::update(const sim::State& state) {
  if (!stirred(state)) return false;
  Vec3d low{0, 0, 0}, high{0, 0, 0};
  heated_box(m_model->energy.heat, state.heat, m_body, low, high);
  const auto inside = [&](Vec3d p) {
    return m_any && p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y && p.z <= high.z;
  };
  bool changed = false;
  for (std::size_t i = 0; i < m_places.size(); ++i) {
    const std::uint8_t burn = inside(m_places[i]) ? burn_at(state, m_places[i]) : std::uint8_t(0);
    changed = changed || burn != m_burn[i];
    m_burn[i] = burn;
  }
  return changed;
}

}  // namespace trocar::view
