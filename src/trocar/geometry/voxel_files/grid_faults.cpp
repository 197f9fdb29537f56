#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/voxel_files/grid_faults.hpp>

namespace trocar::geometry {
namespace {

constexpr double kMostPlace = 1e6, kLeastStep = 1e-4, kMostStep = 1e4;  // [mm]

std::string told(double value) { return std::isnan(value) ? tr("nan (not a number)") : fmt::format("{}", value); }

}  // namespace

std::optional<std::string> size_fault(const std::array<std::int64_t, 3>& announced, std::size_t most_voxels) {
  std::uint64_t room = most_voxels;
  for (const std::int64_t size : announced) {
    if (size < 1) return tr("expected sizes of at least 1, got {} x {} x {}", announced[0], announced[1], announced[2]);
    if (size > std::numeric_limits<int>::max() || std::uint64_t(size) > room)
      return tr("expected at most {} voxels, got {} x {} x {}", most_voxels, announced[0], announced[1], announced[2]);
    room /= std::uint64_t(size);
  }
  return {};
}

std::optional<std::string> place_fault(Vec3d origin, const Mat3d& step) {
  for (int k = 0; k < 3; ++k) {
    if (!(std::fabs(origin[k]) <= kMostPlace))
      return tr("expected an origin within 1e6 mm, got {} on axis {}: correct the header", told(origin[k]), k);
    const double size = length(step.column(k));
    if (!(size >= kLeastStep && size <= kMostStep))
      return tr(
          "expected voxels from 1e-4 to 1e4 mm apart, got {} along axis {}: write their distance into the header, "
          "or export the scan again",
          told(size), k);
  }
  const double box = length(step.column(0)) * length(step.column(1)) * length(step.column(2));
  if (!(std::fabs(determinant(step)) > 1e-3 * box))
    return tr("expected three axes that span a voxel, got a flat one: correct the directions in the header");
  return {};
}

std::string tracked_sequence() {
  return tr(
      "expected a volume, got a sequence of tracked ultrasound frames (PLUS): reconstruct a volume of it first, in "
      "PLUS or 3D Slicer");
}

}  // namespace trocar::geometry
