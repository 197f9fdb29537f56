#include "commands/rooms/room_answers.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/reports/room_page.hpp>

#include "commands/command.hpp"
#include "rooms/room_camera.hpp"

namespace trocar::app {

using namespace studies;

namespace {

constexpr std::size_t kToldFaults = 12;
constexpr double kShownGap = 0.06;  // clearance that pictures show [m]

Json mm(Vec3d v) { return Json{1e3 * v.x, 1e3 * v.y, 1e3 * v.z}; }
double degrees(double angle) { return angle * 180 / portable::pi; }

Json near_json(const std::vector<Near>& all) {
  Json out = Json::array();
  for (const Near& n : all)
    out.push_back({{"first", n.first}, {"second", n.second}, {"mm", 1e3 * n.distance}, {"at_mm", mm(n.where())}});
  return out;
}

}  // namespace

Json take_pictures(const RoomModel& model, const RoomPose& pose, const RoomWords& words, const std::string& folder) {
  Json files = Json::array();
  view::Scenery scenery = scenery_of(model, pose);
  show_clearance(scenery, model, pose, kShownGap);
  RoomCamera camera(scenery, pictures::parse_size(words.size));
  attempt::make_folder(folder);
  for (const RoomView& v : room_views()) {
    const std::string file = fmt::format("{}/{}.png", folder, v.name);
    camera.take(scenery, v.orbit, file);
    files.push_back(file);
  }
  return files;
}

int answer_pose(const RoomModel& model, const RoomWords& words, bool json) {
  RoomPose pose = model.start();
  if (words.head_down_deg < 1e8) pose.tilt.head_down = words.head_down_deg * portable::pi / 180;
  if (words.left_down_deg < 1e8) pose.tilt.left_down = words.left_down_deg * portable::pi / 180;
  const std::vector<Near> near = model.nearest(pose);
  bool good = model.can_tilt(pose.tilt);
  Json arms = Json::array(), people = Json::array();
  for (std::size_t a = 0; a < model.arms().size(); ++a) {
    const ArmModel& arm = model.arms()[a];
    const double gap = port_gap(model.shaft(pose, int(a)), arm.port);
    const double beyond = model.beyond_set_up(int(a));
    good = good && gap < 1e-4 && beyond <= 0;
    arms.push_back({{"name", arm.described->name},
                    {"port", arm.described->port},
                    {"tip_mm", mm(model.tip(pose, int(a)).p)},
                    {"beside_port_mm", 1e3 * gap},
                    {"beyond_set_up_mm", 1e3 * std::max(0.0, beyond)}});
  }
  for (std::size_t k = 0; k < model.room().staff.size(); ++k) {
    const RoomModel::Body body = model.person(int(k), pose);
    const scene::RoomPerson& p = model.room().staff[k];
    good = good && body.beyond_reach <= 0;
    people.push_back(
        {{"name", p.name}, {"role", word_of(p.role)}, {"beyond_reach_mm", 1e3 * std::max(0.0, body.beyond_reach)}});
  }
  for (const Near& n : near) good = good && n.distance >= model.room().margin;
  const Vec3d g = model.gravity(pose.tilt);
  Json out{{"name", model.room().name},
           {"kind", "pose"},
           {"good", good},
           {"table",
            {{"head_down_deg", degrees(pose.tilt.head_down)},
             {"left_down_deg", degrees(pose.tilt.left_down)},
             {"can", model.can_tilt(pose.tilt)}}},
           {"gravity_m_s2", {g.x, g.y, g.z}},
           {"arms", arms},
           {"staff", people},
           {"clearance", near_json(near)}};
  if (!words.shots.empty()) out["pictures"] = take_pictures(model, pose, words, words.shots);
  if (json) {
    print(out);
    return good ? core::kDone : core::kGoalNotReached;
  }
  fmt::print(
      "{}",
      tr("{}: table {:.1f} deg head down, {:.1f} deg left side down; gravity in the patient ({:.2f}, {:.2f}, {:.2f}) "
         "m/s2\n",
         model.room().name, degrees(pose.tilt.head_down), degrees(pose.tilt.left_down), g.x, g.y, g.z));
  if (!model.can_tilt(pose.tilt)) fmt::print("{}", tr("  the table cannot tilt that far\n"));
  for (const Json& a : arms)
    fmt::print(
        "{}",
        tr("  arm {:12} port {:12} tip ({:7.1f}, {:7.1f}, {:7.1f}) mm, shaft {:.4f} mm beside its port{}\n",
           a["name"].get<std::string>(), a["port"].get<std::string>(), a["tip_mm"][0].get<double>(),
           a["tip_mm"][1].get<double>(), a["tip_mm"][2].get<double>(), a["beside_port_mm"].get<double>(),
           a["beyond_set_up_mm"].get<double>() > 0 ? tr("; its base is {:.0f} mm beyond the reach of its set-up joints",
                                                        a["beyond_set_up_mm"].get<double>())
                                                   : ""));
  for (const Json& p : people)
    fmt::print("  {:14} {:14} {}\n", p["name"].get<std::string>(), p["role"].get<std::string>(),
               p["beyond_reach_mm"].get<double>() > 0
                   ? tr("what they hold is {:.0f} mm beyond their reach", p["beyond_reach_mm"].get<double>())
                   : tr("reaches what they hold"));
  fmt::print("{}", tr("  clearance, nearest first (margin {:.1f} mm)\n", 1e3 * model.room().margin));
  for (const Near& n : near)
    if (n.distance < 0.3)
      fmt::print("    {:24} {:24} {:8.1f} mm{}\n", n.first, n.second, 1e3 * n.distance,
                 n.distance < model.room().margin ? "  too near" : "");
  return good ? core::kDone : core::kGoalNotReached;
}

int answer_motion(const RoomModel& model, const RoomMotion& motion, const std::string& label, const RoomWords& words,
                  bool json) {
  MotionOptions options;
  options.step = 1e-3 * words.step_ms;
  const MotionReport r = go_through(model, motion, options);
  Json faults = Json::array();
  for (const MotionFault& f : r.faults)
    faults.push_back({{"kind", word_of(f.kind)},
                      {"arm", f.arm >= 0 ? Json(model.arms()[std::size_t(f.arm)].described->name) : Json()},
                      {"with", f.with},
                      {"from_s", f.from},
                      {"to_s", f.to},
                      {"worst", f.worst},
                      {"worst_at_s", f.worst_at},
                      {"at_mm", mm(f.where)},
                      {"words", f.words}});
  Json out{{"name", model.room().name},
           {"kind", "motion"},
           {"led_by", label},
           {"good", r.good()},
           {"seconds", r.length},
           {"steps", r.count},
           {"port_gap_mm", 1e3 * r.port_gap},
           {"loop_gap_m", r.loop_gap},
           {"least_clearance_mm", 1e3 * r.least_clearance},
           {"least_clearance_at_s", r.least_at},
           {"least_clearance_of", r.least_pair},
           {"most_speed", r.most_speed},
           {"faults", faults}};
  const std::string folder = !words.out.empty() ? words.out : words.shots;
  std::vector<reports::RoomPicture> shown;
  if (!folder.empty() && !r.steps.empty()) {  // begin, nearest, each fault's worst
    attempt::make_folder(folder);
    std::vector<std::pair<double, std::string>> moments{{0, "the start"}, {r.least_at, "least clearance"}};
    for (const MotionFault& f : r.faults)
      if (moments.size() < 8) moments.emplace_back(f.worst_at, f.words);
    view::Scenery first = scenery_of(model, r.steps.front().pose);
    RoomCamera camera(first, pictures::parse_size(words.size));
    int number = 0;
    for (const auto& [at, what] : moments) {
      const MotionStep& step = step_at(r, at);
      view::Scenery scenery = scenery_of(model, step.pose);
      show_clearance(scenery, model, step.pose, kShownGap);
      const std::string file = fmt::format("moment-{:02}.png", ++number);
      camera.take(scenery, room_views()[1].orbit, folder + "/" + file);
      shown.push_back({file, fmt::format("{:.2f} s: {}", step.at, what)});
    }
    out["pictures"] = Json::array();
    for (const reports::RoomPicture& p : shown) out["pictures"].push_back(folder + "/" + p.file);
  }
  if (!words.out.empty())
    out["report"] = reports::write_room_page(words.out, reports::motion_html(model, r, label, shown));
  if (json) {
    print(out);
    return r.good() ? core::kDone : core::kGoalNotReached;
  }
  fmt::print("{}", tr("{}: {} of {:.2f} s in {} steps\n  shafts at most {:.2g} mm beside their ports, loops open by at "
                      "most {:.1e} m\n"
                      "  fastest {:.0f} % of what is allowed; least clearance {:.1f} mm at {:.2f} s, {}\n",
                      model.room().name, label, r.length, r.count, 1e3 * r.port_gap, r.loop_gap, 100 * r.most_speed,
                      1e3 * r.least_clearance, r.least_at, r.least_pair));
  for (std::size_t k = 0; k < std::min(kToldFaults, r.faults.size()); ++k) {
    const MotionFault& f = r.faults[k];
    fmt::print("  {:7.2f} to {:7.2f} s  {}{}: {}\n", f.from, f.to,
               f.arm >= 0 ? model.arms()[std::size_t(f.arm)].described->name + ", " : "", word_of(f.kind), f.words);
  }
  if (r.faults.size() > kToldFaults)
    fmt::print("{}", tr("  and {} more; --json or --out has them all\n", r.faults.size() - kToldFaults));
  if (r.good()) fmt::print("{}", tr("  can be done\n"));
  if (out.contains("report")) fmt::print("  {}\n", out["report"].get<std::string>());
  return r.good() ? core::kDone : core::kGoalNotReached;
}

}  // namespace trocar::app
