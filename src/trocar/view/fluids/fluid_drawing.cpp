#include <trocar/view/fluids/fluid_drawing.hpp>

namespace trocar::view {
namespace {

constexpr float kCellsScatter = 1.6e3f;  // [1/m] red cells, forward scattering left out: blood is no red glass
constexpr float kBloodOrange = 7e3f;  // [1/m] mean of whole blood at 585 to 600 nm, tabulated [Prahl 1999], as Optics

Vec3f to_float(const fluids::Rgb& c) { return {float(c.r), float(c.g), float(c.b)}; }

}  // namespace

render::LiquidLook liquid_look(const fluids::Optics& o) {
  render::LiquidLook look;
  look.kinds[0] = {to_float(o.arterial), kCellsScatter, to_float(o.deep_blood), 20, kBloodOrange};
  look.kinds[1] = {to_float(o.saline), 0, {0, 0, 0}, 0, 0};
  look.kinds[2] = {to_float(o.bile), 0, to_float(o.deep_bile), 1, 0};
  return look;
}

FluidDrawing::FluidDrawing(const fluids::FluidsModel& model, const fluids::Optics& optics)
    : m_model(&model), m_look(liquid_look(optics)), m_pool(model), m_film(model), m_jet(model) {}

void FluidDrawing::list(const FluidSight& sight, render::Frame& frame) {
  render::Liquid& liquid = frame.liquid;
  liquid.look = m_look;
  liquid.down = normalised(vec_cast<float>(m_model->droplets.gravity), Vec3f{0, 0, -1});
  m_pool.list(sight, liquid);
  m_film.list(sight, liquid);
  m_jet.list(sight, frame.camera.position, liquid);
}

}  // namespace trocar::view
