#include <algorithm>
#include <cmath>

#include <trocar/volumes/segment/brush.hpp>

namespace trocar::volumes {
namespace {

/// The voxels that a ball of this radius around the points may reach.
Box box_around(std::span<const Vec3d> points, double reach_mm, const Grid& grid) {
  Vec3d low{1e30, 1e30, 1e30}, high{-1e30, -1e30, -1e30};
  for (const Vec3d& p : points)
    for (int corner = 0; corner < 8; ++corner) {
      Vec3d q = p;
      for (int k = 0; k < 3; ++k) q[k] += (corner >> k & 1) != 0 ? reach_mm : -reach_mm;
      const Vec3d at = grid.to_index(q);
      for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
    }
  Box out;
  for (int k = 0; k < 3; ++k) {
    const double size = grid.size[std::size_t(k)];
    out.low[std::size_t(k)] = int(std::clamp(std::floor(low[k]), 0.0, size));
    out.high[std::size_t(k)] = int(std::clamp(std::ceil(high[k]) + 1, 0.0, size));
  }
  return out;
}

/// How far a voxel reaches from its centre along a direction: half the distance of slices in that direction.
double half_thickness(const Grid& grid, Vec3d normal) {
  double most = 0;
  for (int k = 0; k < 3; ++k) most = std::max(most, std::fabs(dot(grid.step().column(k), normal)));
  return most / 2;
}

double squared_distance_to_segment(Vec3d p, Vec3d a, Vec3d b) {
  const Vec3d along = b - a;
  const double squared = dot(along, along);
  const double share = squared > 0 ? std::clamp(dot(p - a, along) / squared, 0.0, 1.0) : 0;
  const Vec3d off = p - (a + share * along);
  return dot(off, off);
}

void paint_segment(VoxelSet& set, const Grid& grid, Vec3d a, Vec3d b, const Brush& brush) {
  const Vec3d ends[] = {a, b};
  const double half = brush.normal ? half_thickness(grid, *brush.normal) * (1 + 1e-9) : 0;
  const Box box = box_around(ends, brush.radius_mm + 2 * half, grid);
  for (int k = box.low[2]; k < box.high[2]; ++k)
    for (int j = box.low[1]; j < box.high[1]; ++j)
      for (int i = box.low[0]; i < box.high[0]; ++i) {
        Vec3d p = grid.to_patient({double(i), double(j), double(k)});
        if (brush.normal) {
          const double off = dot(p - a, *brush.normal);
          if (!(off > -half && off <= half)) continue;
          p -= off * *brush.normal;
        }
        if (squared_distance_to_segment(p, a, b) <= brush.radius_mm * brush.radius_mm)
          set.in[set.number({i, j, k})] = 1;
      }
}

}  // namespace

LabelChange painted(const Volume& volume, const Labels& labels, std::span<const Vec3d> stroke, const Brush& brush,
                    std::uint16_t label, const EditRules& rules) {
  if (stroke.empty()) return {};
  const double reach = brush.radius_mm + (brush.normal ? 2 * half_thickness(labels.grid, *brush.normal) : 0);
  VoxelSet set(box_around(stroke, reach, labels.grid));
  if (set.box.empty()) return {};
  if (stroke.size() == 1) paint_segment(set, labels.grid, stroke[0], stroke[0], brush);
  for (std::size_t i = 1; i < stroke.size(); ++i) paint_segment(set, labels.grid, stroke[i - 1], stroke[i], brush);
  return labelled(volume, labels, set, label, rules);
}

}  // namespace trocar::volumes
