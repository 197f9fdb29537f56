#include <trocar/scene/mechanisms/mechanism_file.hpp>
#include <trocar/scene/mechanisms/mechanism_keys.hpp>

namespace trocar::scene {
namespace {

/// A dimension: a number, or a text of parameters; its reader checks it.
Key dimension(std::string name, std::string meaning) {
  return keys::any(std::move(name), std::move(meaning) + "; a number, or a sum of parameters such as \"2 * rod - 3\"");
}
Key dimensions(std::string name, std::string meaning) {
  return keys::any(std::move(name), std::move(meaning) + "; three numbers or sums of parameters");
}
Key list(Key key, std::size_t most) {
  key.max_count = most;
  return key;
}
template <class... Key>
std::vector<scene::Key> with_place(Key... others) {
  std::vector<scene::Key> all{others...};
  all.push_back(dimensions("at_mm", "where, default: [0, 0, 0]"));
  all.push_back(dimensions("turn_deg", "turned there about the fixed x, then y, then z axis, default: not"));
  all.push_back(keys::object("dh", mechanism_dh_keys, "instead of both: Denavit-Hartenberg, as robots are described"));
  return all;
}

}  // namespace

const Shape& mechanism_parameter_keys() {
  static const Shape shape{
      "parameter",
      "A dimension with a name: a length, an angle or a ratio. Design studies change it.",
      {needed(keys::name("name", "its name in dimensions; letters, digits and _")),
       keys::number("length_mm", -kFarMechanism, kFarMechanism, "of a length: its value"),
       keys::number("angle_deg", -kMostDegrees, kMostDegrees, "of an angle: its value"),
       keys::number("ratio", -kMostRatio, kMostRatio, "of a ratio: its value"),
       list(keys::numbers("between", -kMostRatio, kMostRatio, 2, "low and high, within which a study may change it"),
            2),
       keys::number("plus_minus", 0, kFarMechanism, "manufacturing tolerance, default: unknown")}};
  return shape;
}

const Shape& mechanism_dh_keys() {
  static const Shape shape{
      "dh",
      "Modified Denavit-Hartenberg numbers: about x by alpha, along it by a, about the new z by theta, along it by d.",
      {dimension("alpha_deg", "default 0"), dimension("a_mm", "default 0"), dimension("theta_deg", "default 0"),
       dimension("d_mm", "default 0")}};
  return shape;
}

const Shape& mechanism_joint_keys() {
  static const Shape shape{
      "joint",
      "The motion of a link against its parent. Coordinates: with one freedom the joint's name, with several "
      "NAME.angle, "
      ".slide, "
      ".about_x, .about_y, .about_z, .along_x, .along_y.",
      {needed(keys::choice(
           "kind", {"fixed", "revolute", "prismatic", "cylindrical", "helical", "universal", "spherical", "planar"},
           "revolute: turns about axis; prismatic: slides along it; cylindrical: both; helical: a screw; "
           "universal: about x, then y; spherical: about x, y, then z; planar: along x and y, about z")),
       keys::name("name", "of its coordinate, default: the link's"),
       keys::vec3("axis", -1e3, 1e3, "in the link's own axes, default [0, 0, 1]"),
       dimension("pitch_mm", "of a helical joint: how far in a turn"),
       list(keys::numbers("limits_deg", -kMostDegrees, kMostDegrees, 2, "low and high of each of its angles"), 6),
       list(keys::numbers("limits_mm", -kFarMechanism, kFarMechanism, 2, "low and high of each of its slides"), 4),
       list(keys::numbers("start_deg", -kMostDegrees, kMostDegrees, 1, "where its angles are at first, default 0"), 3),
       list(keys::numbers("start_mm", -kFarMechanism, kFarMechanism, 1, "where its slides are at first, default 0"),
            2)}};
  return shape;
}

const Shape& mechanism_shape_keys() {
  static const Shape shape{
      "shape",
      "Shape of a link for drawing and contact: a capsule or cylinder between two points, or a box.",
      {needed(keys::choice("kind", {"capsule", "cylinder", "box"}, "capsule: with round ends")),
       dimensions("from_mm", "of a capsule or cylinder: one end of its middle line"),
       dimensions("to_mm", "the other end"), dimension("radius_mm", "its radius"),
       dimensions("middle_mm", "of a box, default [0, 0, 0]"), dimensions("edges_mm", "of a box"),
       dimensions("turn_deg", "of a box about its middle, default: not")}};
  return shape;
}

const Shape& mechanism_link_keys() {
  static const Shape shape{
      "mechanism link", "A rigid part. at_mm, turn_deg or dh: where its joint is on its parent.",
      with_place(needed(keys::name("name", "its name")),
                 keys::name("parent", "the link that its joint is on, default: ground, the fixed frame"),
                 needed(keys::object("joint", mechanism_joint_keys, "how it moves")),
                 keys::number("mass_g", 0, 1e7, "default 0; used by dynamics only"),
                 keys::vec3("centre_mm", -kFarMechanism, kFarMechanism, "of mass, default [0, 0, 0]"),
                 list(keys::numbers("inertia_g_mm2", -1e15, 1e15, 6, "about it: xx, yy, zz, xy, xz, yz; default 0"), 6),
                 list(keys::objects("shapes", mechanism_shape_keys, 0, "default: none"), 50))};
  return shape;
}

const Shape& mechanism_motor_keys() {
  static const Shape shape{
      "motor",
      "A coordinate without a link: a wheel, a drum, a motor that others are coupled to.",
      {needed(keys::name("name", "of its coordinate")), keys::choice("kind", {"angle", "slide"}, "default angle"),
       list(keys::numbers("limits_deg", -kMostDegrees, kMostDegrees, 2, "low and high"), 2),
       list(keys::numbers("limits_mm", -kFarMechanism, kFarMechanism, 2, "low and high"), 2),
       keys::number("start_deg", -kMostDegrees, kMostDegrees, "at first, default 0"),
       keys::number("start_mm", -kFarMechanism, kFarMechanism, "at first, default 0")}};
  return shape;
}

const Shape& mechanism_term_keys() {
  static const Shape shape{"term",
                           "A multiple of another coordinate.",
                           {needed(keys::text("of", "the other coordinate")), dimension("ratio", "of like to like"),
                            dimension("ratio_mm_deg", "of a slide to an angle: a drum, a rack"),
                            dimension("ratio_deg_mm", "of an angle to a slide")}};
  return shape;
}

const Shape& mechanism_coupling_keys() {
  static const Shape shape{
      "coupling",
      "A coordinate that follows others, as cables, gears and levers make it: an offset and a sum of multiples.",
      {needed(keys::text("coordinate", "which follows")), dimension("offset_deg", "of an angle, default 0"),
       dimension("offset_mm", "of a slide, default 0"),
       needed(list(keys::objects("terms", mechanism_term_keys, 1, "what it follows"), 20))}};
  return shape;
}

const Shape& mechanism_actuator_keys() {
  static const Shape shape{
      "actuator",
      "A driven coordinate, from its value at drive 0 to its value at drive 1.",
      {needed(keys::name("name", "of the drive: handle, motor")), needed(keys::text("coordinate", "which it drives")),
       dimension("at_0_deg", "of an angle"), dimension("at_1_deg", "of an angle"), dimension("at_0_mm", "of a slide"),
       dimension("at_1_mm", "of a slide")}};
  return shape;
}

const Shape& mechanism_frame_keys() {
  static const Shape shape{"mechanism frame", "A named place on a link: a tip, a remote centre.",
                           with_place(needed(keys::name("name", "its name in goals and tables")),
                                      keys::name("link", "which it is fixed on, default: ground"))};
  return shape;
}

const Shape& mechanism_end_keys() {
  static const Shape shape{"end", "A place on a link.", with_place(keys::name("link", "default: ground"))};
  return shape;
}

const Shape& mechanism_closure_keys() {
  static const Shape shape{
      "closure",
      "A constraint between two links besides the joints. It closes a loop.",
      {needed(keys::name("name", "its name in messages")),
       keys::choice("kind", closure_words(),
                    "All directions (rigid). Free about z (pin), about a point (ball), along a's x (slider), along and "
                    "about z (cylinder). B's origin on a's x axis (slot), on its z axis (through), on its plane of x "
                    "and y (plane). One point, a's x square to b's y (universal). Or give directions"),
       list(keys::texts("directions", "of a's frame that are held: tx, ty, tz, rx, ry, rz"), 6),
       needed(keys::object("a", mechanism_end_keys, "one side")),
       needed(keys::object("b", mechanism_end_keys, "the other"))}};
  return shape;
}

const Shape& mechanism_spring_keys() {
  static const Shape shape{
      "spring",
      "A spring and damper between two points, for dynamics.",
      {needed(keys::name("name", "its name in messages")), needed(keys::object("a", mechanism_end_keys, "one end")),
       needed(keys::object("b", mechanism_end_keys, "the other")), keys::number("stiffness_N_m", 0, 1e9, "default 0"),
       keys::number("damping_N_s_m", 0, 1e9, "default 0"),
       keys::number("rest_mm", 0, kFarMechanism, "length without force, default 0")}};
  return shape;
}

const Shape& mechanism_shape() {
  using kinematics::kMostLinks;
  static const Shape shape{
      "mechanism file",
      "A mechanism: links with joints, loop closures, couplings and drives.",
      {keys::text("$schema", "where editors find this kind of file's schema"), keys::format(1),
       needed(keys::name("name", "of the mechanism")), keys::text("title", "one line for lists"),
       list(keys::objects("parameters", mechanism_parameter_keys, 0, "dimensions with names"), 500),
       needed(list(keys::objects("links", mechanism_link_keys, 1, "in any order"), kMostLinks)),
       list(keys::objects("motors", mechanism_motor_keys, 0, "coordinates without a link"), 100),
       list(keys::objects("couplings", mechanism_coupling_keys, 0, "coordinates that follow others"), 100),
       list(keys::objects("actuators", mechanism_actuator_keys, 0, "what is driven"), 100),
       list(keys::objects("frames", mechanism_frame_keys, 0, "places with names"), 200),
       list(keys::objects("closures", mechanism_closure_keys, 0, "loops"), 50),
       list(keys::objects("springs", mechanism_spring_keys, 0, "for dynamics"), 100),
       keys::vec3("gravity_m_s2", -100, 100, "default [0, 0, -9.81]")}};
  return shape;
}

}  // namespace trocar::scene
