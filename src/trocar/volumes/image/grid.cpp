#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/volumes/image/grid.hpp>

namespace trocar::volumes {
namespace {

std::array<Vec3d, 8> corners_in_index(const Grid& grid) {
  std::array<Vec3d, 8> out;
  for (int c = 0; c < 8; ++c)
    for (int k = 0; k < 3; ++k) out[std::size_t(c)][k] = (c >> k & 1) != 0 ? grid.size[std::size_t(k)] - 1 : 0;
  return out;
}

}  // namespace

Index3 Grid::place(std::size_t at) const {
  const std::size_t nx = std::size_t(size[0]), ny = std::size_t(size[1]);
  return {int(at % nx), int(at / nx % ny), int(at / nx / ny)};
}

Mat3d Grid::step() const {
  return Mat3d::from_columns(spacing.x * direction.column(0), spacing.y * direction.column(1),
                             spacing.z * direction.column(2));
}

Index3 Grid::nearest(Vec3d lps_mm) const {
  const Vec3d v = to_index(lps_mm);
  Index3 out{};
  for (int k = 0; k < 3; ++k) out[std::size_t(k)] = int(std::floor(std::clamp(v[k], -1e9, 1e9) + 0.5));
  return out;
}

double Grid::voxel_ml() const { return 1e-3 * std::fabs(determinant(step())); }
double Grid::least_spacing() const { return std::min({spacing.x, spacing.y, spacing.z}); }

bool operator==(const Grid& a, const Grid& b) {
  for (int k = 0; k < 3; ++k)
    if (!(a.direction.column(k) == b.direction.column(k))) return false;
  return a.size == b.size && a.origin == b.origin && a.spacing == b.spacing;
}

Grid grid_of(const Index3& size, Vec3d origin, const Mat3d& step) {
  Grid out;
  out.size = size;
  out.origin = origin;
  Vec3d axes[3];
  for (int k = 0; k < 3; ++k) {
    out.spacing[k] = length(step.column(k));
    axes[k] = step.column(k) / out.spacing[k];
  }
  out.direction = Mat3d::from_columns(axes[0], axes[1], axes[2]);
  return out;
}

double shear_deg(const Grid& grid) {
  double most = 0;
  for (int a = 0; a < 3; ++a)
    for (int b = a + 1; b < 3; ++b)
      most = std::max(most, std::fabs(dot(grid.direction.column(a), grid.direction.column(b))));
  return portable::asin(most) * 180 / portable::pi;
}

bool same_place(const Grid& a, const Grid& b, double tolerance) {
  if (a.size != b.size) return false;
  const auto corners = corners_in_index(a);
  return std::all_of(corners.begin(), corners.end(), [&](Vec3d c) {
    return length(a.to_patient(c) - b.to_patient(c)) <= tolerance * a.least_spacing();
  });
}

Grid straightened(const Grid& sheared) {
  const Vec3d x = sheared.direction.column(0);
  const Vec3d normal = normalised(cross(x, sheared.direction.column(1)));
  const Vec3d y = cross(normal, x);
  const double along = dot(sheared.direction.column(2), normal);
  Grid out = sheared;
  out.direction = Mat3d::from_columns(x, y, along < 0 ? -normal : normal);
  out.spacing.y *= std::fabs(dot(sheared.direction.column(1), y));
  out.spacing.z *= std::fabs(along);
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  for (const Vec3d& corner : corners_in_index(sheared)) {
    const Vec3d at = out.to_index(sheared.to_patient(corner));
    for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
  }
  for (int k = 0; k < 3; ++k) {
    low[k] = std::floor(low[k] + 1e-6);
    out.size[std::size_t(k)] = int(std::ceil(high[k] - low[k] - 1e-6)) + 1;
  }
  out.origin = out.to_patient(low);
  return out;
}

geometry::Bounds patient_box(const Grid& grid) {
  auto corners = corners_in_index(grid);
  for (Vec3d& c : corners) c = grid.to_patient(c);
  return geometry::bounds(corners);
}

Box common(const Box& a, const Box& b) {
  Box out;
  for (std::size_t k = 0; k < 3; ++k) {
    out.low[k] = std::max(a.low[k], b.low[k]);
    out.high[k] = std::min(a.high[k], b.high[k]);
  }
  return out;
}

Box widened(const Box& box, const Index3& by, const Grid& within) {
  Box out = box;
  for (std::size_t k = 0; k < 3; ++k) out.low[k] -= by[k], out.high[k] += by[k];
  return common(out, whole(within));
}

}  // namespace trocar::volumes
