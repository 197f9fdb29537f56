// The demonstration's camera: turned so that all that matters is in the picture, as near as that allows.
#pragma once

#include <optional>
#include <span>

#include <trocar/sim/model/state.hpp>

namespace trocar::training {

class CameraHand {
 public:
  explicit CameraHand(const sim::Model& model);

  /// One tick towards a view of all `points` with the nearest at least `distance` from the lens [m].
  /// @param facing  of an oblique scope: out of what is seen, to where its lens shall be; none: upwards
  void show(std::span<const Vec3d> points, double distance, const std::optional<Vec3d>& facing = {});
  /// One tick towards a view of `at` in the picture's middle, from `distance` [m], as far as scope and trocar allow
  /// along `facing` (unit, out of what is seen), the horizon level: light post and camera head turn, too.
  void view(Vec3d at, const std::optional<Vec3d>& facing, double distance);
  /// Has the picture come to rest where it is wanted?
  bool settled() const { return m_settled; }
  void fill(sim::Input& input) const;

 private:
  struct Pose {
    Vec3d axis;  ///< unit
    double depth = 0, post = 0;
  };
  Pose pose_for(Vec3d at, const std::optional<Vec3d>& facing, double distance) const;
  void put(double depth);

  Vec3d m_port, m_axis;  ///< unit vector along the scope
  Vec3d m_plumb;         ///< unit, upwards
  double m_angle = 0;    ///< of the oblique view [rad]
  double m_depth = 0;    ///< lens from the trocar [m]
  double m_cone = 0;     ///< tangent of the half angle that points are kept in
  sim::ScopeInput m_input;
  bool m_settled = false;
};

}  // namespace trocar::training
