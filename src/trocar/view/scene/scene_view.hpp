// Draws a simulation: from a const State to a render::Frame. Meshes are made once from the Model; each frame moves them
// (organs by their skin weights, tubes and folds swept again) and lists what is to be seen.
//
//   view::SceneView view(model, *backend);
//   render::Frame frame = view.frame(state, {});               // what the endoscope sees
//   render::draw_frame(*backend, frame, target);
//
// Not for the step: it may allocate and is allowed to look different on another machine. The backend must outlive it;
// frame() updates meshes, so it is called between frames and on the backend's thread.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <trocar/render/backend/backend.hpp>
#include <trocar/sim/model/state.hpp>
#include <trocar/view/analysis/analysis.hpp>
#include <trocar/view/analysis/scene_parts.hpp>

namespace trocar::view {

/// Another endoscope that only looks (second_scope.hpp).
struct SecondScope {
  Vec3d port;  ///< [m]
  kinematics::FulcrumPose pose;

  friend bool operator==(const SecondScope& a, const SecondScope& b) {
    return length(a.port - b.port) == 0 && a.pose.yaw == b.pose.yaw && a.pose.pitch == b.pose.pitch &&
           a.pose.roll == b.pose.roll && a.pose.depth == b.pose.depth;
  }
};

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
  bool metering = true;                       ///< false: exposed as its memory says, which stays as it is
  std::vector<PartStyle> styles;              ///< of SceneView::parts(); those beyond its end are shaded
  std::optional<SecondScope> second_scope;    ///< there is one: seen from outside; its own picture shows the first one
  AnalysisOptions analysis;                   ///< anything on: figures in colour, in a plain camera's light
  std::shared_ptr<const OrganBeside> beside;  ///< for analysis.solvers; null: no other solver runs beside
  render::Quality quality;
  double picture_height = 600;  ///< [px] how finely things are drawn depends on it (detail.hpp)
  int eye_index = 0;            ///< 0..7: each picture has its own exposure memory
};

class SceneView {
 public:
  SceneView(const sim::Model& model, render::Backend& backend);
  ~SceneView();  ///< destroys its meshes
  SceneView(const SceneView&) = delete;
  SceneView& operator=(const SceneView&) = delete;

  /// What the scene is made of; part i has number i + 1 in the frame's items. The same for as long as this lives.
  const std::vector<ScenePart>& parts() const;

  /// Moves the meshes to `state` and lists what to draw. `state` must be one of the Model's.
  render::Frame frame(const sim::State& state, const ViewOptions& options);

 private:
  struct Parts;
  std::unique_ptr<Parts> m_parts;
};

}  // namespace trocar::view
