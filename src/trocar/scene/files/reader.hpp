// Reads a scene file and the tissue, organ and instrument files that it names into a Description. Every fault of every
// file is found in one pass and told as `path:line:col: expected ..., got ...`.
//
//   try {
//     const Description d = read_scene("scenes/gynaecology/scene.json");
//   } catch (const core::BadInput& bad) {
//     std::cerr << bad.what() << '\n';   // one fault a line
//   }
//
// Names are relative: in "tissues", "organs" and "instruments" a file is named by its path from the file that names it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <trocar/scene/description/description.hpp>
#include <trocar/scene/json/shape.hpp>

namespace trocar::scene {

/// Throws core::BadInput with all faults of the scene file and of all files it includes. With `memory`, here and below,
/// files are looked up there instead of on the disk.
Description read_scene(const std::filesystem::path& path, const MemoryFiles* memory = nullptr);

/// Reads a tissue table. Throws core::BadInput with every fault.
std::vector<Tissue> read_tissues(const std::filesystem::path& path);

enum class FileKind { scene, organ, instrument, tissue, vessels, exercise, look };
/// A file's kind: a look in a folder `looks`, else by the keys that only this kind has; a scene where nothing decides.
FileKind kind_of_file(const std::filesystem::path& path, const MemoryFiles* memory = nullptr);

/// Checks one file by its kind. What is not a scene is checked on its own: names that only a scene could resolve (a
/// tissue, another organ) are left open. A look is checked with all of its folder. Of an exercise only the JSON is
/// checked here; training knows its keys. Returns the faults; empty means good.
std::vector<core::Fault> check_file(const std::filesystem::path& path, const MemoryFiles* memory = nullptr);

struct SceneEntry {
  std::string name;   ///< what the command line calls it: "gynaecology" for scenes/gynaecology/scene.json
  std::string title;  ///< its "title", empty where the file cannot be read
  std::filesystem::path path;
};
/// The scenes of a folder: `NAME/scene.json` in it, sorted by name.
std::vector<SceneEntry> list_scenes(const std::filesystem::path& folder);

struct InstrumentEntry {
  std::string name, kind, title;
  std::filesystem::path path;
};
/// The readable instrument files (*.json) of a folder, sorted by name.
std::vector<InstrumentEntry> list_instruments(const std::filesystem::path& folder);

/// The tables of the file formats: the reader obeys them and scenes/schema/ is written from them.
const Shape& scene_shape();
const Shape& organ_shape();
const Shape& instrument_shape();
const Shape& tissue_shape();

}  // namespace trocar::scene
