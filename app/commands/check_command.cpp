// trocar check: what a scene, organ, instrument, tissue table or exercise compiles to, what flows in a file of vessels,
// what a mesh of tetrahedra holds, or every fault that they have.
#include <algorithm>
#include <chrono>

#include <fmt/format.h>
#include <malloc.h>

#include <trocar/attempt/lesson.hpp>
#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/json.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/json/json.hpp>

#include "commands/check_mesh.hpp"
#include "commands/check_vessels.hpp"
#include "commands/command.hpp"
#include "commands/number_options.hpp"

namespace trocar::app {

namespace fs = std::filesystem;

namespace {

std::size_t bytes_in_use() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

Json describe(const scene::BodyReport& b) {
  Json out{
      {"name", b.name}, {"kind", b.kind}, {"nodes", b.nodes}, {b.kind == "wall" ? "triangles" : "springs", b.springs}};
  if (b.mass > 0) out["mass_g"] = b.mass * 1000;
  if (b.volume > 0) out["volume_ml"] = b.volume * 1e6;
  if (b.pressure != 0) out["pressure_Pa"] = b.pressure;
  if (b.substeps == 0) return out;  // implicit, or does not move
  out["substeps"] = b.substeps;
  out["dt_ms"] = 1000 * sim::kTick / b.substeps;
  out["dt_limit_ms"] = 1000 * b.dt_limit;
  out["dt_margin"] = b.dt_limit * b.substeps / sim::kTick;
  if (b.dt_printed > 0) out["dt_limit_as_printed_ms"] = 1000 * b.dt_printed;
  if (b.dt_printed_summed > 0) out["dt_limit_as_printed_summed_ms"] = 1000 * b.dt_printed_summed;
  out["residual_mN"] = 1000 * b.residual;
  out["prestrain"] = b.prestrain;
  return out;
}

/// Mean cost of a tick of the scene at rest, on this machine and one thread.
double resting_tick(const sim::Model& model, sim::State& state, sim::Work& work) {
  constexpr int kWarm = 50, kTimed = 200;
  for (int i = 0; i < kWarm; ++i) sim::step(model, model.start, state, work);
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < kTimed; ++i) sim::step(model, model.start, state, work);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / kTimed;
}

/// What one body takes by itself: memory of its Model, State and Work, and a tick at rest on this machine.
struct Cost {
  std::size_t bytes = 0;
  double seconds = 0;
};
template <class BodyModel, class Advance>
Cost cost_of(const BodyModel& model, Advance&& advance) {
  constexpr int kWarm = 20, kTimed = 60;
  const std::size_t before = bytes_in_use();
  const BodyModel copy = model;
  auto state = rest_state(copy);
  auto work = make_work(copy);
  Cost cost{bytes_in_use() - before, 0};
  for (int i = 0; i < kWarm; ++i) advance(copy, state, work);
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < kTimed; ++i) advance(copy, state, work);
  cost.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / kTimed;
  return cost;
}

/// Of a body of the scene; contacts and loads come on top. Zero for walls, which neither move nor are copied.
Cost cost_of(const sim::Model& model, const std::string& body) {
  const auto unloaded = [](const auto& m, auto& s, auto& w) { advance(m, {}, {}, s, w); };
  if (const int organ = model.organ_index(body); organ >= 0) {
    const std::size_t i = std::size_t(organ), solids = model.solids.size();
    return i < solids ? cost_of(model.solids[i].network, unloaded)
                      : cost_of(model.cuttables[i - solids].body, unloaded);
  }
  if (const int i = model.strand_index(body); i >= 0)
    return cost_of(model.strand_bodies[std::size_t(i)].model,
                   [](const auto& m, auto& s, auto& w) { advance(m, {}, {}, {}, {}, s, w); });
  if (const int i = model.membrane_index(body); i >= 0)
    return cost_of(model.membranes[std::size_t(i)].sheet,
                   [](const auto& m, auto& s, auto& w) { advance(m, {}, {}, {}, s, w); });
  return {};
}

