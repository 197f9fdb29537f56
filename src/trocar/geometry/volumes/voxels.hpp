// A volume of voxels, as a scanner or a segmentation gives it: values on a regular grid that may be turned and
// stretched. Read from files by voxel_files/nrrd.hpp, made into shapes by field.hpp.
//
//   const double value = volume.at(i, j, k);
//   const Vec3d there = volume.centre({i, j, k});
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry {

struct Voxels {
  std::array<int, 3> size{};       ///< along the axes
  Vec3d origin;                    ///< centre of the first voxel [m]
  Mat3d step = Mat3d::identity();  ///< columns: from a voxel to the next along each axis [m]
  /// The first axis fastest, the third slowest.
  std::variant<std::vector<std::uint8_t>, std::vector<std::int16_t>, std::vector<std::uint16_t>, std::vector<float>>
      values;

  std::size_t count() const { return std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]); }
  std::size_t index(int i, int j, int k) const {
    return std::size_t(i) + std::size_t(size[0]) * (std::size_t(j) + std::size_t(size[1]) * std::size_t(k));
  }
  double at(int i, int j, int k) const {
    return std::visit([&](const auto& all) { return double(all[index(i, j, k)]); }, values);
  }
  Vec3d centre(Vec3d ijk) const { return origin + step * ijk; }
};

}  // namespace trocar::geometry
