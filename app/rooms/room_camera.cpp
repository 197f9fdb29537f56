#include "rooms/room_camera.hpp"

namespace trocar::app {

RoomCamera::RoomCamera(const view::Scenery& scenery, pictures::PictureSize size)
    : m_size(size), m_context(render::GlContext::off_screen()), m_backend(render::make_gl_backend(*m_context)) {
  m_drawing = std::make_unique<view::RoomDrawing>(*m_backend, scenery);
}

void RoomCamera::take(const view::Scenery& scenery, const view::UprightOrbit& orbit,
                      const std::filesystem::path& file) {
  m_drawing->move(scenery);
  render::draw_frame(*m_backend, m_drawing->frame(orbit), render::Target::off_screen(m_size.width, m_size.height));
  render::write_png(file.string(), m_backend->read_pixels());
}

std::vector<RoomView> room_views() {
  return {{"room", {{0, -0.1, -0.15}, -0.95, 0.40, 3.7}},
          {"feet", {{-0.05, 0.12, 0.05}, -0.42, 0.60, 2.1}},
          {"abdomen", {{0, 0.05, 0.1}, -0.62, 0.55, 1.5}},
          {"above", {{0, 0.05, 0}, 0, 1.45, 1.1}}};
}

}  // namespace trocar::app
