#include <algorithm>
#include <cmath>

#include <trocar/view/relief.hpp>
#include <trocar/view/sheet_crescent.hpp>

namespace trocar::view {
namespace {

constexpr double kFarthest = 0.04;  // [m] from the strand to the wall
constexpr double kSunk = 0.0022;    // [m] the fold ends below the wall
constexpr double kHollow = 0.55;    // of the border's span: how far it keeps to the strand, and to the wall
constexpr double kUneven = 0.0014;  // [m] of the free border
constexpr double kRim = 0.3;        // of the way to the border: there it thickens and pales
constexpr double kLost = 0.12;      // of a column: there it goes over into the wall

}  // namespace

SheetCrescent::SheetCrescent(Vec3d base, std::span<const Vec3d> beside, const WallSurface& walls) {
  const Vec3d tip = beside.back();
  const WallSurface::Place arrives = walls.nearest(tip);
  if (!arrives.there || length(arrives.point - tip) > kFarthest) return;
  for (int k = 0; k <= kSteps; ++k) {
    const double u = double(k) / kSteps;
    const Vec3d straight = base + u * (arrives.point - base);
    const WallSurface::Place wall = walls.nearest(straight);
    m_on_wall.push_back(straight + smooth(0, 0.4, u) * (wall.point - kSunk * wall.normal - straight));
  }
  for (int pass = 0; pass < 4; ++pass)  // walls bend, and where they do the nearest place on them jumps
    for (std::size_t k = 1; k < kSteps; ++k)
      m_on_wall[k] = 0.5 * m_on_wall[k] + 0.25 * (m_on_wall[k - 1] + m_on_wall[k + 1]);
}

/// From the tip on the strand to the wall: it leaves along the one and arrives along the other.
Vec3d SheetCrescent::border(double v, Vec3d tip, Vec3d along) const {
  const Vec3d end = m_on_wall.back(), onward = normalised(end - m_on_wall[kSteps - 2], along);
  const double reach = kHollow * length(end - tip), u = 1 - v;
  const Vec3d a = tip - reach * along, b = end - reach * onward;
  const Vec3d p = (u * u * u) * tip + (3 * u * u * v) * a + (3 * u * v * v) * b + (v * v * v) * end;
  return p + (4 * u * v * kUneven * waves({0.05 * v, 0.3 * tip.x, 0.3 * tip.y}, 0.014)) * along;
}

void SheetCrescent::place(std::span<const Vec3f> column, std::span<const Vec3d> beside, std::span<Vec3f> out) const {
  const std::size_t rows = column.size();
  const Vec3d tip = beside.back(), along = normalised(tip - beside[kSteps - 1], Vec3d{1, 0, 0});
  const Vec3d top = vec_cast<double>(column.front()), base = vec_cast<double>(column.back());
  for (std::size_t r = 0; r < rows; ++r) {
    const double v = double(r) / double(rows - 1), v1 = 1 - v;
    const Vec3d own = vec_cast<double>(column[r]), far = border(v, tip, along);
    for (int k = 1; k <= kSteps; ++k) {
      const double u = double(k) / kSteps, u1 = 1 - u;
      const Vec3d sides = u1 * own + u * far + v1 * beside[std::size_t(k)] + v * m_on_wall[std::size_t(k)];
      const Vec3d corners = (u1 * v1) * top + (u * v1) * tip + (u1 * v) * base + (u * v) * m_on_wall.back();
      out[std::size_t(k - 1) * rows + r] = vec_cast<float>(sides - corners);
    }
  }
}

Paint SheetCrescent::paint(int step, double v) {
  const double u = double(step) / kSteps;
  const double wall = 1 - smooth(1 - kLost, 1, v) * smooth(0, 0.3, u);
  const double rim = smooth(1 - kRim, 0.9, u);
  const double edge = 1 - 0.45 * smooth(0.85, 1, u);  // thin, and yet an edge: nothing ends in a mist
  const double walls = smooth(0.35, 0.9, v) * smooth(0, 0.5, u);
  return {to_byte(edge * wall), 0, 0, to_byte(std::max(0.22 * rim, 0.9 * walls))};
}

}  // namespace trocar::view
