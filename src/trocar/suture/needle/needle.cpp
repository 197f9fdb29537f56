#include <algorithm>
#include <cmath>

#include <trocar/numerics/mat3.hpp>
#include <trocar/suture/needle/needle.hpp>

namespace trocar::suture {
namespace {

constexpr double kSteel = 7900;          // [kg/m^3]
constexpr double kBeadSpacing = 0.0010;  // [m]
constexpr int kSlices = 256;             // of the wire, for its moments of inertia

}  // namespace

Vec3d NeedleModel::place(double s) const noexcept {
  if (straight()) return {0, 0.5 * length - s, 0};
  const double angle = turn * (0.5 - s / length);
  return centre + radius * Vec3d{portable::cos(angle), portable::sin(angle), 0};
}

Vec3d NeedleModel::along(double s) const noexcept {
  if (straight()) return {0, 1, 0};
  const double angle = turn * (0.5 - s / length);
  return {-portable::sin(angle), portable::cos(angle), 0};
}

double NeedleModel::nearest(Vec3d own) const noexcept {
  if (straight()) return 0.5 * length - own.y;
  const Vec3d off = own - centre;
  return length * (0.5 - portable::atan2(off.y, off.x) / turn);
}

NeedleModel make_needle(const NeedleKind& kind) {
  NeedleModel m;
  m.length = kind.length;
  m.turn = kind.turn;
  m.wire = kind.wire;
  m.mass = kSteel * portable::pi * 0.25 * kind.wire * kind.wire * kind.length;
  m.beads = std::clamp(int(std::ceil(kind.length / kBeadSpacing)) + 1, 2, kMostBeads);
  if (kind.turn > 0) {
    m.radius = kind.length / kind.turn;
    m.centre = {-m.radius * portable::sin(0.5 * kind.turn) / (0.5 * kind.turn), 0, 0};
  }
  const double each = m.mass / kSlices, disc = each * kind.wire * kind.wire / 16;
  for (int i = 0; i < kSlices; ++i) {
    const double s = kind.length * (i + 0.5) / kSlices;
    const Vec3d p = m.place(s), t = m.along(s);
    const double r2 = dot(p, p);
    m.inertia = m.inertia + each * (Mat3d{{{r2, 0, 0}, {0, r2, 0}, {0, 0, r2}}} - outer(p, p)) +
                disc * (Mat3d::identity() + outer(t, t));
  }
  return m;
}

}  // namespace trocar::suture
