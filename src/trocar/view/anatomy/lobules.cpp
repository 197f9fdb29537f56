#include <algorithm>
#include <cmath>

#include <trocar/view/anatomy/lobules.hpp>
#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

double lobules(Vec3d p, double size) {
  constexpr double kSharp = 9, kTooFar = 1.35;  // the greater, the more a lobule is by itself; squared distance
  const Vec3d q = (1 / size) * p;
  const int i0 = int(std::floor(q.x)), j0 = int(std::floor(q.y)), k0 = int(std::floor(q.z));
  double sum = std::exp(-kSharp * kTooFar);
  for (int k = k0 - 1; k <= k0 + 1; ++k)
    for (int j = j0 - 1; j <= j0 + 1; ++j)
      for (int i = i0 - 1; i <= i0 + 1; ++i) {
        const int cell = i + 57 * j + 3251 * k;
        const Vec3d off = q - Vec3d{i + varied(cell, 81), j + varied(cell, 82), k + varied(cell, 83)};
        const double far = dot(off, off) * (0.75 + 0.5 * varied(cell, 84));
        if (far < kTooFar) sum += std::exp(-kSharp * far);
      }
  const double nearest = -std::log(sum) / kSharp;
  return std::clamp(1 - 3.0 * nearest, 0.0, 1.0);
}

}  // namespace trocar::view
