#include <algorithm>
#include <cmath>

#include <trocar/volumes/segment/distance.hpp>

namespace trocar::volumes {
namespace {

constexpr float kNowhere = 1e20f;

/// The lower envelope of parabolas along a line.
class Envelope {
 public:
  explicit Envelope(int longest)
      : m_from(std::size_t(longest) + 1), m_at(std::size_t(longest)), m_value(std::size_t(longest)) {}

  /// values[n * stride] += smallest of value + squared distance, as a new line.
  void line(float* values, std::size_t stride, int count, double spacing) {
    int top = -1;
    for (int q = 0; q < count; ++q) {
      const double height = values[std::size_t(q) * stride];
      if (height >= double(kNowhere)) continue;
      const double x = q * spacing;
      double from = -1e30;
      while (top >= 0) {
        const double other = m_at[std::size_t(top)];
        from = (height + x * x - m_value[std::size_t(top)] - other * other) / (2 * (x - other));
        if (from > m_from[std::size_t(top)]) break;
        --top;
      }
      if (top < 0) from = -1e30;
      ++top;
      m_at[std::size_t(top)] = x;
      m_value[std::size_t(top)] = height;
      m_from[std::size_t(top)] = from;
    }
    if (top < 0) return;
    int k = 0;
    for (int q = 0; q < count; ++q) {
      const double x = q * spacing;
      while (k < top && m_from[std::size_t(k) + 1] < x) ++k;
      const double d = x - m_at[std::size_t(k)];
      values[std::size_t(q) * stride] = float(d * d + m_value[std::size_t(k)]);
    }
  }

 private:
  std::vector<double> m_from, m_at, m_value;
};

/// Nothing is further from the outside than the box's faces, half a voxel beyond... the next voxel's centre.
void bound_by_border(std::vector<float>& squared, const Index3& size, Vec3d spacing) {
  std::size_t n = 0;
  for (int k = 0; k < size[2]; ++k)
    for (int j = 0; j < size[1]; ++j)
      for (int i = 0; i < size[0]; ++i, ++n) {
        const double near =
            std::min({spacing.x * (std::min(i, size[0] - 1 - i) + 1), spacing.y * (std::min(j, size[1] - 1 - j) + 1),
                      spacing.z * (std::min(k, size[2] - 1 - k) + 1)});
        squared[n] = std::min(squared[n], float(near * near));
      }
}

}  // namespace

std::vector<float> squared_distance(const VoxelSet& set, Vec3d spacing, bool to_outside, bool border_is_outside) {
  std::vector<float> out(set.in.size());
  for (std::size_t n = 0; n < out.size(); ++n) out[n] = (set.in[n] != 0) != to_outside ? 0.0f : kNowhere;
  const Index3 size = set.size();
  const std::size_t nx = std::size_t(size[0]), ny = std::size_t(size[1]), nz = std::size_t(size[2]);
  Envelope envelope(std::max({size[0], size[1], size[2], 1}));
  for (std::size_t row = 0; row < ny * nz; ++row) envelope.line(out.data() + row * nx, 1, size[0], spacing.x);
  for (std::size_t k = 0; k < nz; ++k)
    for (std::size_t i = 0; i < nx; ++i) envelope.line(out.data() + i + k * nx * ny, nx, size[1], spacing.y);
  for (std::size_t i = 0; i < nx * ny; ++i) envelope.line(out.data() + i, nx * ny, size[2], spacing.z);
  if (to_outside && border_is_outside) bound_by_border(out, size, spacing);
  return out;
}

}  // namespace trocar::volumes