/// How far an organ's farthest node is from where it was drawn [m].
double off_drawn(const sim::Model& model, const sim::State& state, int organ) {
  const std::size_t i = std::size_t(organ), solids = model.solids.size();
  const std::vector<Vec3d>& rest =
      i < solids ? model.solids[i].network.rest : model.cuttables[i - solids].body.drawn.rest;
  const int nodes = i < solids ? model.solids[i].network.nodes : model.cuttables[i - solids].body.own_nodes;
  const tissue::NodeView now = nodes_of(model, state, organ);
  double off = 0;
  for (int n = 0; n < nodes; ++n) off = std::max(off, length(now.position(n) - rest[std::size_t(n)]));
  return off;
}

constexpr std::uint64_t kStandTicks = 1000;  // a shape that its springs do not hold falls over within these
constexpr double kStands = 5e-4;             // [m] off after them: it does not

/// The State after a second of a scene in which nobody breathes and nothing contracts.
sim::State stood(sim::Model model) {
  model.motion = {};
  sim::State state = sim::initial_state(model);
  sim::Work work = sim::make_work(model);
  while (state.tick < kStandTicks) sim::step(model, model.start, state, work);
  return state;
}

Json describe(const sim::MotionModel& motion, const sim::Model& model) {
  Json out = Json::object();
  for (const sim::PeristalsisModel& p : motion.peristalsis)
    out["peristalsis"].push_back({{"solid", model.solids[std::size_t(p.solid)].name},
                                  {"per_minute", 60 / p.wave.period},
                                  {"pairs", p.wave.pairs.size()}});
  if (motion.breathing.there())
    out["breathing"] = {{"per_minute", 60 / motion.breathing.period},
                        {"amplitude_mm", 1e3 * length(motion.breathing.way)}};
  return out;
}

/// What a scene compiles to. `only` names the bodies to list; empty: all.
Json describe_scene(const fs::path& path, const std::vector<std::string>& only) {
  scene::CompileReport report;
  const std::size_t before = bytes_in_use();
  const sim::Model model = scene::compile(scene::read_scene(path), &report);
  const std::size_t with_model = bytes_in_use();
  sim::State state = sim::initial_state(model);
  const std::size_t with_state = bytes_in_use();
  sim::Work work = sim::make_work(model);
  const std::size_t with_work = bytes_in_use();
  const double tick = resting_tick(model, state, work);
  if (model.motion.there()) state = stood(model);
  while (state.tick < kStandTicks) sim::step(model, model.start, state, work);
  Json out{{"scene", path.string()},
           {"model_hash", core::hex(model.hash)},
           {"free_nodes", model.free_nodes()},
           {"memory_kb",
            {{"model", (with_model - before) / 1024},
             {"state", (with_state - with_model) / 1024},
             {"work", (with_work - with_state) / 1024}}},
           {"tick_at_rest_us", tick * 1e6},
           {"bodies", Json::array()}};
  if (model.motion.there() && only.empty()) out["motion"] = describe(model.motion, model);
  for (const scene::BodyReport& b : report.bodies) {
    if (!only.empty() && std::find(only.begin(), only.end(), b.name) == only.end()) continue;
    out["bodies"].push_back(describe(b));
    if (const Cost cost = cost_of(model, b.name); cost.bytes > 0) {
      out["bodies"].back()["memory_kb"] = cost.bytes / 1024;
      out["bodies"].back()["tick_us"] = cost.seconds * 1e6;
    }
    if (const int m = model.membrane_index(b.name); m >= 0 && b.kind == "pouch") {
      const tissue::EnclosureState& inside = state.membranes[std::size_t(m)].enclosure;
      out["bodies"].back()["after_1s"] = {{"volume_ml", inside.volume * 1e6}, {"pressure_Pa", inside.pressure}};
    }
    if (const int organ = model.organ_index(b.name); organ >= 0)
      out["bodies"].back()["off_after_1s_mm"] = 1e3 * off_drawn(model, state, organ);
  }
  return out;
}

std::vector<std::string> names_under(const scene::JsonValue& root, const char* key) {
  std::vector<std::string> names;
  const scene::JsonMember* list = root.find(key);
  if (!list) return names;
  for (const scene::JsonValue& item : list->value.items)
    if (const scene::JsonMember* name = item.find("name")) names.push_back(name->value.text);
  return names;
}

/// Does the scene's list `organs` name this file?
bool includes(const fs::path& scene_file, const fs::path& organ) {
  std::vector<core::Fault> faults;
  const scene::JsonDocument document = scene::load_json(scene_file, faults);
  const scene::JsonMember* organs = document.root.find("organs");
  if (!organs) return false;
  std::error_code error;
  return std::any_of(organs->value.items.begin(), organs->value.items.end(), [&](const scene::JsonValue& item) {
    return item.kind == scene::JsonValue::Kind::string &&
           fs::equivalent(scene_file.parent_path() / item.text, organ, error);
  });
}

