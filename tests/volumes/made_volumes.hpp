// Volumes and labels for tests: balls, boxes and tubes of known size.
#pragma once

#include <cmath>
#include <functional>

#include <trocar/volumes/image/labels.hpp>
#include <trocar/volumes/image/volume.hpp>

namespace trocar::volumes {

/// Values by place [mm] on a grid whose middle is at the origin.
inline Volume made_volume(Index3 size, Vec3d spacing, const std::function<double(Vec3d)>& value) {
  Volume out;
  out.grid.size = size;
  out.grid.spacing = spacing;
  for (int k = 0; k < 3; ++k) out.grid.origin[k] = -0.5 * spacing[k] * (size[std::size_t(k)] - 1);
  out.stored.resize(out.grid.count());
  for (std::size_t i = 0; i < out.stored.size(); ++i) {
    const Index3 v = out.grid.place(i);
    out.stored[i] = out.number_of(value(out.grid.to_patient({double(v[0]), double(v[1]), double(v[2])})));
  }
  return out;
}
/// Voxels get `label` where the function is true.
inline void put_label(Labels& labels, std::uint16_t label, const std::function<bool(Vec3d)>& inside) {
  for (std::size_t i = 0; i < labels.at.size(); ++i) {
    const Index3 v = labels.grid.place(i);
    if (inside(labels.grid.to_patient({double(v[0]), double(v[1]), double(v[2])}))) labels.at[i] = label;
  }
}
inline std::function<bool(Vec3d)> ball(Vec3d centre, double radius) {
  return [=](Vec3d p) { return length(p - centre) <= radius; };
}
inline double ball_ml(double radius_mm) { return 4.0 / 3 * 3.14159265358979 * std::pow(radius_mm, 3) * 1e-3; }

}  // namespace trocar::volumes
