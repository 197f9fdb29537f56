// Where voxels are in the patient: a regular grid that may be turned, stretched, mirrored, and sheared.
//
//   const Vec3d there = grid.to_patient({i, j, k});           // [mm], L P S
//   const Vec3d scene = scene_from_patient(there);            // [m], as scenes have it
//
// Inside this folder patients are in millimetres along L P S (left, posterior, superior), as DICOM and ITK have it.
// Scenes have x to the patient's left, y to the head, z to the front, in metres.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <trocar/geometry/surfaces/tri_mesh.hpp>
#include <trocar/numerics/mat3.hpp>

namespace trocar::volumes {

using Index3 = std::array<int, 3>;

struct Grid {
  Index3 size{};                        ///< voxels along the axes
  Vec3d origin;                         ///< centre of the first voxel [mm, L P S]
  Vec3d spacing{1, 1, 1};               ///< between neighbours along the axes [mm], > 0
  Mat3d direction = Mat3d::identity();  ///< columns: the axes, of unit length; perpendicular unless sheared

  std::size_t count() const { return std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]); }
  std::size_t index(int i, int j, int k) const {
    return std::size_t(i) + std::size_t(size[0]) * (std::size_t(j) + std::size_t(size[1]) * std::size_t(k));
  }
  std::size_t index(const Index3& v) const { return index(v[0], v[1], v[2]); }
  Index3 place(std::size_t index) const;
  bool has(const Index3& v) const {
    return v[0] >= 0 && v[1] >= 0 && v[2] >= 0 && v[0] < size[0] && v[1] < size[1] && v[2] < size[2];
  }
  Mat3d step() const;  ///< columns: from a voxel to the next along each axis [mm]
  Vec3d to_patient(Vec3d ijk) const { return origin + step() * ijk; }
  Vec3d to_index(Vec3d lps_mm) const { return inverse(step()) * (lps_mm - origin); }
  Index3 nearest(Vec3d lps_mm) const;  ///< may be outside
  double voxel_ml() const;             ///< volume of a voxel [mL]
  double least_spacing() const;        ///< [mm]

  friend bool operator==(const Grid& a, const Grid& b);
};

/// The grid of an origin and a step matrix [mm, L P S]. The columns must not be 0.
Grid grid_of(const Index3& size, Vec3d origin, const Mat3d& step);
/// How far the axes are from perpendicular to each other [degrees].
double shear_deg(const Grid& grid);
/// The same size, and all corners within `tolerance` of a voxel of each other.
bool same_place(const Grid& a, const Grid& b, double tolerance = 0.01);
/// A grid with perpendicular axes that holds all of a sheared one: its first two axes' plane stays, its third becomes
/// perpendicular to that.
Grid straightened(const Grid& sheared);
/// The box around the voxels' centres [mm].
geometry::Bounds patient_box(const Grid& grid);

inline Vec3d scene_from_patient(Vec3d lps_mm) { return {1e-3 * lps_mm.x, 1e-3 * lps_mm.z, -1e-3 * lps_mm.y}; }
inline Vec3d patient_from_scene(Vec3d metres) { return {1e3 * metres.x, -1e3 * metres.z, 1e3 * metres.y}; }
/// The same for directions: the matrix without the change of unit.
inline constexpr Mat3d kSceneFromPatient{{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}};

/// A part of a grid: voxels from `low` up to, and without, `high`.
struct Box {
  Index3 low{}, high{};
  bool empty() const { return low[0] >= high[0] || low[1] >= high[1] || low[2] >= high[2]; }
  Index3 size() const { return {high[0] - low[0], high[1] - low[1], high[2] - low[2]}; }
  std::size_t count() const {
    return empty() ? 0 : std::size_t(high[0] - low[0]) * std::size_t(high[1] - low[1]) * std::size_t(high[2] - low[2]);
  }
  friend bool operator==(const Box&, const Box&) = default;
};
inline Box whole(const Grid& grid) { return {{0, 0, 0}, grid.size}; }
Box common(const Box& a, const Box& b);
/// Larger by so many voxels on each side, as far as the grid reaches.
Box widened(const Box& box, const Index3& by, const Grid& within);

}  // namespace trocar::volumes