/// An organ hangs on others, so its numbers are those in the first scene that uses it.
Json describe_organ(const fs::path& path, const scene::JsonValue& root) {
  std::vector<std::string> names;
  for (const char* key : {"solids", "strands", "walls", "membranes", "pouches"})
    for (std::string& name : names_under(root, key)) names.push_back(std::move(name));
  for (const scene::SceneEntry& s : scene::list_scenes(attempt::scenes_folder()))
    if (includes(s.path, path)) return describe_scene(s.path, names);
  return {{"note", "no scene uses this organ, so there is nothing to compile it in"}};
}

Json describe_tissues(const fs::path& path) {
  Json rows = Json::array();
  for (const scene::Tissue& t : scene::read_tissues(path)) {
    Json row{{"name", t.name}, {"figures", Json::object()}};
    for (std::size_t i = 0; i < scene::kTissueFigures.size(); ++i) {
      const scene::TissueFigure& f = scene::kTissueFigures[i];
      row["figures"][f.key] = {{"value", t.*f.value}, {"source", t.source_of[i].empty() ? t.source : t.source_of[i]}};
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

void print_tissues(const Json& tissues) {
  for (const Json& t : tissues) {
    fmt::print("  {}\n", t["name"].get<std::string>());
    for (const auto& [key, figure] : t["figures"].items())
      fmt::print("    {:15} {:>9}  {}\n", key, figure["value"].get<double>(), figure["source"].get<std::string>());
  }
}

/// @param unit  of meshes, in metres
/// @throws core::BadInput with all faults of the file
Json check_one(const fs::path& path, double unit) {
  if (is_mesh_file(path)) return describe_mesh(path, unit);
  std::vector<core::Fault> faults;
  const scene::JsonDocument document = scene::load_json(path, faults);
  if (!faults.empty()) throw core::BadInput(scene::check_file(path));  // with what else is wrong beside the JSON
  Json out{{"file", path.string()}};
  const auto has = [&](const char* key) { return document.root.find(key) != nullptr; };
  if (attempt::is_exercise(path)) {
    const training::Exercise exercise = training::read_exercise(path);
    out["kind"] = "exercise";
    out.update(describe_scene(exercise.scene, {}));
    attempt::load_lesson(path.string())->monitor();  // does the scene have what the exercise needs?
    return out;
  }
  faults = scene::check_file(path);
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  if (scene::kind_of_file(path) == scene::FileKind::vessels) return describe_vessels(path);
  if (has("organs") || has("scope")) {
    out["kind"] = "scene";
    out.update(describe_scene(path, {}));
  } else if (has("solids") || has("strands") || has("walls") || has("membranes") || has("pouches")) {
    out["kind"] = "organ";
    out.update(describe_organ(path, document.root));
  } else if (has("kind")) {
    out["kind"] = "instrument";
  } else {
    out["kind"] = "tissues";
    out["tissues"] = describe_tissues(path);
  }
  return out;
}

void print_motion(const Json& motion) {
  if (motion.contains("peristalsis"))
    for (const Json& p : motion["peristalsis"])
      fmt::print("  {}: {:g} waves a minute, {} pairs of points of its wall\n", p["solid"].get<std::string>(),
                 p["per_minute"].get<double>(), p["pairs"].get<std::size_t>());
  if (motion.contains("breathing"))
    fmt::print("  {:g} breaths a minute of {:g} mm\n", motion["breathing"]["per_minute"].get<double>(),
               motion["breathing"]["amplitude_mm"].get<double>());
}

void print_for_people(const Json& r) {
  const bool to_mend = r.contains("repairs") && !r["repairs"].empty();
  fmt::print("{}: {}, {}\n", r["file"].get<std::string>(), r["kind"].get<std::string>(), to_mend ? "to mend" : "good");
  if (r.contains("mesh")) print_mesh(r);
  if (r.contains("vessels")) print_vessels(r);
  if (r.contains("tissues")) print_tissues(r["tissues"]);
  if (r.contains("note")) fmt::print("  {}\n", r["note"].get<std::string>());
  if (!r.contains("bodies")) return;
  fmt::print("  {:31} {:8} {:>6} {:>7} {:>9} {:>13} {:>6} {:>18} {:>8} {:>8} {:>6}\n", "body", "kind", "nodes",
             "springs", "sub-steps", "dt limit [ms]", "margin", "(4b): one k, all k", "mass [g]", "mem [kB]", "us");
  for (const Json& b : r["bodies"]) {
    const auto number = [&b](const char* key, const char* format) {
      return b.contains(key) ? fmt::format(fmt::runtime(format), b[key].get<double>()) : std::string("-");
    };
    const std::string printed =
        b.contains("dt_limit_as_printed_ms")
            ? number("dt_limit_as_printed_ms", "{:.3f}") + ", " + number("dt_limit_as_printed_summed_ms", "{:.3f}")
            : "-";
    fmt::print("  {:31} {:8} {:>6} {:>7} {:>9} {:>13} {:>6} {:>18} {:>8} {:>8} {:>6}\n", b["name"].get<std::string>(),
               b["kind"].get<std::string>(), number("nodes", "{:.0f}"),
               number(b.contains("springs") ? "springs" : "triangles", "{:.0f}"), number("substeps", "{:.0f}"),
               number("dt_limit_ms", "{:.4f}"), number("dt_margin", "{:.2f}"), printed, number("mass_g", "{:.1f}"),
               number("memory_kb", "{:.0f}"), number("tick_us", "{:.1f}"));
  }
  for (const Json& b : r["bodies"])
    if (b.contains("after_1s"))
      fmt::print("  {} holds {:.1f} ml at {:.0f} Pa; after a second at rest {:.1f} ml at {:.0f} Pa\n",
                 b["name"].get<std::string>(), b.value("volume_ml", 0.0), b.value("pressure_Pa", 0.0),
                 b["after_1s"]["volume_ml"].get<double>(), b["after_1s"]["pressure_Pa"].get<double>());
  for (const Json& b : r["bodies"])
    if (b.value("off_after_1s_mm", 0.0) > 1e3 * kStands)
      fmt::print(
          "  {} does not hold its drawn shape: {:.1f} mm off after a second at rest (a stiffer tissue, larger cells "
          "or more anchors may)\n",
          b["name"].get<std::string>(), b["off_after_1s_mm"].get<double>());
  if (r.contains("motion")) print_motion(r["motion"]);
  fmt::print("  (4b) is the paper's limit for comparison, with a node's stiffest spring and with all of its springs\n");
  const Json& m = r["memory_kb"];
  fmt::print("  {} free nodes; memory {} kB model, {} kB state, {} kB work; a tick at rest takes {:.0f} us here\n",
             r["free_nodes"].get<int>(), m["model"].get<std::size_t>(), m["state"].get<std::size_t>(),
             m["work"].get<std::size_t>(), r["tick_at_rest_us"].get<double>());
}

int check(const std::vector<std::string>& files, double unit, bool json) {
  Json results = Json::array();
  std::vector<core::Fault> faults;
  for (const std::string& file : files) {
    try {
      results.push_back(check_one(file, unit));
      if (!json) print_for_people(results.back());
    } catch (const core::BadInput& bad) {  // go on: all faults of all files in one pass
      faults.insert(faults.end(), bad.faults().begin(), bad.faults().end());
    }
  }
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  if (json) print({{"files", results}});
  return core::kDone;
}

}  // namespace

void add_check(CLI::App& program, Chosen& chosen) {
  auto files = std::make_shared<std::vector<std::string>>();
  auto unit_mm = std::make_shared<double>(1.0);
  CLI::App* c = add_command(program, chosen, "check", "Say what files compile to or hold, or all their faults",
                            "trocar check scenes/organs/uterus.json scenes/gynaecology/sterilisation.json liver.msh");
  c->add_option("files", *files,
                "scenes, organs, instruments, tissue tables, vessels, exercises; meshes of tetrahedra (.msh, .vtk)")
      ->required();
  c->add_option("--unit-mm", *unit_mm, "the unit of meshes' coordinates in mm")
      ->check(number_between(1e-6, 1e6, "mm"))
      ->capture_default_str();
  c->callback([=, &chosen] { chosen.run = [=, &chosen] { return check(*files, *unit_mm * 1e-3, chosen.json); }; });
}

}  // namespace trocar::app
