#include <cmath>

#include <trocar/view/base/fold_pattern.hpp>
#include <trocar/view/base/relief.hpp>

namespace trocar::view {

Vec3f fold_rest(double s, double v) { return vec_cast<float>(Vec3d{s, 0.5 * kFoldTile * v, 0}); }

Paint fold_paint(double s, double v) {
  const double uneven = 0.5 + 0.5 * waves({s, 0.02 * v, 0}, 0.013);
  const double fat = smooth(0.62 + 0.25 * uneven, 1.0, v), seam = 0.5 * smooth(0.16, 0, v);
  const double shade = 1 - 0.3 * smooth(0.25, 0, v < 0.5 ? v : 1 - v);
  return {to_byte(shade), 0, 0, to_byte(std::fmax(0.75 * fat, seam))};
}

}  // namespace trocar::view
