// What the readers of surfaces share. Used by them and by surface_file.cpp only.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <trocar/geometry/formats/mesh_source.hpp>
#include <trocar/geometry/surface_files/surface_file.hpp>

namespace trocar::geometry {

SurfaceFile read_obj(MeshSource& in, const std::string& name);
SurfaceFile read_stl(MeshSource& in, const std::string& name);
SurfaceFile read_ply(MeshSource& in, const std::string& name);
SurfaceFile read_vtk_surface(MeshSource& in, const std::string& name);
SurfaceFile read_gltf(MeshSource& in, const std::string& name, const FilesBeside& beside);

/// Is this as long as the STL that its 81st to 84th byte announce?
bool has_stl_size(std::string_view bytes);
/// Does it begin with the word solid, in small or large letters?
bool begins_with_solid(MeshSource in);

/// A coordinate that text or binary values gave, checked; a fault at `at` and 0 where it is too large.
double checked_coordinate(MeshSource& in, std::size_t at, double value);
/// Three coordinates of `width` bytes where binary.
Vec3d read_surface_point(MeshSource& in, int width);

/// Takes what a line of the head says of axes and of the unit; of several the first that does.
void take_head(SurfaceFile& file, std::string_view line);

/// Throws where there are more things (vertices, triangles) than kMostSurfaceItems.
void bound_items(MeshSource& in, std::size_t count, const char* things);

/// Polygons with many corners, of vertices that may be defined after them.
struct PolygonList {
  static constexpr int kTold = -1;  ///< a corner that is none, which has been reported
  std::vector<int> corners, start{0};
  std::vector<std::uint32_t> at;  ///< of each in the file

  int count() const { return int(at.size()); }
  std::span<const int> polygon(int p) const {
    return {corners.data() + start[std::size_t(p)], std::size_t(start[std::size_t(p) + 1] - start[std::size_t(p)])};
  }
  void end_polygon(MeshSource& in, std::size_t place) {
    bound_items(in, corners.size() / 3, "triangles");
    start.push_back(int(corners.size()));
    at.push_back(static_cast<std::uint32_t>(place));
  }
};
/// "3 lines left out", for every kind of which there were any.
class SurfaceLeftOut {
 public:
  void add(const std::string& kinds, std::int64_t count = 1);  ///< in the plural
  void cut_as_fans(std::int64_t polygons) { m_fans += polygons; }
  /// Takes triangles with a corner twice out. @param before  faces that had fewer than three corners from the start
  void take_flat(std::vector<std::array<int, 3>>& triangles, std::int64_t before = 0);
  void tell(std::vector<std::string>& notes) const;

 private:
  std::vector<std::pair<std::string, std::int64_t>> m_kinds;
  std::int64_t m_fans = 0;
};

/// The triangles of polygons first to last; a vertex that is not there is reported at the polygon's place. Polygons
/// with fewer than three different corners are left out and counted.
/// @param from  the number of the first vertex as the file counts: 1 or 0
std::vector<std::array<int, 3>> cut_polygons(MeshSource& in, const std::vector<Vec3d>& positions,
                                             const PolygonList& polygons, int first, int last, int from,
                                             SurfaceLeftOut& left_out);

/// Corners of a strip of triangles, every second one turned; one with a corner twice only joins two strips.
void add_strip(std::span<const int> strip, std::vector<std::array<int, 3>>& triangles);

}  // namespace trocar::geometry
