#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/scene/description/description.hpp>
#include <trocar/scene/objects/suture_scene.hpp>
#include <trocar/sim/model/model.hpp>

namespace trocar::scene {
namespace {

using interactions::StitchTissue;
using interactions::SutureModel;
using interactions::SutureModels;

constexpr double kSutureFar = 2000;    // [mm]
constexpr double kWallReach = 0.0025;  // [m] from which on needles and threads know of walls

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
      {needed(keys::name("name", "what exercises call it")),
       keys::text("look",
                  "its thread in the picture, default by its make: \"thread_violet\", \"thread_black\", "
                  "\"thread_white\""),
       keys::text("size", "of the thread: \"3-0\"; default: there is a needle alone"),
       keys::text("make", "of the thread: \"PDS\", \"silk\" or \"polyester\"; needed where there is a size"),
       keys::number("length_mm", 20, 900, "of the thread, default 150"),
       keys::text("needle", "its kind: " + suture::names_of_needles() + "; default: there is a thread alone"),
       keys::text("held_by", "the trocar of the hand whose jaws hold the needle at the start; default: it lies"),
       keys::flag("backhand", "held so that it is driven the other way round, default false"),
       keys::number("grasped", 0.2, 0.95, "where a hand holds it, as a share of its length from the tip; default 0.65"),
       keys::vec3("at_mm", -kSutureFar, kSutureFar, "of a needle that lies: its middle"),
       keys::vec3("axis", -1, 1, "about which a turn drives the needle, tip first; default (0, 0, 1)"),
       keys::vec3("points", -1, 1, "the way that the middle of the needle is driven, default (1, 0, 0)"),
       keys::points("line_mm", -kSutureFar, kSutureFar, 2,
                    "the thread at the start, from the needle on; beyond it the thread goes straight on")}};
  return shape;
}

Vec3d across(Vec3d v, Vec3d n) { return v - dot(v, n) * n; }

std::string look_of(const std::string& make) {
  if (make == "PDS") return "thread_violet";
  return make == "silk" ? "thread_black" : "thread_white";
}

/// Own z about `axis`, own y (the way it is driven in its middle) as near to `points` as it can be.
Quatd turned(Vec3d axis, Vec3d points) {
  const Vec3d z = normalised(axis, Vec3d{0, 0, 1}), y = normalised(across(points, z), any_perpendicular(z));
  return quat_from_mat3(Mat3d::from_columns(cross(y, z), y, z));
}

StitchTissue stitch_of(const Description& d, const std::string& tissue) {
  StitchTissue t;
  for (const Tissue& row : d.tissues) {
    if (row.name != tissue) continue;
    if (row.puncture > 0) t.puncture = row.puncture;
    if (row.stitch_damage > 0) t.damage = row.stitch_damage;
  }
  return t;
}

/// The needle between the jaws as they are at the start: across them, so that the shaft's roll drives it.
void put_in_jaws(const SutureSetting& s, const sim::Model& model, std::size_t hand, SutureModel& m) {
  const interactions::ToolModel& tool = model.placed(hand);
  const interactions::ToolShape shape = interactions::shape_of(tool, sim::pose_of(model.start.tools[hand]), 0.1);
  const Vec3d middle = interactions::from_jaw(shape, {0, 0, 0.6 * tool.jaw_length});
  const Vec3d axis = interactions::direction_from_jaw(shape, {0, 0, s.backhand ? -1.0 : 1.0});
  const Vec3d along = interactions::direction_from_jaw(shape, {0, 1, 0});
  const double arc = s.grasped * m.needle.length;
  const Vec3d own = m.needle.along(arc);
  // first so that the plane stands across the shaft, then about its axis so that the wire lies across the jaws
  const Quatd stands = turned(axis, along);
  const Vec3d drives = rotate(stands, own);
  const double angle = portable::atan2(dot(cross(drives, along), axis), dot(drives, along));
  m.turn = quat_from_axis_angle(axis, angle) * stands;
  m.place = middle - rotate(m.turn, m.needle.place(arc));
  m.hand = std::int32_t(hand);
}

suture::ThreadDescription thread_of(const SutureSetting& s, const suture::ThreadStuff& stuff, const sim::Model& model) {
  suture::ThreadDescription d;
  d.stuff = stuff;
  d.length = s.length;
  d.tick = core::kTick;
  d.gravity = model.gravity;
  const int hands = int(model.hands.size());
  d.holds = interactions::kFirstHandSlot + hands;
  d.obstacles = hands * interactions::kRodSlots + interactions::kNeedlePieces;
  d.passages = interactions::kMostPassages;
  d.skins = int(std::ceil(s.length / (2 * stuff.diameter))) + 2;
  return d;
}

