// One pass over a scene and its files: what reader.cpp begins; reader_tets has the files of meshes, reader_names what
// needs all of them; what a kind of object is, is in its table (keys.hpp). Private to the folder.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <trocar/geometry/surface_files/unit_guess.hpp>
#include <trocar/scene/description/variant.hpp>
#include <trocar/scene/files/keys.hpp>
#include <trocar/scene/files/library.hpp>
#include <trocar/scene/files/reader.hpp>

namespace trocar::scene {

inline constexpr int kMaxFiles = 256;          ///< of one scene
inline constexpr int kMaxSolidNodes = 60'000;  ///< ten of today's organs: a tick of more is far from real time
inline constexpr int kMaxSolidCells = 100'000;

/// Whether an organ may have this extent [m], for files of meshes whose unit the scene does not say. Where not, a unit
/// that the file itself says is a warning, and a millimetre that nobody said is a fault that names the key unit_mm.
/// @param unit  that was taken [m]  @return false after a fault
bool is_organ_sized(const JsonObject& o, const geometry::Extent& extent, double unit, bool file_says,
                    std::vector<std::string>& warnings);

/// Documents live here: objects point into them.
class Reading {
 public:
  explicit Reading(std::vector<core::Fault>& faults, const MemoryFiles* memory = nullptr)
      : m_faults(faults), m_memory(memory) {}

  Description description;

  void scene_file(const std::filesystem::path& path);
  void organ_file(const std::filesystem::path& path) { file(path, organ_file_keys()); }
  void tissue_file(const std::filesystem::path& path) { file(path, tissue_file_keys()); }
  void instrument_file(const std::filesystem::path& path);

  /// Reads the looks that are there; every look that something names must be one of them.
  void looks(const std::filesystem::path& first);
  /// Every other name that something refers to must be known by now.
  void resolve();
  /// What needs several things to be known.
  void check_together();

  // What rows call.

  /// The items of these keys: files and objects.
  void tissues(const JsonObject& o, const std::filesystem::path& folder);
  void organs(const JsonObject& o, const std::filesystem::path& folder);
  void instruments(const JsonObject& o, const std::filesystem::path& folder);
  void vessels(const JsonObject& o, const std::filesystem::path& folder);
  /// One of a variation's, and what it brings.
  void variant(const JsonObject& o, const std::filesystem::path& folder, VariationSetting& variation);
  void variant_bodies(const JsonObject& o, const std::filesystem::path& folder, VariationSetting::Variant& variant);
  /// Fills a solid from the file that `o` names; `source` has the other keys of it.
  void mesh_of(const JsonObject& o, TetSource source, const std::filesystem::path& folder, Solid& s);
  void voxels_of(const JsonObject& o, TetSource source, const std::filesystem::path& folder, Solid& s);
  /// The closed surface from the file that `o` names; nothing, and a fault, where there is none.
  std::optional<SurfaceSource> surface_of(const JsonObject& o, SurfaceSource source,
                                          const std::filesystem::path& folder);
  /// The mechanism that o names by a key, if it does: by its name in a library, or by its file.
  void mechanism_of(const JsonObject& o, const char* key, const std::filesystem::path& folder,
                    NamedMechanism& mechanism);
  /// To be checked when everything is known: a sheet or membrane that ends on a strand at `to`; a tool's reach.
  void ends_on(const std::string& strand, double to, core::Location at) {
    m_sheet_ends.push_back({strand, to, std::move(at)});
  }
  void reaches(const Placement& tool) { m_tools.push_back(tool); }

 private:
  /// Reads an object of a file in `folder`.
  using Read = std::function<void(const JsonObject& o, const std::filesystem::path& folder)>;

  /// Reads it into the description.
  Read into(const Table<Description>& table) {
    return [this, &table](const JsonObject& o, const std::filesystem::path& folder) {
      Context context{folder, this, m_references};
      table.read(o, description, context);
    };
  }
  /// Reads one more of them.
  template <class T>
  Read one_more(const Table<T>& table, std::vector<T>& things) {
    return [this, &table, &things](const JsonObject& o, const std::filesystem::path& folder) {
      Context context{folder, this, m_references};
      things.push_back(table.made(o, context));
    };
  }
  void file(const std::filesystem::path& path, const Table<Description>& table) {
    include(path, {path.generic_string(), 0, 0}, table, into(table));
  }
  /// Reads the file at `path`, named at `from`.
  void include(const std::filesystem::path& path, const core::Location& from, const Shape& shape, const Read& read);
  /// A scene's file, and below it those that it is like: each stands in for what the ones above do not say.
  struct Layer {
    JsonObject o;
    std::filesystem::path folder;
  };
  void scene(const JsonObject& o, const std::filesystem::path& folder, std::vector<Layer>& layers);
  void scene_of(const std::vector<Layer>& layers);
  /// Reads the file that `o` names at `at`.
  void include_named(const JsonObject& o, const core::Location& at, const JsonValue& name,
                     const std::filesystem::path& folder, const Shape& shape, const Read& read);
  /// The items of an `includes` key: the files that are named by `read`, objects that stand there by `read_here`.
  void includes(const JsonObject& o, const char* key, const std::filesystem::path& folder, const Shape& shape,
                const Read& read, const Read& read_here);
  /// Where a name leads: from the folder of the file that has it, else into the installed folder `scenes`.
  std::filesystem::path place_of(const std::filesystem::path& folder, const std::filesystem::path& named) const;
  /// The bytes of a file that o names by a key; none, and a fault, where it cannot be read.
  std::optional<std::string> bytes_of(const JsonObject& o, const std::filesystem::path& folder,
                                      const char* key = "file");
  /// The file of the mechanism that a key calls by its name; none, and a fault, where no library has it.
  std::optional<std::filesystem::path> called(const JsonObject& o, const char* key);
  /// Those of `path`, which that key's value leads to.
  std::optional<std::string> bytes_at(const JsonObject& o, const std::filesystem::path& path, const char* key);

  /// Those of a file that another one in `folder` names. @throws core::BadInput
  std::string bytes_beside(const std::filesystem::path& folder, const std::string& name);

  /// Too many bodies to compare all with all; told once.
  bool crowded();
  std::vector<std::string> names(Reference::To to) const;
  void resolve(const std::vector<Reference>& references);
  /// The scene with each of its variants, once it is sound without.
  void check_variants();
  void check_names();
  void check_vessel_names();
  void check_tool(const Placement& tool);
  void check_wave(const WaveSetting& wave);
  void check_mark(const MarkSetting& mark);
  void check_finding(const VariationSetting::Finding& finding);

  /// Where a sheet or membrane ends on a strand that may not be known yet.
  struct SheetEnd {
    std::string strand;
    double to;
    core::Location at;
  };
  void check_sheet(const SheetEnd& sheet);

  std::vector<core::Fault>& m_faults;
  const MemoryFiles* m_memory;       ///< where not null, files are looked up there
  std::optional<Library> m_library;  ///< what files on the disk may name
  std::vector<Reference> m_references;
  std::vector<std::vector<Reference>> m_of_variants;  ///< (variants) what only the scene with that one must know
  std::vector<std::pair<std::filesystem::path, std::string>> m_open;  ///< files being read: canonical path, shown name
  std::vector<Placement> m_tools;  ///< tools and scope whose reach is checked when ports and instruments are known
  std::vector<SheetEnd> m_sheet_ends;
  int m_files = 0;
  bool m_crowded = false;
};

}  // namespace trocar::scene
