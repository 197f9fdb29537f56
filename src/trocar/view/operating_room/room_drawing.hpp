// An operating room as one sees it from outside: the patient under drapes with a window over the abdomen, the table,
// people in gowns, arms, instruments out of the body, monitors; lit from above, with soft shadows on the floor. Drawn
// from plain figures: who knows rooms fills a Scenery.
//
//   RoomDrawing drawing(backend, scenery);
//   drawing.move(scenery);                       // arms and table elsewhere
//   render::Frame frame = drawing.frame(orbit, aspect);
#pragma once

#include <vector>

#include <trocar/kinematics/chains/mechanism.hpp>
#include <trocar/render/frame/frame.hpp>
#include <trocar/view/base/cameras.hpp>
#include <trocar/view/painted/solids.hpp>
#include <trocar/view/painted/upright_orbit.hpp>

namespace trocar::view {

/// All in the room's frame (the patient's while the table is level) unless it says so.
struct Scenery {
  geometry::Figure figure;
  kinematics::Frame table;  ///< the patient's frame
  double top = -0.2, floor = -1, table_width = 0.54, table_thickness = 0.07;

  struct Person {
    Vec3d facing, shoulder[2], elbow[2], hand[2];
    Vec3d foot;  ///< between the feet
    double stature = 1.75, step = 0;
    bool scrubbed = true;
  };
  std::vector<Person> people;

  struct Monitor {
    Vec3d middle, half;
    Mat3d axes = Mat3d::identity();
  };
  std::vector<Monitor> monitors;

  struct Port {
    Vec3d place, out;  ///< in the patient's frame
    double radius = 0.0025;
  };
  std::vector<Port> ports;

  struct Instrument {
    Vec3d tip, handle;  ///< in the patient's frame
    double radius = 0.0025;
    bool camera = false;
  };
  std::vector<Instrument> instruments;

  struct Arm {
    const kinematics::Mechanism* mechanism = nullptr;
    const kinematics::Pose* pose = nullptr;
    kinematics::Frame base;  ///< of its fixed frame, in the patient's frame
    Vec3d foot, head, hub;   ///< of its stand, in the patient's frame
    bool on_table = false;
  };
  std::vector<Arm> arms;

  /// Lines between what is near, in the patient's frame.
  struct Gap {
    Vec3d from, to;
    bool bad = false;
  };
  std::vector<Gap> gaps;
  /// Where shafts can point, in the patient's frame: a cone into the body.
  struct Cone {
    Vec3d apex, axis;
    double half_angle = 1.0, length = 0.2;
    painted::Colour colour;
  };
  std::vector<Cone> cones;
  /// Values 0..1 of places on the abdomen (x, y), below 0: none; empty: bare skin.
  std::vector<Vec3d> heat;  ///< x, y, value
  double heat_spacing = 0.02;
  std::vector<Vec3d> chosen;  ///< places on the abdomen that stand out, in the patient's frame
};

class RoomDrawing {
 public:
  RoomDrawing(render::Backend& backend, const Scenery& scenery);

  /// Arms, table, people, gaps and heat as they are now; what stands there must be of the same kinds and number.
  void move(const Scenery& scenery);
  render::Frame frame(const UprightOrbit& orbit) const;

 private:
  struct Piece {
    OwnedMesh mesh;
    render::Mat4 transform;
    render::Material material;
    bool translucent = false;
  };
  Piece piece(const MeshBuffer& b, float gloss) const;
  void add_arm(const Scenery::Arm& arm);
  void place_arms(const Scenery& s);

  render::Backend* m_backend;
  std::vector<Piece> m_still;    ///< in the room: floor, monitors
  std::vector<Piece> m_patient;  ///< with the table
  std::vector<Piece> m_people, m_marks;
  struct ArmPieces {
    std::vector<std::pair<int, Piece>> links;  ///< body, what is on it
    std::vector<Piece> stand;
  };
  std::vector<ArmPieces> m_arms;
};

}  // namespace trocar::view