void lay_thread(const SutureSetting& s, SutureModel& m) {
  const Vec3d swage = m.place + rotate(m.turn, m.needle.place(m.needle.length));
  const Vec3d away = m.has_needle() ? -rotate(m.turn, m.needle.along(m.needle.length)) : Vec3d{1, 0, 0};
  if (m.has_needle()) m.path.push_back(swage);
  for (const Vec3d& p : s.line) m.path.push_back(p);
  if (s.line.empty()) m.path.push_back((m.has_needle() ? swage : s.place) + 0.01 * away);
  if (m.path.size() < 2) m.path.insert(m.path.begin(), s.place);
}

}  // namespace

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
  s.at = o.at();
  s.text = o.value();
  if (s.size.empty() && s.needle.empty()) o.fault(o.at(), "expected a size, a needle or both, got neither");
  if (!s.size.empty() && !suture::find_thread(s.size, s.make))
    o.fault("size",
            fmt::format("expected a thread that there is ({}), got \"{} {}\"", sizes_and_makes(), s.size, s.make));
  if (!s.needle.empty() && !suture::needle_kind(s.needle))
    o.fault("needle",
            fmt::format("expected a needle that there is ({}), got \"{}\"", suture::names_of_needles(), s.needle));
  if (s.needle.empty() && !s.hand.empty()) o.fault("held_by", "expected it of a needle, got a thread alone");
  if (!s.needle.empty() && o.names("at_mm") == o.names("held_by"))
    o.fault(o.at(), "expected at_mm of a needle that lies or held_by of one that is held, got " +
                        std::string(o.names("at_mm") ? "both" : "neither"));
  if (s.needle.empty() && s.line.size() < 2) o.fault(o.at(), "expected line_mm of a thread without a needle, got none");
  if (!(length(cross(s.axis, s.points)) > 1e-6)) o.fault("axis", "expected two directions that differ, got one");
  return s;
}

void SutureScene::compile(const std::vector<Setting>& settings, sim::Model& model, std::vector<core::Fault>&) {
  for (const SutureSetting& s : settings) {
    SutureModel m;
    m.name = s.name;
    m.look = s.look;
    m.needle_look = s.needle_look;
    if (const suture::NeedleKind* kind = suture::needle_kind(s.needle)) m.needle = suture::make_needle(*kind);
    m.place = s.place;
    m.turn = turned(s.axis, s.points);
    m.grips = interactions::grips_of(m.needle);
    interactions::part_of<interactions::Suture>(model.objects).list.push_back(std::move(m));
  }
}

void SutureScene::finish(const Description& d, sim::Model& model, std::vector<core::Fault>& faults) {
  const std::vector<SutureSetting>& settings = settings_of(SutureScene{}, d.objects);
  SutureModels& all = interactions::part_of<interactions::Suture>(model.objects);
  if (settings.empty() || all.list.size() != settings.size()) return;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const SutureSetting& s = settings[i];
    SutureModel& m = all.list[i];
    if (!s.hand.empty()) {
      const int hand = model.hand_index(s.hand);
      if (hand < 0 || !model.placed(std::size_t(hand)).can().grip) {
        faults.push_back(
            {s.at, fmt::format("expected the trocar of a hand whose instrument grips, got \"{}\"", s.hand)});
        continue;
      }
      put_in_jaws(s, model, std::size_t(hand), m);
      model.start.tools[std::size_t(hand)].handle = 1;
    }
    const suture::ThreadKind* kind = suture::find_thread(s.size, s.make);
    if (!kind) continue;
    m.thread = suture::build(thread_of(s, kind->stuff, model));
    lay_thread(s, m);
  }
  std::vector<const tissue::Skin*> walls;
  for (const sim::WallModel& w : model.walls) walls.push_back(&w.skin);
  all.walls = interactions::make_wall_grid(walls, kWallReach);
  for (const sim::SolidModel& b : model.solids) all.organs.push_back(stitch_of(d, b.tissue));
  for (const sim::CuttableOrgan& b : model.cuttables) all.organs.push_back(stitch_of(d, b.tissue));
  for (const sim::StrandAnatomy& b : model.strands) all.strands.push_back(stitch_of(d, b.tissue));
  for (const sim::MembraneBody& b : model.membranes) all.membranes.push_back(stitch_of(d, b.tissue));
}

}  // namespace trocar::scene
