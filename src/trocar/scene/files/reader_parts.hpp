// One pass over a scene and its files: what reader.cpp begins and the files beside it go on with, one for each kind of
// file (reader_scene, reader_organ with reader_strand, reader_instrument), and reader_names for what needs all of them.
// Private to the folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <trocar/numerics/portable.hpp>
#include <trocar/scene/files/library.hpp>
#include <trocar/scene/files/reader.hpp>

namespace trocar::scene {

inline constexpr int kMaxFiles = 256;             ///< of one scene
inline constexpr double kMaxTriangles = 500'000;  ///< of a body's surface
inline constexpr double kMaxStrandNodes = 5'000;  ///< also columns of a membrane

// Dividing (not multiplying by 0.001) makes "1.5" mm the number nearest to 0.0015 m.
inline double from_mm(double v) { return v / 1000; }
inline Vec3d from_mm(Vec3d v) { return v / 1000.0; }
inline double from_deg(double v) { return v * portable::pi / 180; }
inline std::vector<Vec3d> from_mm(std::vector<Vec3d> points) {
  for (Vec3d& p : points) p = from_mm(p);
  return points;
}

/// Length of the Catmull-Rom curve through the points: within a few per cent of any smooth curve through them.
double curve_length(const std::vector<Vec3d>& points);
/// Is s beyond the strand's end? Smooth curves through the same points differ by a few per cent.
inline bool beyond(double s, double whole) { return whole > 0 && s > 1.05 * whole + 0.001; }

/// A name that must belong to something by the time all files are read.
struct Reference {
  enum class To { tissue, solid, strand, solid_or_strand, carrier, vessel, port, instrument, drawn };
  To to;
  std::string name;
  core::Location at;
};

/// Documents live here: objects point into them.
class Reading {
 public:
  explicit Reading(std::vector<core::Fault>& faults, const MemoryFiles* memory = nullptr)
      : m_faults(faults), m_memory(memory) {}

  Description description;

  void scene_file(const std::filesystem::path& path) { file(path, scene_shape(), &Reading::scene); }
  void organ_file(const std::filesystem::path& path) { file(path, organ_shape(), &Reading::organ); }
  void instrument_file(const std::filesystem::path& path) { file(path, instrument_shape(), &Reading::instrument); }
  void tissue_file(const std::filesystem::path& path) { file(path, tissue_shape(), &Reading::tissue_table); }

  /// Every name that something refers to must be known by now.
  void resolve();
  /// What needs several things to be known.
  void check_together();

 private:
  /// Reads an object of a file in `folder`.
  using Read = void (Reading::*)(const JsonObject& o, const std::filesystem::path& folder);

  void file(const std::filesystem::path& path, const Shape& shape, Read read) {
    include(path, {path.generic_string(), 0, 0}, shape, read);
  }
  /// Reads the file at `path`, named at `from`.
  void include(const std::filesystem::path& path, const core::Location& from, const Shape& shape, Read read);
  /// The items of an `includes` key: the files that are named by `read`, objects that stand there by `read_here`.
  void includes(const JsonObject& o, const char* key, const std::filesystem::path& folder, const Shape& shape,
                Read read, Read read_here);

  void scene(const JsonObject& o, const std::filesystem::path& folder);
  void tissue_table(const JsonObject& o, const std::filesystem::path& folder);
  void tissue(const JsonObject& o, const std::filesystem::path& folder);
  void vessels(const JsonObject& o, const std::filesystem::path& folder);
  void fluids(const JsonObject& o);
  void bleeder(const JsonObject& o);
  void energy(const JsonObject& o);
  void wave(const JsonObject& o);
  void breathing(const JsonObject& o);
  void detail(const JsonObject& o);
  void port(const JsonObject& o);
  Placement placement(const JsonObject& o);
  void scope(const JsonObject& o);

  void organs(const JsonObject& o, const std::filesystem::path& folder);
  void organ(const JsonObject& o, const std::filesystem::path& folder);
  void solid(const JsonObject& o, const std::filesystem::path& folder);
  void mesh_of(const JsonObject& o, const std::filesystem::path& folder, Solid& s);
  void voxels_of(const JsonObject& o, const std::filesystem::path& folder, Solid& s);
  /// The bytes of a file that is not JSON, named by o's "file"; none, and a fault, where it cannot be read.
  std::optional<std::string> bytes_of(const JsonObject& o, const std::filesystem::path& folder);
  void wall(const JsonObject& o);

  void strand(const JsonObject& o);
  StrandEnd strand_end(const JsonObject& strand, const char* key);
  void sheet(const JsonObject& o);
  void membrane(const JsonObject& o);
  void pouch(const JsonObject& o);
  std::vector<Section> sections(const JsonObject& o);

  void instrument(const JsonObject& o, const std::filesystem::path& folder);

  void refer(Reference::To to, const JsonObject& o, const char* key);
  /// Too many bodies to compare all with all; told once.
  bool crowded();
  std::vector<std::string> names(Reference::To to) const;
  void check_names();
  void check_vessel_names();
  void check_tool(const Placement& tool);
  void check_wave(const WaveSetting& wave);

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
  std::vector<std::pair<std::filesystem::path, std::string>> m_open;  ///< files being read: canonical path, shown name
  std::vector<Placement> m_tools;  ///< tools and scope whose reach is checked when ports and instruments are known
  std::vector<SheetEnd> m_sheet_ends;
  int m_files = 0;
  bool m_crowded = false;
};

}  // namespace trocar::scene
