// The scripted surgeon's camera: turned so that all that matters is in the picture, as near as that allows.
#pragma once

#include <span>

#include <trocar/sim/model/state.hpp>

namespace trocar::training {

class CameraHand {
 public:
  explicit CameraHand(const sim::Model& model);

  /// One tick towards a view of all `points` with the nearest at least `distance` from the lens [m].
  void show(std::span<const Vec3d> points, double distance);
  /// Has the picture come to rest where it is wanted?
  bool settled() const { return m_settled; }
  void fill(sim::Input& input) const;

 private:
  Vec3d m_port, m_axis;  ///< unit vector along the scope
  double m_depth = 0;    ///< lens from the trocar [m]
  double m_cone = 0;     ///< tangent of the half angle that points are kept in
  sim::ScopeInput m_input;
  bool m_settled = false;
};

}  // namespace trocar::training
