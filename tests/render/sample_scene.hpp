// A stand-in for anatomy, to develop and to test the look on: a pear with tubes and ovaries before a hollow wall, fat,
// a steel shaft with jaws, a pool. Shapes only; no test depends on what they mean.
#pragma once

#include <vector>

#include <trocar/render/backend/backend.hpp>
#include <trocar/render/frame/frame.hpp>

namespace trocar::render::sample {

struct Shape {
  std::vector<Vec3f> positions;
  std::vector<std::uint32_t> triangles;
  std::vector<Paint> paint;
};

Shape sphere(Vec3f centre, float radius, int rings);
/// A tube of the given radii along points.
Shape tube(const std::vector<Vec3f>& path, const std::vector<float>& radii, int around);
/// A sheet: (u, v) in 0..1 -> point; counter-clockwise seen from +(du x dv).
template <class Function>
Shape sheet(int columns, int rows, Function&& point);

MeshHandle create(Backend& backend, const Shape& shape);

/// Fills frame.items with the whole stand-in. @param kind 0 pelvis, 1 fat and liver, 2 burnt and bloody
void build(Backend& backend, int kind, Frame& frame);

template <class Function>
Shape sheet(int columns, int rows, Function&& point) {
  Shape s;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) s.positions.push_back(point(float(i) / float(columns), float(j) / float(rows)));
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const auto a = std::uint32_t(j * (columns + 1) + i), b = a + 1, c = a + std::uint32_t(columns) + 1, d = c + 1;
      for (std::uint32_t k : {a, b, d, a, d, c}) s.triangles.push_back(k);
    }
  s.paint.resize(s.positions.size());
  return s;
}

}  // namespace trocar::render::sample
