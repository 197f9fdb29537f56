// Pictures of a room without a window.
#pragma once

#include <filesystem>
#include <memory>

#include <trocar/pictures/picture_size.hpp>
#include <trocar/render/gl/gl_context.hpp>

#include "rooms/room_scenery.hpp"

namespace trocar::app {

class RoomCamera {
 public:
  /// @throws core::EnvironmentLacks without OpenGL
  RoomCamera(const view::Scenery& scenery, pictures::PictureSize size);
  void take(const view::Scenery& scenery, const view::UprightOrbit& orbit, const std::filesystem::path& file);

 private:
  pictures::PictureSize m_size;
  std::unique_ptr<render::GlContext> m_context;
  std::unique_ptr<render::Backend> m_backend;
  std::unique_ptr<view::RoomDrawing> m_drawing;
};

struct RoomView {
  const char* name;
  view::UprightOrbit orbit;
};
/// From where rooms are shown: all of it, from the feet, the abdomen, from above.
std::vector<RoomView> room_views();

}  // namespace trocar::app
