#include <algorithm>
#include <cmath>

#include <trocar/view/base/relief.hpp>
#include <trocar/view/bodies/sheet_crescent.hpp>

namespace trocar::view {
namespace {

constexpr double kCrescentFarthest = 0.04;  // [m] from the strand to the wall
constexpr double kBaseFar = 0.016;          // [m] from the fold's base to the wall, if it continues to a ligament
constexpr double kCrescentSunk = 0.0022;    // [m] the fold ends below the wall
constexpr double kCrescentHollow = 0.55;    // of the border's span: how far it keeps to the strand, and to the wall
constexpr double kUneven = 0.0014;          // [m] of the free border
constexpr double kCrescentRim = 0.3;        // of the way to the border: there it thickens and pales
constexpr double kLost = 0.18;              // of a column: there it goes over into the wall
constexpr double kMeets = 0.4;              // of the border: there it has come down to a ligament
constexpr double kFlat = 1.0;               // how much of the way to the wall's tangent it turns on arriving
constexpr double kCrescentInWall = 0.007;   // [m] from the wall: a strand that ends there needs no crescent
constexpr double kPucker = 0.0011;          // [m] soft folds that run from the strand to the wall
constexpr double kContact = 0.35;           // how much darker it is where it meets that

/// From the tip on the strand down to a ligament, and along that to the wall.
Vec3d hung_border(double v, Vec3d tip, Vec3d along, std::span<const Vec3d> ligament) {
  if (v >= kMeets) {
    const double at = (v - kMeets) / (1 - kMeets) * double(ligament.size() - 1);
    const auto k = std::min(std::size_t(at), ligament.size() - 2);
    return ligament[k] + (at - double(k)) * (ligament[k + 1] - ligament[k]);
  }
  const double t = v / kMeets, u = 1 - t, far = length(ligament[0] - tip);
  const Vec3d leaves = far * normalised(normalised(ligament[0] - tip, along) - along, along);
  const Vec3d arrives = far * normalised(ligament[1] - ligament[0], along);
  return (u * u * (1 + 2 * t)) * tip + (t * t * (3 - 2 * t)) * ligament[0] + (u * u * t) * leaves -
         (t * t * u) * arrives;
}

/// How much of a patch that continues to a ligament has the wall's colour: the nearer to the wall, the more.
double wall_share(double u, double v) { return smooth(-0.3, 0.9, u) * (0.55 + 0.35 * v); }

}  // namespace

SheetCrescent::SheetCrescent(Vec3d base, std::span<const Vec3d> beside, std::span<const Vec3d> ligament,
                             const WallSurface& walls) {
  const WallSurface::Place below = walls.nearest(beside.back());
  if (!below.there || length(below.point - beside.back()) < kCrescentInWall) return;
  const Vec3d tip = ligament.empty() ? beside.back() : ligament.back();
  const WallSurface::Place arrives = walls.nearest(tip);
  if (length(arrives.point - tip) > kCrescentFarthest) return;
  if (!ligament.empty() && length(walls.nearest(base).point - base) > kBaseFar) return;
  for (int k = 0; k <= kSteps; ++k) {
    const double u = double(k) / kSteps;
    const Vec3d straight = base + u * (arrives.point - base);
    const WallSurface::Place wall = walls.nearest(straight);
    m_on_wall.push_back(straight + smooth(0, 0.4, u) * (wall.point - kCrescentSunk * wall.normal - straight));
  }
  for (int pass = 0; pass < 4; ++pass)  // walls bend, and where they do the nearest place on them jumps
    for (std::size_t k = 1; k < kSteps; ++k)
      m_on_wall[k] = 0.5 * m_on_wall[k] + 0.25 * (m_on_wall[k - 1] + m_on_wall[k + 1]);
  for (const Vec3d& p : m_on_wall) m_normal.push_back(walls.nearest(p).normal);
}

/// From the tip on the strand to the wall: it leaves along the one and arrives along the other.
Vec3d SheetCrescent::free_border(double v, Vec3d tip, Vec3d along) const {
  const Vec3d end = m_on_wall.back(), onward = normalised(end - m_on_wall[kSteps - 2], along);
  const double reach = kCrescentHollow * length(end - tip), u = 1 - v;
  const Vec3d a = tip - reach * along, b = end - reach * onward;
  const Vec3d p = (u * u * u) * tip + (3 * u * u * v) * a + (3 * u * v * v) * b + (v * v * v) * end;
  return p + (4 * u * v * kUneven * waves({0.05 * v, 0.3 * tip.x, 0.3 * tip.y}, 0.014)) * along;
}

void SheetCrescent::place(std::span<const Vec3f> column, std::span<const Vec3f> before, std::span<const Vec3d> beside,
                          std::span<const Vec3d> ligament, std::span<Vec3f> out) const {
  const std::size_t rows = column.size();
  const Vec3d tip = beside.back(), along = normalised(tip - beside[kSteps - 1], Vec3d{1, 0, 0});
  const Vec3d top = vec_cast<double>(column.front()), base = vec_cast<double>(column.back()), last = m_on_wall.back();
  const Vec3d across = normalised(cross(base - top, last - top), along);
  for (std::size_t r = 0; r < rows; ++r) {
    const double v = double(r) / double(rows - 1), v1 = 1 - v;
    const Vec3d own = vec_cast<double>(column[r]);
    const Vec3d far = ligament.empty() ? free_border(v, tip, along) : hung_border(v, tip, along, ligament);
    const auto coons = [&](int k) {
      const double u = double(k) / kSteps, u1 = 1 - u;
      const Vec3d sides = u1 * own + u * far + v1 * beside[std::size_t(k)] + v * m_on_wall[std::size_t(k)];
      return sides - ((u1 * v1) * top + (u * v1) * tip + (u1 * v) * base + (u * v) * last);
    };
    const Vec3d first = kSteps * (coons(1) - own), onward = normalised(own - vec_cast<double>(before[r]), first);
    const Vec3d turn = (1 - v * v * v) * (length(first) * onward - first);  // no crease beside the last column
    for (int k = 1; k <= kSteps; ++k) {
      const double u = double(k) / kSteps, u1 = 1 - u, slack = 16 * u * u1 * v * v1;
      const double pucker = std::sin(17 * u + 2.6 * v) + 0.6 * std::sin(29 * u - 1.7 * v + 1);
      out[std::size_t(k - 1) * rows + r] =
          vec_cast<float>(coons(k) + (u * u1 * u1) * turn + (kPucker * slack * pucker) * across);
    }
  }
  lay_on_wall(rows, out);
}

/// It does not stand on the wall but runs out on it: each column arrives along that.
void SheetCrescent::lay_on_wall(std::size_t rows, std::span<Vec3f> out) const {
  for (int k = 1; k <= kSteps; ++k) {
    const std::span<Vec3f> column = out.subspan(std::size_t(k - 1) * rows, rows);
    const Vec3d n = m_normal[std::size_t(k)];
    const Vec3d arrives = double(rows - 1) * vec_cast<double>(column[rows - 1] - column[rows - 2]);
    const Vec3d level = normalised(arrives - dot(arrives, n) * n, arrives);
    const double inner = smooth(0, 0.4, double(k) / kSteps);
    const Vec3d turn = (kFlat * inner) * (length(arrives) * level - arrives);
    for (std::size_t r = 0; r < rows; ++r) {
      const double v = double(r) / double(rows - 1);
      column[r] += vec_cast<float>((v * v * (v - 1)) * turn);
    }
  }
}

Paint SheetCrescent::paint(int step, double v, bool hung) {
  const double u = double(step) / kSteps;
  const double wall = 1 - smooth(1 - kLost, 1, v) * smooth(0, 0.15, u);
  const double held = hung ? smooth(0.6 * kMeets, kMeets, v) : 0;  // on a ligament: no border
  const double rim = (1 - held) * smooth(1 - kCrescentRim, 0.9, u);
  // Thin, and yet an edge: nothing ends in a mist. What lies against a ligament is in its shade.
  const double edge = 1 - (0.45 + held * (kContact - 0.45)) * smooth(0.85, 1, u);
  const double walls = smooth(0.35, 0.9, v) * smooth(-0.2, 0.25, u), dense = hung ? wall_share(u, v) : 0;
  return {to_byte(edge * wall), 0, 0, to_byte(std::max({0.22 * rim, 0.9 * walls, dense}))};
}

}  // namespace trocar::view
