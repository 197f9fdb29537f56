#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/render/meshes/openness.hpp>

namespace trocar::render {

namespace {

constexpr int kRays = 24;
constexpr std::size_t kMostCells = 64u << 20;

/// Cosine-weighted directions about +z on a spiral.
std::vector<Vec3f> hemisphere() {
  std::vector<Vec3f> rays;
  for (int i = 0; i < kRays; ++i) {
    const double r2 = (i + 0.5) / kRays, angle = 2.39996323 * i;
    const double r = std::sqrt(r2);
    rays.push_back({float(r * portable::cos(angle)), float(r * portable::sin(angle)), float(std::sqrt(1 - r2))});
  }
  return rays;
}

}  // namespace

OpennessBaker::OpennessBaker(std::span<const Occluder> occluders, float cell, float reach)
    : m_cell(cell), m_reach(reach) {
  Bounds all{{1e9f, 1e9f, 1e9f}, {-1e9f, -1e9f, -1e9f}};
  for (const Occluder& o : occluders) {
    if (o.positions.empty()) continue;
    const Bounds b = bounds_of(o.positions);
    for (int i = 0; i < 3; ++i) {
      all.low[i] = std::min(all.low[i], b.low[i]);
      all.high[i] = std::max(all.high[i], b.high[i]);
    }
  }
  if (all.low.x > all.high.x) return;
  std::size_t count = 0;
  for (;; m_cell *= 1.5f) {
    count = 1;
    for (int i = 0; i < 3; ++i) {
      m_size[i] = int((all.high[i] - all.low[i]) / m_cell) + 1;
      count *= std::size_t(m_size[i]);
    }
    if (count <= kMostCells) break;
  }
  m_low = all.low;
  m_cells.assign(count, false);
  for (const Occluder& o : occluders)
    for (std::size_t t = 0; t + 2 < o.triangles.size(); t += 3) {
      const Vec3f a = o.positions[o.triangles[t]];
      const Vec3f ab = o.positions[o.triangles[t + 1]] - a, ac = o.positions[o.triangles[t + 2]] - a;
      const int steps = 1 + int(1.5f * std::max({length(ab), length(ac), length(ac - ab)}) / m_cell);
      for (int i = 0; i <= steps; ++i)
        for (int j = 0; i + j <= steps; ++j) {
          const Vec3f p = a + (float(i) / float(steps)) * ab + (float(j) / float(steps)) * ac;
          const Vec3f q = (p - m_low) / m_cell;
          const int x = std::clamp(int(q.x), 0, m_size[0] - 1), y = std::clamp(int(q.y), 0, m_size[1] - 1),
                    z = std::clamp(int(q.z), 0, m_size[2] - 1);
          m_cells[std::size_t(x) + std::size_t(m_size[0]) * (y + std::size_t(m_size[1]) * z)] = true;
        }
    }
}

bool OpennessBaker::occupied(Vec3f p) const {
  const Vec3f q = (p - m_low) / m_cell;
  if (!(q.x >= 0 && q.y >= 0 && q.z >= 0)) return false;
  const int x = int(q.x), y = int(q.y), z = int(q.z);
  if (x >= m_size[0] || y >= m_size[1] || z >= m_size[2]) return false;
  return m_cells[std::size_t(x) + std::size_t(m_size[0]) * (y + std::size_t(m_size[1]) * z)];
}

float OpennessBaker::openness_at(Vec3f p, Vec3f n) const {
  static const std::vector<Vec3f> rays = hemisphere();
  const Vec3f right = any_perpendicular(n), up = cross(n, right);
  const Vec3f start = p + (1.8f * m_cell) * n;  // clear of the cells that the surface itself fills
  float light = 0;
  for (const Vec3f& r : rays) {
    const Vec3f d = r.x * right + r.y * up + r.z * n;
    float seen = 1;
    for (float s = 0.5f * m_cell; s < m_reach; s += m_cell)
      if (occupied(start + s * d)) {
        seen = 0.75f * s / m_reach;  // far things shade less
        break;
      }
    light += seen;
  }
  return light / kRays;
}

void OpennessBaker::bake(std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                         std::span<Paint> paint) const {
  for (std::size_t i = 0; i < positions.size(); ++i)
    paint[i].openness = std::uint8_t(std::clamp(255.0f * openness_at(positions[i], normals[i]) + 0.5f, 0.0f, 255.0f));
}

void even_openness(std::span<const std::uint32_t> triangles, std::span<Paint> paint, int passes) {
  std::vector<float> sum(paint.size()), count(paint.size());
  for (int pass = 0; pass < passes; ++pass) {
    std::fill(sum.begin(), sum.end(), 0.0f);
    std::fill(count.begin(), count.end(), 0.0f);
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
      sum[triangles[i]] += float(paint[triangles[next]].openness);
      sum[triangles[next]] += float(paint[triangles[i]].openness);
      ++count[triangles[i]];
      ++count[triangles[next]];
    }
    for (std::size_t v = 0; v < paint.size(); ++v)
      if (count[v] > 0) paint[v].openness = std::uint8_t(0.5f * (float(paint[v].openness) + sum[v] / count[v]) + 0.5f);
  }
}

}  // namespace trocar::render
