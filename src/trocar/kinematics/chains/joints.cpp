#include <trocar/kinematics/chains/joints.hpp>

namespace trocar::kinematics {

std::vector<Freedom> freedoms(const Joint& joint) {
  constexpr Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  const Vec3d axis = normalised(joint.axis, z);
  switch (joint.kind) {
    case JointKind::revolute:
      return {{Motion::turn, axis, ""}};
    case JointKind::prismatic:
      return {{Motion::slide, axis, ""}};
    case JointKind::cylindrical:
    case JointKind::helical:
      return {{Motion::turn, axis, ".angle"}, {Motion::slide, axis, ".slide"}};
    case JointKind::universal:
      return {{Motion::turn, x, ".about_x"}, {Motion::turn, y, ".about_y"}};
    case JointKind::spherical:
      return {{Motion::turn, x, ".about_x"}, {Motion::turn, y, ".about_y"}, {Motion::turn, z, ".about_z"}};
    case JointKind::planar:
      return {{Motion::slide, x, ".along_x"}, {Motion::slide, y, ".along_y"}, {Motion::turn, z, ".about_z"}};
    case JointKind::fixed:
      break;
  }
  return {};
}

std::vector<NamedCoordinate> coordinates_of(const MechanismDescription& d) {
  std::vector<NamedCoordinate> all;
  for (std::size_t i = 0; i < d.links.size(); ++i)
    for (const Freedom& f : freedoms(d.links[i].joint))
      all.push_back({coordinate_name(d.links[i], f), f.motion == Motion::turn ? Measure::angle : Measure::length,
                     int(i), -1, d.links[i].joint.kind == JointKind::helical && f.motion == Motion::slide});
  for (std::size_t i = 0; i < d.motors.size(); ++i)
    all.push_back({d.motors[i].name, d.motors[i].measure, -1, int(i), false});
  return all;
}

}  // namespace trocar::kinematics
