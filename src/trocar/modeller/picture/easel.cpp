#include <algorithm>

#include <trocar/modeller/picture/easel.hpp>
#include <trocar/render/gl/gl_context.hpp>

namespace trocar::modeller {

Easel::Easel(int width, int height)
    : m_width(width),
      m_height(height),
      m_context(render::GlContext::off_screen()),
      m_backend(render::make_gl_backend(*m_context)) {}

Easel::~Easel() = default;

void Easel::show(const sim::Model* model) {
  m_context->make_current();
  m_view.reset();
  if (model) m_view = std::make_unique<view::SceneView>(*model, *m_backend);
}

render::Image Easel::draw(const sim::State& state, const view::ViewOptions& options, render::Camera* camera) {
  constexpr int kSettling = 3;  // the exposure follows the picture before
  m_context->make_current();
  render::Frame frame = m_view->frame(state, options);
  if (camera) *camera = frame.camera;
  for (int i = 0; i <= kSettling; ++i) {
    frame.tick = state.tick + std::uint64_t(i) * 2000;
    frame.quality.samples = i == kSettling ? 4 : 1;
    render::draw_frame(*m_backend, frame, render::Target::off_screen(m_width, m_height));
  }
  return m_backend->read_pixels();
}

render::Image Easel::outside(const sim::State& state, const view::Orbit& orbit, const Handles& handles) {
  view::ViewOptions options = seen_from(orbit);
  options.picture_height = m_height;
  render::Camera camera;
  render::Image image = draw(state, options, &camera);
  paint(handles, camera, image);
  return image;
}

render::Image Easel::through_scope(const sim::State& state) {
  view::ViewOptions options;
  options.picture_height = m_height;
  return draw(state, options, nullptr);
}

view::ViewOptions seen_from(const view::Orbit& orbit) {
  view::ViewOptions options;
  options.camera = view::ViewOptions::Camera::outside;
  options.eye = orbit.eye();
  options.target = orbit.target;
  options.walls = false;
  return options;
}

view::Orbit orbit_of(const std::vector<Vec3d>& places) {
  view::Orbit orbit;
  if (places.empty()) return orbit;
  Vec3d low = places[0], high = places[0];
  for (const Vec3d& p : places) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  orbit.target = (low + high) / 2.0;
  orbit.distance = std::clamp(1.7 * length(high - low) + 0.05, 0.06, 1.2);
  return orbit;
}

}  // namespace trocar::modeller
