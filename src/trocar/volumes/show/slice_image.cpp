#include <algorithm>
#include <cmath>

#include <trocar/core/require.hpp>
#include <trocar/volumes/show/slice_image.hpp>

namespace trocar::volumes {
namespace {

constexpr int kMostPixels = 8192;  // along a side

/// A plane with these directions that shows all of the grid's box.
SlicePlane showing_all(const Grid& grid, Vec3d through, Vec3d right, Vec3d down) {
  SlicePlane out;
  const double pixel = grid.least_spacing();
  double low[2]{1e300, 1e300}, high[2]{-1e300, -1e300};
  for (int corner = 0; corner < 8; ++corner) {
    Vec3d v;
    for (int k = 0; k < 3; ++k) v[k] = (corner >> k & 1) != 0 ? grid.size[std::size_t(k)] - 1 : 0;
    const Vec3d off = grid.to_patient(v) - through;
    const double along[] = {dot(off, right), dot(off, down)};
    for (int a = 0; a < 2; ++a) low[a] = std::min(low[a], along[a]), high[a] = std::max(high[a], along[a]);
  }
  out.right = pixel * right;
  out.down = pixel * down;
  out.corner = through + low[0] * right + low[1] * down;
  out.width = std::clamp(int(std::floor((high[0] - low[0]) / pixel + 1e-6)) + 1, 1, kMostPixels);
  out.height = std::clamp(int(std::floor((high[1] - low[1]) / pixel + 1e-6)) + 1, 1, kMostPixels);
  return out;
}

bool inside_voxels(Vec3d v, const Index3& size) {
  for (int k = 0; k < 3; ++k)
    if (!(v[k] >= -0.5 && v[k] <= size[std::size_t(k)] - 0.5)) return false;
  return true;
}

/// From pixels to voxels of a grid.
struct Walk {
  Vec3d start, right, down;
  Walk(const Grid& grid, const SlicePlane& plane) {
    const Mat3d back = inverse(grid.step());
    start = back * (plane.corner - grid.origin);
    right = back * plane.right;
    down = back * plane.down;
  }
  Vec3d at(int x, int y) const { return start + double(x) * right + double(y) * down; }
};
Index3 nearest_voxel(Vec3d v) {
  return {int(std::floor(v.x + 0.5)), int(std::floor(v.y + 0.5)), int(std::floor(v.z + 0.5))};
}

void paint_labels(Picture& picture, const Labels& labels, const SlicePlane& plane, const SliceLook& look) {
  const Walk walk(labels.grid, plane);
  std::vector<std::uint16_t> shown(std::size_t(plane.width) * std::size_t(plane.height));
  std::vector<std::array<float, 3>> colours(65536);
  std::vector<std::uint8_t> visible(65536, 0);
  for (const Segment& s : labels.segments) colours[s.label] = s.colour, visible[s.label] = s.visible ? 1 : 0;
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x) {
      const Vec3d at = walk.at(x, y);
      const Index3 v = nearest_voxel(at);
      if (!inside_voxels(at, labels.grid.size) || !labels.grid.has(v)) continue;
      const std::uint16_t label = labels.at[labels.grid.index(v)];
      if (visible[label] != 0) shown[std::size_t(y * plane.width + x)] = label;
    }
  const auto label_at = [&](int x, int y) {
    return x < 0 || y < 0 || x >= plane.width || y >= plane.height ? std::uint16_t(0)
                                                                   : shown[std::size_t(y * plane.width + x)];
  };
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x) {
      const std::uint16_t label = label_at(x, y);
      if (label == 0) continue;
      const bool edge = label_at(x - 1, y) != label || label_at(x + 1, y) != label || label_at(x, y - 1) != label ||
                        label_at(x, y + 1) != label;
      const double much = std::clamp(look.label_opacity * (edge && look.outlines ? 2 : 1), 0.0, 1.0);
      std::uint8_t* pixel = picture.rgba.data() + 4 * std::size_t(y * plane.width + x);
      for (std::size_t c = 0; c < 3; ++c)
        pixel[c] = std::uint8_t(pixel[c] + much * (255.0 * double(colours[label][c]) - pixel[c]) + 0.5);
    }
}

}  // namespace

SlicePlane axial(const Grid& grid, Vec3d through) { return showing_all(grid, through, {1, 0, 0}, {0, 1, 0}); }
SlicePlane coronal(const Grid& grid, Vec3d through) { return showing_all(grid, through, {1, 0, 0}, {0, 0, -1}); }
SlicePlane sagittal(const Grid& grid, Vec3d through) { return showing_all(grid, through, {0, 1, 0}, {0, 0, -1}); }

SlicePlane across_axis(const Grid& grid, int axis, int slice) {
  core::require(axis >= 0 && axis <= 2, "an axis is 0, 1 or 2");
  const int right = axis == 0 ? 1 : 0, down = axis == 2 ? 1 : 2;
  SlicePlane out;
  Vec3d first;
  first[axis] = slice;
  out.corner = grid.to_patient(first);
  const double pixel = std::min(grid.spacing[right], grid.spacing[down]);
  out.right = pixel * grid.direction.column(right);
  out.down = pixel * grid.direction.column(down);
  const auto pixels = [&](int k) {
    return std::clamp(int(std::floor((grid.size[std::size_t(k)] - 1) * grid.spacing[k] / pixel + 1e-6)) + 1, 1,
                      kMostPixels);
  };
  out.width = pixels(right);
  out.height = pixels(down);
  return out;
}

SlicePlane oblique(const Grid& grid, Vec3d through, Vec3d normal, Vec3d up) {
  const Vec3d n = normalised(normal);
  const Vec3d right = cross(up, n);
  core::require(length(right) > 1e-6 * length(up), "what is upwards in a slice is not along its normal");
  return showing_all(grid, through, normalised(right), -cross(n, normalised(right)));
}

Picture slice_image(const Volume& volume, const Labels* labels, const SlicePlane& plane, const SliceLook& look) {
  core::require(plane.width >= 1 && plane.height >= 1 && plane.width <= kMostPixels && plane.height <= kMostPixels,
                "a slice has 1 to 8192 pixels along a side");
  Picture out{plane.width,
              plane.height,
              std::vector<std::uint8_t>(4 * std::size_t(plane.width) * std::size_t(plane.height)),
              {}};
  const Walk walk(volume.grid, plane);
  const double low = look.centre - look.width / 2, scale = 255 / std::max(look.width, 1e-12);
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x) {
      const Vec3d at = walk.at(x, y);
      std::uint8_t* pixel = out.rgba.data() + 4 * std::size_t(y * plane.width + x);
      pixel[3] = 255;
      if (!inside_voxels(at, volume.grid.size)) continue;
      const Index3 v = nearest_voxel(at);
      const double value = look.smooth || !volume.grid.has(v) ? volume.at(at) : volume.value(v);
      const double grey = std::clamp((value - low) * scale, 0.0, 255.0);
      std::fill_n(pixel, 3, std::uint8_t((look.inverted ? 255 - grey : grey) + 0.5));
    }
  if (labels) paint_labels(out, *labels, plane, look);
  return out;
}

}  // namespace trocar::volumes
