#include <trocar/scene/operating_room/room_file.hpp>
#include <trocar/scene/operating_room/room_keys.hpp>

namespace trocar::scene {
namespace {

constexpr double kFarInRoom = 5000;  // [mm]

Key bounded_list(Key key, std::size_t most) {
  key.max_count = most;
  return key;
}

}  // namespace

std::vector<std::string> staff_words() {
  return {"surgeon", "assistant", "camera_holder", "scrub_nurse", "anaesthetist"};
}

const Shape& room_patient_keys() {
  static const Shape shape{
      "room patient",
      "A person on the back. Outlines are our estimate; these figures scale them.",
      {keys::number("stature_mm", 1200, 2200, "default 1700"),
       keys::number("breadth_mm", 220, 600, "of the waist, default 326"),
       keys::number("depth_mm", 130, 450, "from the back to the umbilicus with gas in, default 205"),
       keys::number("rise_mm", 0, 80, "of the abdominal wall by gas, default 30"),
       keys::number("legs_apart_deg", 0, 100, "default 0"), keys::flag("arms_out", "on boards; default false")}};
  return shape;
}

const Shape& room_table_keys() {
  static const Shape shape{
      "room table",
      "The operating table. It tilts about axes below its top, with the patient, the ports and everything clamped to "
      "it.",
      {keys::number("width_mm", 300, 900, "default 540"), keys::number("thickness_mm", 20, 200, "default 70"),
       keys::number("height_mm", 400, 1300, "of its top above the floor while level, default 800"),
       keys::number("head_down_deg", -60, 60, "at the start; below 0: head up; default 0"),
       keys::number("left_down_deg", -45, 45, "at the start; below 0: right side down; default 0"),
       keys::number("head_down_most_deg", 0, 60, "default 30"), keys::number("head_up_most_deg", 0, 60, "default 30"),
       keys::number("side_most_deg", 0, 45, "either way, default 20"),
       keys::number("axes_below_mm", 0, 800, "how far below its top the axes of tilt are, default 250"),
       keys::number("fastest_deg_s", 0.1, 90, "greatest speed of its tilt, default 3 (our estimate)")}};
  return shape;
}

const Shape& room_port_keys() {
  static const Shape shape{
      "room port",
      "A trocar, beside those of the scene.",
      {needed(keys::name("name", "its name")), needed(keys::vec3("at_mm", -600, 600, "in the skin")),
       keys::number("diameter_mm", 2, 20, "default 5")}};
  return shape;
}

const Shape& room_instrument_keys() {
  static const Shape shape{
      "room instrument",
      "An instrument in a port, seen from outside: a shaft and its handle.",
      {needed(keys::name("name", "its name in tables")), needed(keys::name("port", "of the room or its scene")),
       needed(keys::vec3("tip_mm", -600, 600, "where its tip is")),
       keys::name("held_by", "one of the staff; default: nobody"),
       keys::number("length_mm", 100, 700, "from tip to handle, default 310"),
       keys::number("diameter_mm", 1, 15, "of the shaft, default 5"),
       keys::flag("camera", "an endoscope with its camera; default false")}};
  return shape;
}

const Shape& room_person_keys() {
  static const Shape shape{
      "room person",
      "A person of the staff. The feet stay on the floor when the table moves.",
      {needed(keys::name("name", "the person's name")), needed(keys::choice("role", staff_words(), "what they do")),
       needed(bounded_list(keys::numbers("at_mm", -kFarInRoom, kFarInRoom, 2, "x and y of the feet"), 2)),
       keys::number("step_mm", 0, 600, "height of a step under the feet, default 0"),
       keys::number("stature_mm", 1400, 2200, "default 1750"),
       keys::number("reach_mm", 300, 1200, "reach from the shoulder to the grip, default 720")}};
  return shape;
}

const Shape& room_monitor_keys() {
  static const Shape shape{"room monitor",
                           "A screen that faces the patient.",
                           {needed(keys::name("name", "its name in tables")),
                            needed(keys::vec3("at_mm", -kFarInRoom, kFarInRoom, "its middle")),
                            keys::number("diagonal_mm", 200, 2000, "default 660")}};
  return shape;
}

const Shape& room_arm_keys() {
  static const Shape shape{
      "room arm",
      "A telemanipulator's arm: a mechanism docked to a port by its remote centre, the origin of its fixed frame, "
      "whose z "
      "points out along the shaft in the middle of its range and y to its base.",
      {needed(keys::name("name", "its name in programmes")),
       needed(keys::text("mechanism", "a mechanism's file, from this file on")),
       needed(keys::name("port", "of the room or its scene")),
       needed(keys::choice("on", {"floor", "table"}, "its base: on the floor it does not tilt with the table")),
       needed(keys::vec3("base", -1e4, 1e4, "direction from the port to its base, any length")),
       keys::vec3("out", -1e4, 1e4, "direction out along the shaft; default: as the skin's at the port"),
       needed(bounded_list(keys::numbers("stand_mm", -kFarInRoom, kFarInRoom, 2, "x and y of its column"), 2)),
       keys::number("set_up_mm", 50, kFarInRoom,
                    "how far from its column set-up joints carry its base, default 1000 (our estimate)"),
       keys::name("tip", "its frame that follows the goal, default tip"),
       keys::name("shaft", "its frame whose z axis goes through the port, default shaft"),
       keys::number("fastest_deg_s", 1, 2000, "of its turning coordinates, default 114.6 (2 rad/s; our estimate)"),
       keys::number("fastest_mm_s", 1, 5000, "of its sliding ones, default 200 (our estimate)")}};
  return shape;
}

const Shape& room_target_keys() {
  static const Shape shape{"room target",
                           "A working volume for port planning.",
                           {needed(keys::name("name", "its name on the command line")),
                            needed(keys::vec3("low_mm", -600, 600, "its least corner")),
                            needed(keys::vec3("high_mm", -600, 600, "its greatest"))}};
  return shape;
}

const Shape& room_shape() {
  static const Shape shape{
      "room file",
      "An operating room: patient, table, ports, instruments, people, monitors and telemanipulators. Places are in the "
      "patient's frame with the table level: umbilicus, x to the patient's left, y to the head, z to the front.",
      {keys::text("$schema", "where editors find this kind of file's schema"), keys::format(1),
       needed(keys::name("name", "of the room")), keys::text("title", "one line for lists"),
       keys::text("ports_of", "a scene whose ports are here, too; from this file on"),
       keys::object("patient", room_patient_keys, "default: as its keys say"),
       keys::object("table", room_table_keys, "default: as its keys say"),
       bounded_list(keys::objects("ports", room_port_keys, 0, "beside those of the scene"), kMostPorts),
       bounded_list(keys::objects("instruments", room_instrument_keys, 0, "held by hands"), kMostPorts),
       bounded_list(keys::objects("staff", room_person_keys, 0, "who is there"), kMostPeople),
       bounded_list(keys::objects("monitors", room_monitor_keys, 0, "screens"), 8),
       bounded_list(keys::objects("arms", room_arm_keys, 0, "telemanipulators"), kMostArms),
       bounded_list(keys::objects("targets", room_target_keys, 0, "working volumes for port planning"), 16),
       keys::number("margin_mm", 0, 100, "a smaller distance counts as a collision, default 5")}};
  return shape;
}

const Shape& programme_pose_keys() {
  static const Shape shape{
      "pose",
      "The position of an arm's tip at a time.",
      {needed(keys::number("at_s", 0, kLongestProgramme, "later than the pose before")),
       needed(keys::vec3("tip_mm", -600, 600, "in the patient's frame")),
       keys::flag("aims", "true: the jaws point in the direction below; default false: any direction"),
       keys::vec3("towards", -1e4, 1e4, "of the jaws, any length; default: along the shaft"),
       keys::number("roll_deg", -360, 360, "about the jaws' direction, default 0")}};
  return shape;
}

const Shape& programme_move_keys() {
  static const Shape shape{"move",
                           "The motion of one arm: from pose to pose with least jerk, at rest in each.",
                           {needed(keys::name("arm", "of the room")),
                            needed(bounded_list(keys::objects("poses", programme_pose_keys, 1, "in time"), 500))}};
  return shape;
}

const Shape& programme_tilt_keys() {
  static const Shape shape{
      "tilt",
      "The tilt of the table at a time.",
      {needed(keys::number("at_s", 0, kLongestProgramme, "later than the one before")),
       keys::number("head_down_deg", -60, 60, "default 0"), keys::number("left_down_deg", -45, 45, "default 0")}};
  return shape;
}

const Shape& programme_shape() {
  static const Shape shape{
      "programme file",
      "Motions of a room's arms, written before they are made, and of its table.",
      {keys::text("$schema", "where editors find this kind of file's schema"), keys::format(1),
       needed(keys::name("name", "of the programme")), keys::text("title", "one line for lists"),
       needed(bounded_list(keys::objects("moves", programme_move_keys, 1, "one an arm at most"), kMostArms)),
       bounded_list(keys::objects("table", programme_tilt_keys, 0, "default: as the room has it"), 100)}};
  return shape;
}

}  // namespace trocar::scene
