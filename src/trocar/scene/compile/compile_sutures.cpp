#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/compile/compile_hands.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/suture/thread/paths.hpp>

namespace trocar::scene {
namespace {

using interactions::StitchTissue;
using interactions::SutureModel;
using interactions::SutureModels;

constexpr int kCornersCut = 5;         // times over
constexpr double kLeaves = 0.006;      // [m] that a thread continues as the wire ends
constexpr double kNoneDoes = 1e9;      // [N] that no needle presses with
constexpr double kWallReach = 0.0025;  // [m] from which on needles and threads know of walls

StitchTissue stitch_of(const Description& d, const std::string& tissue) {
  StitchTissue t;
  for (const Tissue& row : d.tissues) {
    if (row.name != tissue) continue;
    t.puncture = row.puncture > 0 ? row.puncture : kNoneDoes;
    if (row.stitch_damage > 0) t.damage = row.stitch_damage;
  }
  return t;
}

/// Tension of a loop that cuts through a strand of it [N].
double strangles(const Description& d, const std::string& tissue) {
  constexpr double kStrangles = 8;
  for (const Tissue& row : d.tissues)
    if (row.name == tissue && row.strangle > 0) return row.strangle;
  return kStrangles;
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
  const Quatd stands = needle_turn(axis, along);
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
  // as the wire has it at first: a thread that is bent back where it is swaged on stays so
  if (m.has_needle()) m.path = {swage, swage + 0.5 * kLeaves * away, swage + kLeaves * away};
  for (const Vec3d& p : s.line) m.path.push_back(p);
  if (s.line.empty()) m.path.push_back((m.has_needle() ? swage : s.place) + 0.01 * away);
  if (m.path.size() < 2) m.path.insert(m.path.begin(), s.place);
  // a corner would spring back, and the thread would be thrown about in the first ticks
  m.path = suture::smoothed(std::move(m.path), kCornersCut);
}

}  // namespace

bool has_slings(const std::vector<SutureSetting>& settings) {
  return std::any_of(settings.begin(), settings.end(), [](const SutureSetting& s) { return s.sling.there; });
}

void compile_sutures(const Description& d, sim::Model& model, std::vector<core::Fault>& faults) {
  const std::vector<SutureSetting>& settings = settings_of(SutureScene{}, d.objects);
  SutureModels& all = interactions::part_of<interactions::Suture>(model);
  if (settings.empty() || all.list.size() != settings.size()) return;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const SutureSetting& s = settings[i];
    SutureModel& m = all.list[i];
    if (!s.hand.empty()) {
      const int hand = model.hand_index(s.hand);
      if (hand < 0 || !model.placed(std::size_t(hand)).can().grip) {
        faults.push_back({s.at, tr("expected the trocar of a hand whose instrument grips, got \"{}\"", s.hand)});
        continue;
      }
      put_in_jaws(s, model, std::size_t(hand), m);
      model.start.tools[std::size_t(hand)].handle = 1;
    }
    const suture::ThreadKind* kind = suture::find_thread(s.size, s.make);
    if (!kind) continue;
    suture::ThreadDescription thread = thread_of(s, kind->stuff, model);
    const std::int32_t own_hold = thread.holds;
    if (s.sling.there) thread.holds += interactions::kSlingHolds, thread.shaped = true;
    m.thread = suture::build(thread);
    if (s.sling.there)
      compile_sling(s.sling, own_hold, m);
    else
      lay_thread(s, m);
  }
  expect_endoloop(settings, model, faults);
  if (has_slings(settings))
    for (const sim::StrandAnatomy& b : model.strands) all.strangles.push_back(strangles(d, b.tissue));
  std::vector<const tissue::Skin*> walls;
  for (const sim::WallModel& w : model.walls) walls.push_back(&w.skin);
  all.walls = interactions::make_wall_grid(walls, kWallReach);
  const auto stitch = [&](auto r) { return stitch_of(d, model_of(model, r).tissue); };
  visit_organs(model, [&](auto r) { all.organs.push_back(stitch(r)); });
  visit_strands(model, [&](auto r) { all.strands.push_back(stitch(r)); });
  visit_membranes(model, [&](auto r) { all.membranes.push_back(stitch(r)); });
}

}  // namespace trocar::scene
