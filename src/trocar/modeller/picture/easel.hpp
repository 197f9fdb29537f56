// Pictures of a document without a window, with the trainer's own renderer.
#pragma once

#include <memory>

#include <trocar/modeller/picture/handles.hpp>
#include <trocar/render/backend/backend.hpp>
#include <trocar/render/frame/image.hpp>
#include <trocar/sim/model/state.hpp>
#include <trocar/view/base/cameras.hpp>
#include <trocar/view/scene/scene_view.hpp>

namespace trocar::render {
class GlContext;
}

namespace trocar::modeller {

class Easel {
 public:
  /// @throws core::EnvironmentLacks without OpenGL
  Easel(int width, int height);
  ~Easel();

  /// Before what it shows is another model, or none.
  void show(const sim::Model* model);

  /// From around a point, in room light.
  render::Image outside(const sim::State& state, const view::Orbit& orbit, const Handles& handles);
  /// Through the scene's endoscope.
  render::Image through_scope(const sim::State& state);

  int width() const { return m_width; }
  int height() const { return m_height; }

 private:
  render::Image draw(const sim::State& state, const view::ViewOptions& options, render::Camera* camera);

  int m_width, m_height;
  std::unique_ptr<render::GlContext> m_context;
  std::unique_ptr<render::Backend> m_backend;
  std::unique_ptr<view::SceneView> m_view;
};

/// As the window has it: seen from around a point.
view::ViewOptions seen_from(const view::Orbit& orbit);

/// Around a box of places [m], all of it in the picture; the model's own where there is none.
view::Orbit orbit_of(const std::vector<Vec3d>& places);

}  // namespace trocar::modeller
