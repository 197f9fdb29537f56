#include <algorithm>
#include <cmath>

#include <trocar/view/analysis/surface_strain.hpp>

namespace trocar::view {

double triangle_strain(const std::array<Vec3f, 3>& drawn, const std::array<Vec3f, 3>& now) {
  const auto edge = [](const std::array<Vec3f, 3>& t, int k) {
    return vec_cast<double>(t[std::size_t(k)]) - vec_cast<double>(t[0]);
  };
  const Vec3d a = edge(drawn, 1), b = edge(drawn, 2), u = edge(now, 1), v = edge(now, 2);
  // In the drawn triangle's plane: a = (ax, 0), b = (bx, by). F maps these to u and v.
  const double ax = length(a);
  if (!(ax > 1e-9)) return 0;
  const double bx = dot(b, a) / ax, by = std::sqrt(std::max(0.0, dot(b, b) - bx * bx));
  if (!(by > 1e-9)) return 0;
  const Vec3d f1 = u / ax, f2 = (v - bx * f1) / by;
  const double c11 = dot(f1, f1), c12 = dot(f1, f2), c22 = dot(f2, f2);
  const double mean = 0.5 * (c11 + c22), apart = std::hypot(0.5 * (c11 - c22), c12);
  const double most = std::sqrt(mean + apart) - 1, least = std::sqrt(std::max(0.0, mean - apart)) - 1;
  const double strain = std::fabs(most) >= std::fabs(least) ? most : least;
  return std::isfinite(strain) ? strain : 0;
}

void vertex_strains(std::span<const Vec3f> drawn, std::span<const Vec3f> now,
                    std::span<const std::array<int, 3>> triangles, std::vector<float>& out) {
  out.assign(drawn.size(), 0);
  std::vector<float> area(drawn.size(), 0);
  for (const std::array<int, 3>& t : triangles) {
    const std::array<std::size_t, 3> v{std::size_t(t[0]), std::size_t(t[1]), std::size_t(t[2])};
    const float size = length(cross(drawn[v[1]] - drawn[v[0]], drawn[v[2]] - drawn[v[0]]));
    const double strain = triangle_strain({drawn[v[0]], drawn[v[1]], drawn[v[2]]}, {now[v[0]], now[v[1]], now[v[2]]});
    for (const std::size_t k : v) {
      out[k] += size * float(strain);
      area[k] += size;
    }
  }
  for (std::size_t k = 0; k < out.size(); ++k)
    if (area[k] > 0) out[k] /= area[k];
}

}  // namespace trocar::view
