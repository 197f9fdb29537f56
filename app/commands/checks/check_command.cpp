// trocar check: what a scene, organ, instrument, tissue table or exercise compiles to, what flows in a file of vessels,
// what takes an exercise's rules, how an operating room stands and whether a programme can be done, what a mesh, a
// drawing or a scan of another program holds, or every fault that they have.
#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include <trocar/attempt/lesson.hpp>
#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/foreign/foreign_file.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/text.hpp>
#include <trocar/kinematics/chains/excluded_range.hpp>
#include <trocar/kinematics/loops/mobility.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/json/json.hpp>
#include <trocar/scene/mechanisms/mechanism_file.hpp>

#include "commands/checks/check_exercise.hpp"
#include "commands/checks/check_inputs.hpp"
#include "commands/checks/check_mesh.hpp"
#include "commands/checks/check_room.hpp"
#include "commands/checks/check_scan.hpp"
#include "commands/checks/check_scene.hpp"
#include "commands/checks/check_vessels.hpp"
#include "commands/checks/check_warnings.hpp"
#include "commands/command.hpp"
#include "commands/number_options.hpp"

namespace trocar::app {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> names_under(const scene::JsonValue& root, const char* key) {
  std::vector<std::string> names;
  const scene::JsonMember* list = root.find(key);
  if (!list) return names;
  for (const scene::JsonValue& item : list->value.items)
    if (const scene::JsonMember* name = item.find("name")) names.push_back(name->value.text);
  return names;
}

/// An organ hangs on others, so its numbers are those in the first scene that uses it.
Json describe_organ(const fs::path& path, const scene::JsonValue& root) {
  std::vector<std::string> names;
  for (const char* key : {"solids", "strands", "walls", "membranes", "pouches"})
    for (std::string& name : names_under(root, key)) names.push_back(std::move(name));
  for (const scene::SceneEntry& s : scene::list_scenes(attempt::scenes_folder()))
    if (lists_file(s.path, "organs", path)) return describe_scene(s.path, names);
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

Json describe_mechanism(const fs::path& path) {
  const kinematics::Mechanism m = kinematics::build(scene::read_mechanism(path));
  std::vector<double> u = m.start_u();
  const kinematics::Mobility freedoms = kinematics::mobility(m, u);
  Json out{{"file", path.string()},         {"kind", "mechanism"},
           {"links", m.links.size() - 1},   {"coordinates", m.q_count()},
           {"free", m.u_count()},           {"conditions", m.rows},
           {"mobility", freedoms.mobility}, {"mobility_words", words(freedoms)}};
  std::vector<core::Fault> warnings = scene::mechanism_warnings(path);
  for (const kinematics::ExcludedRange& range : kinematics::excluded_ranges(m))
    warnings.push_back({{path.generic_string(), 0, 0}, words(m, range)});
  add_warnings(out, warnings);
  if (freedoms.poses == 0) out["verdict"] = "its loops do not close where it begins";
  return out;
}

/// What the user says of files of other programs.
struct Said {
  std::optional<double> unit;  ///< of meshes [m]; none: what the file says or its size suggests
  volumes::ReadOptions scan;   ///< which series and time point
};

/// @throws core::BadInput with all faults of the file
Json check_one(const fs::path& path, const Said& said) {
  if (is_mesh_file(path)) return describe_mesh(path, said.unit);
  if (is_scan_file(path)) return describe_scan(path, said.scan);
  if (scene::is_robot_file(path)) return describe_mechanism(path);
  if (const std::string foreign = core::foreign_file_at(path, core::Wanted::json); !foreign.empty())
    throw core::BadInput({{{path.generic_string(), 1, 1}, tr("expected JSON, got {}", foreign)}});
  std::vector<core::Fault> faults;
  const scene::JsonDocument document = scene::load_json(path, faults);
  if (path.extension() == ".json" && document.root.find("links")) return describe_mechanism(path);
  const bool lost = document.root.kind == scene::JsonValue::Kind::broken;  // what follows from that is no fault
  if (!faults.empty()) throw core::BadInput(lost ? faults : scene::check_file(path));
  Json out{{"file", path.string()}};
  const auto has = [&](const char* key) { return document.root.find(key) != nullptr; };
  if (is_programme_file(document.root)) return describe_programme(path);
  if (is_room_file(document.root)) return describe_room(path);
  if (is_rules_file(document.root)) return describe_rules(path);
  if (is_inputs_file(document.root)) return describe_inputs(path, document.root);
  if (attempt::is_exercise(document.root)) {
    out["kind"] = "exercise";
    out.update(describe_exercise(path));
    return out;
  }
  faults = scene::check_file(path);
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  if (scene::kind_of_file(path) == scene::FileKind::vessels) return describe_vessels(path);
  if (scene::kind_of_file(path) == scene::FileKind::look) {
    out["kind"] = "look";
  } else if (has("organs") || has("scope") || has("like")) {
    out["kind"] = "scene";
    out.update(describe_scene(path, {}));
  } else if (scene::kind_of_file(path) == scene::FileKind::organ) {
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

void print_checks(const Json& r) {
  fmt::print("{}: {}, {}\n", r["file"].get<std::string>(), r["kind"].get<std::string>(),
             r.value("verdict", std::string("good")));
  if (r["kind"] == "exercise") return print_exercise(r);
  if (r["kind"] == "rules") return print_rules(r);
  if (r.contains("leads")) print_inputs(r);
  if (r.contains("wrong")) print_room(r);
  if (r.contains("mesh") || r.contains("surface_parts")) print_mesh(r);
  if (r["kind"] == "scan") print_scan(r);
  if (r.contains("vessels")) print_vessels(r);
  if (r.contains("tissues")) print_tissues(r["tissues"]);
  print_warnings(r);
  if (r.contains("mobility_words")) fmt::print("  {}\n", r["mobility_words"].get<std::string>());
  if (r.contains("note")) fmt::print("  {}\n", r["note"].get<std::string>());
  if (!r.contains("bodies")) return;
  print_scene(r);
}

int check(const std::vector<std::string>& files, const Said& said, bool json) {
  Json results = Json::array();
  std::vector<core::Fault> faults;
  bool still = true;
  for (const std::string& file : files) {
    try {
      results.push_back(check_one(file, said));
      const Json& last = results.back();
      still =
          still && last.value("verdict", std::string()) != kSinks && (!last.contains("wrong") || last["wrong"].empty());
      if (!json) print_checks(results.back());
    } catch (const core::BadInput& bad) {  // go on: all faults of all files in one pass
      faults.insert(faults.end(), bad.faults().begin(), bad.faults().end());
    }
  }
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  if (json) print({{"files", results}});
  return still ? core::kDone : core::kGoalNotReached;
}

}  // namespace

void add_check(CLI::App& program, Chosen& chosen) {
  auto files = std::make_shared<std::vector<std::string>>();
  auto unit_mm = std::make_shared<std::optional<double>>();
  auto scan = std::make_shared<volumes::ReadOptions>();
  CLI::App* c = add_command(program, chosen, "check", tr("Check files: their content, or all their faults"),
                            "trocar check scenes/organs/uterus.json scenes/gynaecology/sterilisation.json liver.msh");
  c->add_option("files", *files,
                tr("files of scenes, organs, instruments, tissues, vessels, mechanisms, exercises, shared rules, "
                   "devices, operating rooms and programmes; meshes (.msh, .vtk, .obj, .stl, .ply, .glb, .gltf), "
                   "drawings (.step, .iges) and scans (folders of DICOM files, NIfTI, NRRD, MetaImage) of other "
                   "programs"))
      ->required();
  c->add_option("--unit-mm", *unit_mm,
                tr("unit of a mesh's coordinates [mm]; default: what the file says or its size "
                   "suggests"))
      ->check(number_between(1e-6, 1e6, "mm"));
  c->add_option("--series", scan->series, tr("of several in a scan, 1, 2, ... as they are listed"))
      ->transform(whole_number(1, 10000));
  c->add_option("--frame", scan->frame, tr("of several time points or phases of a scan, from 0"))
      ->transform(whole_number(0, 100000));
  c->callback([=, &chosen] {
    chosen.run = [=, &chosen] {
      return check(*files, {*unit_mm ? std::optional(**unit_mm * 1e-3) : std::nullopt, *scan}, chosen.json);
    };
  });
}

}  // namespace trocar::app
