// Draws a simulation: from a const State to a render::Frame. Meshes are made once from the Model; each frame moves them
// (organs by their skin weights, tubes and folds swept anew) and lists what is to be seen.
//
//   view::SceneView view(model, *backend);
//   render::Frame frame = view.frame(state, {});               // what the endoscope sees
//   render::draw_frame(*backend, frame, target);
//
// Not for the step: it may allocate and is allowed to look different on another machine. The backend must outlive it;
// frame() updates meshes, so it is called between frames and on the backend's thread.
#pragma once

#include <memory>

#include <trocar/render/backend.hpp>
#include <trocar/sim/state.hpp>

namespace trocar::view {

struct ViewOptions {
  enum class Camera {
    scope,    ///< through the endoscope: circular mask, its light, auto exposure
    inside,   ///< the same optics, held at `eye` and pointed at `target`: close-ups
    outside,  ///< from `eye` towards `target`, room light, the scope itself drawn: analysis, operating room
  };
  Camera camera = Camera::scope;
  Vec3d eye{0.05, -0.03, 0.1}, target{0, -0.15, -0.1}, up{0, 0, 1};  ///< inside and outside camera [m]
  double outside_fov = 0.7;                                          ///< [rad] of the picture's height
  bool walls = true;  ///< outside: false leaves out what encloses the scene
  bool instruments = true;
  bool metering = true;  ///< false: exposed as its memory says, which stays as it is
  render::Quality quality;
  int eye_index = 0;  ///< 0..7: each picture has its own exposure memory
};

class SceneView {
 public:
  SceneView(const sim::Model& model, render::Backend& backend);
  ~SceneView();  ///< destroys its meshes
  SceneView(const SceneView&) = delete;
  SceneView& operator=(const SceneView&) = delete;

  /// Moves the meshes to `state` and lists what to draw. `state` must be one of the Model's.
  render::Frame frame(const sim::State& state, const ViewOptions& options);

 private:
  struct Parts;
  std::unique_ptr<Parts> m_parts;
};

}  // namespace trocar::view
