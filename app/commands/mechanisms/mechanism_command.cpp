// trocar mechanism: what a mechanism does: a pose of it, where it can get to, and studies of its design.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/decimal.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/text.hpp>
#include <trocar/kinematics/inverse/workspace.hpp>
#include <trocar/kinematics/loops/mobility.hpp>
#include <trocar/scene/files/library.hpp>
#include <trocar/scene/mechanisms/mechanism_file.hpp>

#include "commands/command.hpp"
#include "commands/mechanisms/coordinate_units.hpp"
#include "commands/mechanisms/design_studies.hpp"
#include "commands/mechanisms/motion_study.hpp"
#include "commands/number_options.hpp"
#include "mechanisms/design_window.hpp"

namespace trocar::app {
namespace {

using namespace kinematics;

struct MechanismWords {
  std::string file, what = "pose", frame, log;
  std::vector<std::string> sets, drives;
  int samples = 100'000;
  double cell_mm = 0;
  MotionChoice motion;
  DesignOptions design;
};

std::vector<Target> targets_of(const Mechanism& m, const MechanismWords& words) {
  std::vector<Target> targets;
  std::vector<std::string> free_names, drive_names;
  for (const int q : m.independent) free_names.push_back(m.coordinates[std::size_t(q)]);
  for (const Drive& d : m.drives) drive_names.push_back(d.name);
  const auto add = [&](const std::string& word, int independent, double value) {
    for (const Target& t : targets)
      if (t.independent == independent) refuse_words(word, "expected every coordinate once, got one again");
    targets.push_back({independent, value});
  };
  for (const std::string& word : words.sets) {
    const auto [name, value] = assignment(word);
    const int u = m.independent_of(name);
    if (u < 0) refuse_words(word, scene::unknown_name("free coordinate", name, free_names));
    const bool angle = m.measures[std::size_t(m.independent[std::size_t(u)])] == Measure::angle;
    add(word, u, angle ? value * portable::pi / 180 : 1e-3 * value);
  }
  for (const std::string& word : words.drives) {
    const auto [name, value] = assignment(word);
    const int d = m.drive(name);
    if (d < 0) refuse_words(word, scene::unknown_name("drive", name, drive_names));
    add(word, m.drives[std::size_t(d)].independent, m.drives[std::size_t(d)].value(value));
  }
  return targets;
}

Json place_json(const Frame& f) {
  Json turn = Json::array();
  for (const auto& row : f.r.m) turn.push_back({row[0], row[1], row[2]});
  return {{"at_mm", {1e3 * f.p.x, 1e3 * f.p.y, 1e3 * f.p.z}}, {"turn", turn}};
}

Json describe_pose(const Mechanism& m, const Pose& pose) {
  Json out{
      {"coordinates", Json::array()}, {"drives", Json::array()}, {"frames", Json::array()}, {"links", Json::array()}};
  for (int q = 0; q < m.q_count(); ++q) {
    const auto i = std::size_t(q);
    Json c{{"name", m.coordinates[i]},
           {"value", in_file(m, q, pose.q[i])},
           {"unit", unit_of(m, q)},
           {"free", std::find(m.independent.begin(), m.independent.end(), q) != m.independent.end()}};
    if (std::isfinite(m.low[i]) && std::fabs(m.low[i]) < 1e5) c["low"] = in_file(m, q, m.low[i]);
    if (std::isfinite(m.high[i]) && std::fabs(m.high[i]) < 1e5) c["high"] = in_file(m, q, m.high[i]);
    out["coordinates"].push_back(std::move(c));
  }
  for (const Drive& d : m.drives) {
    const int q = m.independent[std::size_t(d.independent)];
    const double way = d.at_1 - d.at_0;
    out["drives"].push_back({{"name", d.name},
                             {"coordinate", m.coordinates[std::size_t(q)]},
                             {"handle", way != 0 ? (pose.q[std::size_t(q)] - d.at_0) / way : 0}});
  }
  for (std::size_t k = 0; k < m.frames.size(); ++k) {
    Json f = place_json(place(m.frames[k], pose));
    f["name"] = m.frame_names[k];
    out["frames"].push_back(std::move(f));
  }
  for (std::size_t k = 1; k < m.links.size(); ++k) {
    Json f = place_json(pose.frames[std::size_t(m.link_body[k])]);
    f["name"] = m.links[k];
    out["links"].push_back(std::move(f));
  }
  return out;
}

void print_pose(const Json& r) {
  fmt::print("{}: {}\n  {}\n", r["name"].get<std::string>(), r["mobility_words"].get<std::string>(),
             r["words"].get<std::string>());
  fmt::print("  {:28} {:>12} {:>22}\n", "coordinate", "value", "limits");
  for (const Json& c : r["coordinates"]) {
    const auto bound = [&](const char* key) {
      return c.contains(key) ? fmt::format("{:.4g}", c[key].get<double>()) : "-";
    };
    fmt::print("  {:28} {:>12.5f} {:>10} to {:>8} {}{}\n", c["name"].get<std::string>(), c["value"].get<double>(),
               bound("low"), bound("high"), c["unit"].get<std::string>(), c["free"].get<bool>() ? "" : ", follows");
  }
  for (const Json& d : r["drives"])
    fmt::print("  drive {}: {:.4f}\n", d["name"].get<std::string>(), d["handle"].get<double>());
  for (const char* kind : {"frames", "links"}) {
    fmt::print("  {:28} {:>38} {:>27}\n", kind, "place mm", "z axis");
    for (const Json& f : r[kind])
      fmt::print("  {:28} {:>12.5f} {:>12.5f} {:>12.5f} {:>9.5f} {:>8.5f} {:>8.5f}\n", f["name"].get<std::string>(),
                 f["at_mm"][0].get<double>(), f["at_mm"][1].get<double>(), f["at_mm"][2].get<double>(),
                 f["turn"][0][2].get<double>(), f["turn"][1][2].get<double>(), f["turn"][2][2].get<double>());
  }
}

/// Where a mechanism stands with what was chosen.
struct Standing {
  std::vector<double> u;
  LoopReport report;
  std::string said;
  double reached = 1;
  bool there() const { return report.closed() && reached >= 1; }
};

Standing stand(const Mechanism& m, const MechanismWords& given, LoopWork& work) {
  const std::vector<Target> targets = targets_of(m, given);
  Standing s{m.start_u(), {}, {}, 1};
  hold_drives(m, work);
  s.report = close(m, s.u, work);
  s.said = words(m, s.report);
  if (!s.report.closed() || targets.empty()) return s;
  std::vector<int> held;
  for (const Target& t : targets) held.push_back(t.independent);
  hold(work, held);
  const MoveReport moved = move(m, s.u, targets, branch_at(m, s.u, work), work);
  s.report = moved.last;
  s.reached = moved.reached;
  s.said = words(m, moved);
  return s;
}

int show_released(const Mechanism& m, const MechanismWords& given, bool json) {
  LoopWork work(m);
  Standing s = stand(m, given, work);
  if (s.there()) return show_motion(m, std::move(s.u), given.motion, json);
  fmt::print(stderr, "{}: {}\n", m.name, s.said);
  if (json) print({{"name", m.name}, {"kind", "motion"}, {"good", false}, {"words", s.said}});
  return core::kGoalNotReached;
}

int show_pose(const Mechanism& m, const MechanismWords& given, bool json) {
  std::vector<double> near = m.start_u();
  const Mobility freedoms = mobility(m, near);
  LoopWork work(m);
  const Standing s = stand(m, given, work);
  const LoopReport& report = s.report;
  const bool good = s.there() && report.limit < 0;
  Json out{{"name", m.name},
           {"kind", "pose"},
           {"mobility", freedoms.mobility},
           {"mobility_words", words(freedoms)},
           {"closed", report.closed()},
           {"reached", s.reached},
           {"within_limits", report.limit < 0},
           {"gap_mm", 1e3 * report.metres},
           {"gap_deg", report.radians * 180 / portable::pi},
           {"rank", report.rank},
           {"conditions", report.conditions},
           {"smallest_pivot", report.pivot},
           {"words", s.said}};
  out.update(describe_pose(m, work.pose));
  if (json)
    print(out);
  else
    print_pose(out);
  return good ? core::kDone : core::kGoalNotReached;
}

int show_workspace(const Mechanism& m, const MechanismWords& given, bool json) {
  const int frame = m.frame(given.frame);
  if (frame < 0) refuse_words(given.frame, scene::unknown_name("frame", given.frame, m.frame_names));
  std::vector<double> u = m.start_u();
  LoopWork work(m);
  if (!m.drives.empty()) hold_drives(m, work);
  if (const LoopReport first = close(m, u, work); !first.closed()) {
    fmt::print(stderr, "{}: {}\n", m.name, words(m, first));
    if (json) print({{"name", m.name}, {"kind", "workspace"}, {"closed", false}, {"words", words(m, first)}});
    return core::kGoalNotReached;
  }
  WorkspaceOptions options;
  options.samples = given.samples;
  options.cell = 1e-3 * given.cell_mm;
  const Workspace w = workspace(m, m.frames[std::size_t(frame)], options);
  const auto mm = [](Vec3d v) { return Json{1e3 * v.x, 1e3 * v.y, 1e3 * v.z}; };
  const Json out{{"name", m.name},
                 {"kind", "workspace"},
                 {"frame", given.frame},
                 {"samples", w.samples},
                 {"closed", w.closed},
                 {"within_limits", w.within},
                 {"low_mm", mm(w.low)},
                 {"high_mm", mm(w.high)},
                 {"cell_mm", 1e3 * w.cell},
                 {"volume_mL", 1e6 * w.volume},
                 {"volume_of_half_mL", 1e6 * w.volume_of_half},
                 {"path_mm", 1e3 * w.path}};
  if (json) {
    print(out);
    return w.within > 0 ? core::kDone : core::kGoalNotReached;
  }
  fmt::print("{}", tr("{}: workspace of \"{}\"\n  {} poses, {} closed, {} of them within limits\n", m.name, given.frame,
                      w.samples, w.closed, w.within));
  constexpr const char* kAxes[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k) fmt::print("  {} {:>10.3f} to {:>10.3f} mm\n", kAxes[k], 1e3 * w.low[k], 1e3 * w.high[k]);
  if (w.path > 0)
    fmt::print("{}", tr("  the path is {:.3f} mm long\n", 1e3 * w.path));
  else
    fmt::print("{}", tr("  reachable volume {:.4g} mL (cells of {:.3g} mm; half of the poses: {:.4g} mL)\n",
                        1e6 * w.volume, 1e3 * w.cell, 1e6 * w.volume_of_half));
  return w.within > 0 ? core::kDone : core::kGoalNotReached;
}

int run_mechanism(MechanismWords given, bool json) {
  const std::filesystem::path file = mechanism_file(given.file);
  const MechanismDescription description = scene::read_mechanism(file);
  const Mechanism m = build(description);
  given.frame = frame_or_tip(m, given.frame);
  if (given.what == "design") {
    run_design_window({file, description, given.frame, 1e-6 * given.design.clearance_um, given.log});
    return core::kDone;
  }
  if (given.what == "pose") return show_pose(m, given, json);
  if (given.what == "workspace") return show_workspace(m, given, json);
  if (given.what == "motion") return show_released(m, given, json);
  if (!given.sets.empty()) refuse_words(given.sets[0], "expected --drive with a study, got --set");
  DesignOptions design = given.design;
  design.study.file = given.file;
  design.path = file;
  design.study.frame = given.frame;
  design.study.drives = given.drives;
  design.study.samples = given.samples;
  if (given.what == "tolerance") return show_tolerance(m, design, json);
  return given.what == "clearance" ? show_clearance(m, design, json) : show_optimised(m, design, json);
}

}  // namespace

void add_mechanism(CLI::App& program, Chosen& chosen) {
  auto given = std::make_shared<MechanismWords>();
  CLI::App* c =
      add_command(program, chosen, "mechanism", tr("Move a mechanism, and study its tolerances and clearance"),
                  "trocar mechanism grasper pose --drive handle=0.5\n"
                  "  trocar mechanism colliding_grasper tolerance --plus-minus-um 10 --report report");
  c->add_option("file", given->file,
                tr("a mechanism's file (.json, .urdf), or a name that `trocar list mechanisms` shows"))
      ->required();
  c->add_option("what", given->what,
                tr("pose, workspace, motion, tolerance, clearance or optimise; design opens a window"))
      ->check(CLI::IsMember({"pose", "workspace", "motion", "tolerance", "clearance", "optimise", "design"}))
      ->capture_default_str();
  c->add_option("--set", given->sets,
                tr("pose, motion: a free coordinate, as NAME=DEGREES or NAME=MM; the others follow"));
  c->add_option("--drive", given->drives, tr("an actuator, as NAME=0..1"));
  c->add_option("--frame", given->frame,
                tr("workspace, tolerance, optimise: the frame that is measured; default: tip, else the first"));
  c->add_option("--samples", given->samples,
                tr("workspace: number of poses within limits; tolerance: number of mechanisms"))
      ->transform(whole_number(100, 10'000'000))
      ->capture_default_str();
  c->add_option("--cell-mm", given->cell_mm,
                tr("workspace: edge of a cell [mm]; default: 1/40 of the workspace's size"))
      ->check(number_between(0.01, 1000, "mm"));
  const char* motion = tr("Motion under gravity and springs");
  c->add_option("--seconds", given->motion.seconds, tr("motion: duration [s]"))
      ->check(number_between(0.001, 100, "s"))
      ->capture_default_str()
      ->group(motion);
  c->add_option("--step-ms", given->motion.step_ms, tr("motion: time step [ms]"))
      ->check(number_between(0.01, 10, "ms"))
      ->capture_default_str()
      ->group(motion);
  c->add_option("--data", given->motion.data,
                tr("motion: write coordinates and energies of every step to this file (CSV)"))
      ->group(motion);
  c->add_option("--log", given->log, tr("design: write events of the window as JSON lines to this file"));
  add_design_options(*c, given->design);
  c->callback([=, &chosen] { chosen.run = [=, &chosen] { return run_mechanism(*given, chosen.json); }; });
}

}  // namespace trocar::app
