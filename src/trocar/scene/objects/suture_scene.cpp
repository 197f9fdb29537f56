#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/scene/objects/suture_scene.hpp>
#include <trocar/sim/model/model.hpp>

namespace trocar::scene {
namespace {

using interactions::SutureModel;

constexpr double kSutureFar = 2000;  // [mm]

std::string sizes_and_makes() {
  std::string all;
  for (const suture::ThreadKind& kind : suture::thread_kinds())
    all += fmt::format("{}{} {}", all.empty() ? "" : ", ", kind.size, kind.make);
  return all;
}

const Shape& suture_shape() {
  static const Shape shape{
      "suture",
      "A needle with a thread swaged on, or either alone. It lies, is held by jaws and goes through tissue.",
      {needed(keys::name("name", "its name in exercises")),
       keys::text("look",
                  "material of its thread, default by its make: \"thread_violet\", \"thread_black\", "
                  "\"thread_white\""),
       keys::text("size", "of the thread: \"3-0\"; default: there is a needle alone"),
       keys::text("make", "of the thread: \"PDS\", \"silk\" or \"polyester\"; needed where there is a size"),
       keys::number("length_mm", 20, 900, "of the thread, default 150"),
       keys::text("needle", "its kind: " + suture::names_of_needles() + "; default: there is a thread alone"),
       keys::text("held_by", "the trocar of the hand whose jaws hold the needle at the start; default: it lies"),
       keys::flag("backhand", "true: held for the opposite driving direction, default false"),
       keys::number("grasped", 0.2, 0.95, "grasp position, as a share of its length from the tip; default 0.65"),
       keys::vec3("at_mm", -kSutureFar, kSutureFar, "of a needle that lies: its middle"),
       keys::vec3("axis", -1, 1, "about which a turn drives the needle, tip first; default (0, 0, 1)"),
       keys::vec3("points", -1, 1, "driving direction of the needle's middle, default (1, 0, 0)"),
       keys::points("line_mm", -kSutureFar, kSutureFar, 2,
                    "the thread at the start, from the needle on; beyond it the thread goes straight on"),
       sling_key()}};
  return shape;
}

std::string look_of(const std::string& make) {
  if (make == "PDS") return "thread_violet";
  return make == "silk" ? "thread_black" : "thread_white";
}

}  // namespace

Quatd needle_turn(Vec3d axis, Vec3d points) {
  const Vec3d z = normalised(axis, Vec3d{0, 0, 1});
  const Vec3d y = normalised(points - dot(points, z) * z, any_perpendicular(z));
  return quat_from_mat3(Mat3d::from_columns(cross(y, z), y, z));
}

Key SutureScene::row() {
  Key row = keys::objects(kKey, suture_shape, 0, "needles and threads, default none");
  row.max_count = 8;
  return row;
}

SutureSetting SutureScene::read(const JsonObject& o) {
  SutureSetting s;
  s.name = o.text("name");
  s.size = o.text("size");
  s.make = o.text("make");
  s.look = o.text("look", look_of(s.make));
  s.needle_look = "polished_steel";
  s.length = o.number("length_mm", 1000 * s.length) / 1000;
  s.needle = o.text("needle");
  s.hand = o.text("held_by");
  s.backhand = o.flag("backhand", false);
  s.grasped = o.number("grasped", s.grasped);
  s.place = o.vec3("at_mm") / 1000.0;
  s.axis = o.vec3("axis", s.axis);
  s.points = o.vec3("points", s.points);
  for (const Vec3d& p : o.points("line_mm")) s.line.push_back(p / 1000.0);
  s.sling = read_sling(o, s);
  if (s.sling.there) s.length = s.sling.thread();
  s.at = o.at();
  s.text = o.value();
  if (s.size.empty() && s.needle.empty()) o.fault(o.at(), "expected a size, a needle or both, got neither");
  if (!s.size.empty() && !suture::find_thread(s.size, s.make))
    o.fault("size", tr("expected an available thread ({}), got \"{} {}\"", sizes_and_makes(), s.size, s.make));
  if (!s.needle.empty() && !suture::needle_kind(s.needle))
    o.fault("needle", tr("expected an available needle ({}), got \"{}\"", suture::names_of_needles(), s.needle));
  if (s.needle.empty() && !s.hand.empty()) o.fault("held_by", "expected it of a needle, got a thread alone");
  if (!s.needle.empty() && o.names("at_mm") == o.names("held_by"))
    o.fault(o.at(), "expected at_mm of a needle that lies or held_by of one that is held, got " +
                        std::string(o.names("at_mm") ? "both" : "neither"));
  if (s.needle.empty() && s.line.size() < 2 && !s.sling.there)
    o.fault(o.at(), "expected line_mm of a thread without a needle, got none");
  if (!(length(cross(s.axis, s.points)) > 1e-6)) o.fault("axis", "expected two directions that differ, got one");
  return s;
}

void SutureScene::compile(const std::vector<Setting>& settings, const Description&, sim::Model& model,
                          std::vector<core::Fault>&) {
  for (const SutureSetting& s : settings) {
    SutureModel m;
    m.name = s.name;
    m.look = s.look;
    m.needle_look = s.needle_look;
    if (const suture::NeedleKind* kind = suture::needle_kind(s.needle)) m.needle = suture::make_needle(*kind);
    m.place = s.place;
    m.turn = needle_turn(s.axis, s.points);
    m.grips = interactions::grips_of(m.needle);
    interactions::part_of<interactions::Suture>(model).list.push_back(std::move(m));
  }
}

}  // namespace trocar::scene
