// The readers of scene, organ, instrument and tissue files, and what becomes of a scene that reads well: it is written
// and read again, and, where it is small, compiled and stepped.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/files/writer.hpp>
#include <trocar/sim/stages/step.hpp>

#include "../sim/small_scene.hpp"
#include "archive.hpp"
#include "targets.hpp"

namespace trocar::fuzz {
namespace {

/// Every fault says where and what.
void require_told(const std::vector<core::Fault>& faults) {
  for (const core::Fault& f : faults) {
    require(!f.message.empty(), "a fault says what was expected");
    require(!f.at.file.empty() && f.at.line >= 0 && f.at.column >= 0, "a fault says where it stands");
  }
}

bool read(const scene::MemoryFiles& files, scene::Description& description) {
  try {
    description = scene::read_scene(kMainFile, &files);
    return true;
  } catch (const core::BadInput& bad) {
    require(!bad.faults().empty(), "a refusal has a reason");
    require_told(bad.faults());
    return false;
  }
}

std::string disk_text(const std::filesystem::path& path) {
  std::stringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

constexpr const char* kScenes = TROCAR_SOURCE_DIR "/scenes/";

std::vector<Seed> files_of(const char* folder) {
  std::vector<Seed> seeds;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(kScenes) + folder))
    if (entry.path().extension() == ".json")
      seeds.push_back({entry.path().stem().string(), bytes_of(disk_text(entry.path()))});
  return seeds;
}

/// The shipped scene with all its files, the scene file's own text first.
Seed shipped_scene() {
  const std::filesystem::path scenes = kScenes;
  scene::MemoryFiles files{{kMainFile, disk_text(scenes / "gynaecology" / "scene.json")}};
  for (const char* folder : {"organs", "instruments", "mechanisms"})
    for (const auto& entry : std::filesystem::directory_iterator(scenes / folder))
      files["../" + (std::filesystem::path(folder) / entry.path().filename()).generic_string()] =
          disk_text(entry.path());
  files["../tissues.json"] = disk_text(scenes / "tissues.json");
  return {"shipped", bytes_of(packed(files))};
}

/// A scene with a needle that lies on its pad, and a thread beside it.
std::string with_sutures(const scene::Description& d) {
  std::string text = scene::write_scene(d);
  text.insert(text.rfind('}'), R"(,
  "sutures": [
    {"name": "stitch", "size": "3-0", "make": "PDS", "length_mm": 40, "needle": "half_17", "at_mm": [50, 0, 4],
     "axis": [0, 1, 0], "points": [1, 0, 0], "line_mm": [[55, 5, 4], [60, 20, 4]]},
    {"name": "tie", "size": "2-0", "make": "silk", "length_mm": 30, "line_mm": [[40, -5, 2], [60, -5, 2]]}
  ]
)");
  return text;
}

}  // namespace

void scene_files(Bytes bytes) {
  const scene::MemoryFiles files = unpacked(text_of(bytes));
  for (const auto& [name, text] : files) require_told(scene::check_file(name, &files));
  scene::Description first;
  if (!read(files, first)) return;
  const std::string written = scene::write_scene(first);
  scene::MemoryFiles copy{{kMainFile, written}};
  for (const auto& [name, text] : files)  // instruments call mechanisms by their names
    if (name.parent_path().filename() == "mechanisms") copy.emplace(name, text);
  scene::Description second;
  require(read(copy, second), "what was read can be written and read again");
  require(scene::write_scene(second) == written, "what was written reads as the same scene");
}

/// Vessels that were not read from a file cannot be written; those of files have seeds of their own.
scene::Description small_scene() {
  scene::Description d = small::description();
  d.vessels.clear();
  return d;
}

std::vector<Seed> scene_seeds() {
  std::vector<Seed> seeds{shipped_scene(), {"small", bytes_of(scene::write_scene(small_scene()))}};
  // alone, without the files they name: for their own keys
  for (const char* scene : {"box_suture", "box_loop"})
    seeds.push_back({scene, bytes_of(disk_text(std::string(kScenes) + scene + "/scene.json"))});
  for (const char* folder : {"organs", "instruments", "."})
    for (Seed& seed : files_of(folder)) seeds.push_back(std::move(seed));
  return seeds;
}

/// The pad's place and tissue, with another shape.
scene::Solid shaped(const char* name, scene::ClosedShape shape) {
  scene::Solid s = small::pad();
  s.name = name;
  s.sections.clear();
  s.shape = std::move(shape);
  return s;
}

scene::Solid tube_solid() {
  scene::TubeShape tube;
  tube.line = {{0.036, 0, -0.008}, {0.050, 0.002, -0.008}, {0.064, 0, -0.008}};
  tube.stations = {{0, 0.006, 0}, {0.028, 0.005, 0}};
  scene::ClosedShape shape;
  shape.tube = tube;
  return shaped("pipe", shape);
}

scene::Solid revolved_solid() {
  scene::RevolvedShape revolved;
  revolved.profile = {{0, -0.012}, {0.007, -0.006}, {0.008, 0}, {0.005, 0.008}, {0, 0.012}};
  revolved.from = {0.050, 0, -0.012};
  scene::ClosedShape shape;
  shape.revolved = revolved;
  return shaped("top", shape);
}

void scene_compiled(Bytes bytes) {
  scene::Description description;
  if (!read(unpacked(text_of(bytes)), description) || !quick_to_compile(description)) return;
  sim::Model model;
  try {
    model = scene::compile(description);
  } catch (const core::BadInput& bad) {
    return require_told(bad.faults());
  }
  require_stepped(model);
}

std::vector<Seed> compile_seeds() {
  const scene::Description whole = small_scene();
  scene::Description empty;
  empty.name = "part";
  empty.tissues = whole.tissues;
  empty.ports = whole.ports;
  empty.instruments = whole.instruments;
  empty.placements = whole.placements;
  empty.scope_placement = whole.scope_placement;
  scene::Description cord = empty, pad = empty;
  cord.strands = {small::cord()};
  pad.solids = {small::pad()};
  pad.walls = whole.walls;
  scene::Description shapes = empty;
  shapes.solids = {tube_solid(), revolved_solid()};
  return {{"small", bytes_of(scene::write_scene(whole))},
          {"cord", bytes_of(scene::write_scene(cord))},
          {"pad", bytes_of(scene::write_scene(pad))},
          {"sutures", bytes_of(with_sutures(pad))},
          {"shapes", bytes_of(scene::write_scene(shapes))}};
}

}  // namespace trocar::fuzz
