// A mechanism by itself, a colour a link, as large as a metre whatever it is: what an orbit goes round.
//
//   MechanismDrawing drawing(backend, m, pose);
//   drawing.shape(m);  drawing.move(m, pose);       // other dimensions; another pose
//   drawing.stand_out(link, colour);
//   render::Frame frame = drawing.frame(orbit);
#pragma once

#include <vector>

#include <trocar/kinematics/chains/mechanism.hpp>
#include <trocar/render/frame/frame.hpp>
#include <trocar/view/base/mesh_buffer.hpp>
#include <trocar/view/painted/solids.hpp>
#include <trocar/view/painted/upright_orbit.hpp>

namespace trocar::view {

class MechanismDrawing {
 public:
  MechanismDrawing(render::Backend& backend, const kinematics::Mechanism& m, const kinematics::Pose& pose);

  /// Its shapes as they are with the dimensions that it has now.
  void shape(const kinematics::Mechanism& m);
  void move(const kinematics::Pose& pose);
  /// These links are drawn in other colours from the next shape() on, the others in their own.
  void stand_out(std::vector<std::pair<int, painted::Colour>> links) { m_marked = std::move(links); }

  render::Frame frame(const UprightOrbit& orbit) const;
  /// Where a point of the mechanism is drawn.
  Vec3d drawn(Vec3d point) const { return m_scale * (point - m_middle); }
  painted::Colour colour_of(int link) const;
  /// One that shows all of it.
  UprightOrbit whole() const;
  /// One that shows its joints and frames: of an instrument what is at its end.
  UprightOrbit about_joints(const kinematics::Mechanism& m, const kinematics::Pose& pose) const;

 private:
  struct Part {
    int body = 0;
    OwnedMesh mesh;
    render::Mat4 transform;
  };
  render::Backend* m_backend;
  double m_scale = 1;
  Vec3d m_middle;
  std::vector<Part> m_parts;
  std::vector<std::pair<int, painted::Colour>> m_marked;
};

}  // namespace trocar::view
