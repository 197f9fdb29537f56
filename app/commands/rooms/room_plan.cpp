// trocar room ... plan: where to put ports.
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/reports/room_page.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>

#include "commands/command.hpp"
#include "commands/rooms/room_answers.hpp"
#include "rooms/room_camera.hpp"

namespace trocar::app {

using namespace studies;

namespace {

double to_degrees(double angle) { return angle * 180 / portable::pi; }
Json to_mm(Vec3d v) { return Json{1e3 * v.x, 1e3 * v.y, 1e3 * v.z}; }

/// The scene whose ports the room has, or none.
std::unique_ptr<const sim::Model> scene_of(const scene::Room& room) {
  if (room.scene.empty()) return nullptr;
  const std::filesystem::path path = std::filesystem::path(room.file).parent_path() / room.scene;
  return std::make_unique<const sim::Model>(scene::compile(scene::read_scene(path)));
}

geometry::TriMesh mesh_of(const tissue::Skin& skin) {
  geometry::TriMesh mesh;
  for (const auto& p : skin.rest) mesh.positions.push_back(vec_cast<double>(p));
  for (const auto& t : skin.triangles) mesh.triangles.push_back({int(t[0]), int(t[1]), int(t[2])});
  return mesh;
}

/// Organs and closed pouches of the scene.
std::vector<InTheWay> organs_of(const sim::Model& model) {
  std::vector<InTheWay> all;
  for (int i = 0; i < model.organs(); ++i) all.push_back({model.organ_name(i), mesh_of(model.skin(i))});
  for (const sim::MembraneBody& m : model.membranes)
    if (m.sheet.closed()) all.push_back({m.name, mesh_of(m.skin)});
  return all;
}

/// A box of the room's targets, or the bounds of an organ of its scene. What is worked at is in nobody's way.
void find_target(const scene::Room& room, const std::string& name, PortPlanOptions& o) {
  std::vector<std::string> known;
  const auto aim_at = [&o](const std::string& target) {
    std::erase_if(o.organs, [&](const InTheWay& organ) { return organ.name == target; });
  };
  for (const scene::RoomTarget& t : room.targets) {
    known.push_back(t.name);
    if (t.name != name && !name.empty()) continue;
    o.low = t.low, o.high = t.high;
    return aim_at(t.name);
  }
  for (const InTheWay& organ : o.organs) {
    known.push_back(organ.name);
    if (organ.name != name) continue;
    o.low = {1e9, 1e9, 1e9}, o.high = {-1e9, -1e9, -1e9};
    for (const Vec3d& p : organ.mesh.positions)
      for (int k = 0; k < 3; ++k) o.low[k] = std::min(o.low[k], p[k]), o.high[k] = std::max(o.high[k], p[k]);
    return aim_at(name);
  }
  throw core::BadInput({{{"--target", 0, 0}, scene::unknown_name("target", name, known)}});
}

std::string ways_text(const WaysIn& ways) {
  return tr("{:.0f} % of the ways through {} (up to {:.0f} mm)", 100 * ways.blocked, ways.first, 1e3 * ways.longest);
}

}  // namespace

int answer_plan(const RoomModel& model, const RoomWords& words, bool json) {
  PortPlanOptions o;
  if (const auto scene = scene_of(model.room())) o.organs = organs_of(*scene);
  find_target(model.room(), words.target, o);
  o.spacing = 1e-3 * words.grid_mm;
  o.sets = words.sets;
  o.scope = words.with;
  for (const scene::RoomInstrument& i : model.room().instruments)
    if (o.scope.empty() && i.camera) o.scope = i.port;
  if (o.scope.empty() && !model.room().ports.empty()) o.scope = model.room().ports.front().name;
  PortPlan plan;
  try {
    plan = plan_ports(model, o);
  } catch (const std::invalid_argument& bad) {
    throw core::BadInput({{{model.room().file, 0, 0}, bad.what()}});
  }
  Json sets = Json::array(), grid = Json::array();
  const auto port = [&](int k) {
    const PortCandidate& c = plan.candidates[std::size_t(k)];
    return Json{{"at_mm", to_mm(c.place)},
                {"reach", c.reach},
                {"lean_deg", to_degrees(c.lean)},
                {"elevation_deg", to_degrees(c.elevation)},
                {"azimuth_deg", to_degrees(c.azimuth)},
                {"depth_mm", 1e3 * c.depth},
                {"lever", c.lever},
                {"blocked", c.ways.blocked},
                {"blocked_by", c.ways.first}};
  };
  for (const PortPair& p : plan.pairs) {
    Json set{{"score", p.score},
             {"rank", p.rank},
             {"left", port(p.left)},
             {"right", port(p.right)},
             {"manipulation_deg", to_degrees(p.manipulation)},
             {"handles_clear_mm", 1e3 * p.clearance},
             {"patient_clear_mm", 1e3 * p.patient_clearance}};
    if (p.with_arms)
      set["arms_reach"] = p.arms_reach, set["arms_clear_mm"] = 1e3 * p.arms_clearance,
      set["bases_turned_deg"] = {to_degrees(p.turned[0]), to_degrees(p.turned[1])};
    sets.push_back(std::move(set));
  }
  for (const PortCandidate& c : plan.candidates)
    grid.push_back({{"at_mm", to_mm(c.place)}, {"alone", c.alone}, {"best", c.best}});
  Json out{{"name", model.room().name},
           {"kind", "plan"},
           {"scope", o.scope},
           {"target_mm", to_mm(plan.target)},
           {"sight", {{"blocked", plan.sight.blocked}, {"blocked_by", plan.sight.first}}},
           {"candidates", plan.candidates.size()},
           {"pairs", plan.looked_at},
           {"sets", sets},
           {"grid", grid}};
  const std::string folder = !words.out.empty() ? words.out : words.shots;
  std::vector<reports::RoomPicture> shown;
  if (!folder.empty()) {
    attempt::make_folder(folder);
    const RoomPose pose = model.start();
    view::Scenery all = scenery_of(model, pose), bare = all;
    double most = 1e-9;
    for (const PortCandidate& c : plan.candidates) most = std::max(most, c.best);
    for (const PortCandidate& c : plan.candidates) bare.heat.push_back({c.place.x, c.place.y, c.best / most});
    bare.heat_spacing = o.spacing;
    bare.arms.clear(), bare.people.clear(), bare.instruments.clear(), bare.monitors.clear();
    if (!plan.pairs.empty())
      for (const int k : {plan.pairs[0].left, plan.pairs[0].right})
        bare.chosen.push_back(plan.candidates[std::size_t(k)].place);
    std::vector<view::Scenery::Port> scope_only;
    for (const view::Scenery::Port& p : bare.ports)
      if (length(p.place - plan.scope) < 1e-9) scope_only.push_back(p);
    bare.ports = scope_only;
    if (!plan.pairs.empty())  // where shafts are
      for (const int k : {plan.pairs[0].left, plan.pairs[0].right}) {
        const Vec3d place = plan.candidates[std::size_t(k)].place;
        bare.instruments.push_back({plan.target,
                                    plan.target + o.length * ((place - plan.target) / length(place - plan.target)),
                                    0.0025, false});
      }
    RoomCamera camera(bare, pictures::parse_size(words.size));
    for (const auto& [file, what, orbit] :
         {std::tuple("ports.png", "Heat: the score of the best pair with a port there; rings: the best pair",
                     view::UprightOrbit{{0, 0.04, 0}, 0, 1.25, 0.95}),
          std::tuple("ports-side.png", "The best pair's instruments at the target",
                     view::UprightOrbit{{0, 0.04, 0.05}, -0.7, 0.5, 1.2})}) {
      camera.take(bare, orbit, folder + "/" + file);
      shown.push_back({file, what});
    }
    out["pictures"] = Json::array();
    for (const reports::RoomPicture& p : shown) out["pictures"].push_back(folder + "/" + p.file);
  }
  if (!words.out.empty()) out["report"] = reports::write_room_page(words.out, reports::plan_html(model, plan, shown));
  const bool good = !plan.pairs.empty() && plan.pairs[0].rank > 0;
  if (json) {
    print(out);
    return good ? core::kDone : core::kGoalNotReached;
  }
  fmt::print("{}", tr("{}: ports about the endoscope's ({}), target ({:.0f}, {:.0f}, {:.0f}) mm; {} places, {} pairs\n",
                      model.room().name, o.scope, 1e3 * plan.target.x, 1e3 * plan.target.y, 1e3 * plan.target.z,
                      plan.candidates.size(), plan.looked_at));
  fmt::print("  {:>5} {:>5} {:>22} {:>22} {:>7} {:>13} {:>11} {:>11} {:>9}{}\n", "rank", "score", "left mm", "right mm",
             "manip.", "azimuths", "elevations", "levers", "clear mm",
             model.arms().size() >= 2 ? "  arms: reach, clear mm" : "");
  for (const PortPair& p : plan.pairs) {
    const PortCandidate &l = plan.candidates[std::size_t(p.left)], &r = plan.candidates[std::size_t(p.right)];
    fmt::print(
        "  {:5.3f} {:5.3f} ({:6.0f},{:6.0f},{:6.0f}) ({:6.0f},{:6.0f},{:6.0f}) {:5.0f} deg {:5.0f},{:5.0f} deg "
        "{:4.0f},{:4.0f} "
        "deg {:5.2f},{:5.2f} {:9.0f}{}\n",
        p.rank, p.score, 1e3 * l.place.x, 1e3 * l.place.y, 1e3 * l.place.z, 1e3 * r.place.x, 1e3 * r.place.y,
        1e3 * r.place.z, to_degrees(p.manipulation), to_degrees(l.azimuth), to_degrees(r.azimuth),
        to_degrees(l.elevation), to_degrees(r.elevation), l.lever, r.lever,
        1e3 * std::min(p.clearance, p.patient_clearance),
        p.with_arms ? tr("  {:.2f}, {:.0f}; bases turned {:.0f}, {:.0f} deg", p.arms_reach, 1e3 * p.arms_clearance,
                         to_degrees(p.turned[0]), to_degrees(p.turned[1]))
                    : "");
    for (const auto& [side, c] : {std::pair{"left", &l}, {"right", &r}})
      if (c->ways.blocked > 0) fmt::print("        {}: {}\n", side, ways_text(c->ways));
  }
  if (plan.sight.blocked > 0) fmt::print("  endoscope: {}\n", ways_text(plan.sight));
  if (!good)
    fmt::print("{}", tr("  no pair of places does: none reaches the target, clear of each other and the patient\n"));
  if (out.contains("report")) fmt::print("  {}\n", out["report"].get<std::string>());
  return good ? core::kDone : core::kGoalNotReached;
}

}  // namespace trocar::app
