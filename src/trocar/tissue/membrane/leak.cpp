#include <algorithm>
#include <cmath>

#include <trocar/tissue/membrane/leak.hpp>

namespace trocar::tissue {
namespace {

constexpr double kContraction = 0.61;  // of a jet through a sharp edge: textbooks
constexpr double kSlit = 1e-4;         // [m] lips that lie together leave this much open.  Our choice
constexpr double kPicolitre = 1e-15;   // [m^3]

struct Hole {
  double area = 0;
  Vec3d middle, normal;
};

/// Half of the cross product of two sides.
Vec3d area_of(Vec3d a, Vec3d b, Vec3d c) noexcept { return 0.5 * cross(b - a, c - a); }

Hole hole_of(const MembraneModel& m, std::span<const std::uint8_t> parted, const MembraneState& s) noexcept {
  Hole hole;
  for (std::size_t t = 0; t < m.triangles.size(); ++t) {
    if (!parted[t]) continue;
    Vec3d x[3], drawn[3];
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = position(m.network, s.network, m.triangles[t][k]);
      drawn[k] = m.network.rest[std::size_t(m.triangles[t][k])];
    }
    const Vec3d now = area_of(x[0], x[1], x[2]);
    const double before = length(area_of(drawn[0], drawn[1], drawn[2]));
    const double open = std::max(length(now) - before, kSlit * std::sqrt(2 * before));
    hole.area += open;
    hole.middle += (open / 3) * (x[0] + x[1] + x[2]);
    hole.normal += now;
  }
  if (hole.area > 0) hole.middle = hole.middle / hole.area;
  hole.normal = normalised(hole.normal, {0, 0, 1});
  return hole;
}

/// Over that of the surroundings [Pa].
double pressure_at(const Hole& hole, const MembraneModel& m, const MembraneWork& w, const MembraneState& s) noexcept {
  const Vec3d g = m.network.gravity;
  const double full = s.enclosure.left * m.enclosure.volume / s.enclosure.volume;
  if (full >= 1 || m.enclosure.kind != Enclosure::liquid)
    return s.enclosure.pressure +
           m.enclosure.density * dot(hole.middle - enclosed_volume(m.triangles, w.place, {}).centre, g);
  double top = dot(w.place[0], g), bottom = top;
  for (const Vec3d& x : w.place) top = std::min(top, dot(x, g)), bottom = std::max(bottom, dot(x, g));
  return m.enclosure.density * (dot(hole.middle, g) - (bottom - full * (bottom - top)));
}

/// No more than half of what would take all pressure away at once, and not more than there is [m^3].
double bounded(double out, double pressure, const Enclosure& e, const EnclosureState& s) noexcept {
  const double fall = pressure_at(e, s.volume, s.left).fall;
  if (fall > 0 && s.pressure > 0) out = std::min(out, 0.5 * pressure / fall);
  return std::min(out, s.left * e.volume);
}

Leak run_out(const Hole& hole, const MembraneModel& m, const MembraneWork& w, MembraneState& s) noexcept {
  Leak out{hole.area, hole.middle, hole.normal, 0};
  const double pressure = pressure_at(hole, m, w, s);
  if (!(pressure > 0) || !(hole.area > 0)) return out;
  const double flow = kContraction * hole.area * std::sqrt(2 * pressure / m.enclosure.density);
  out.picolitres = std::int64_t(bounded(flow * m.tick, pressure, m.enclosure, s.enclosure) / kPicolitre);
  take_out(m, kPicolitre * double(out.picolitres), s);
  return out;
}

}  // namespace

void take_out(const MembraneModel& m, double volume, MembraneState& s) noexcept {
  s.enclosure.left = std::max(s.enclosure.left - volume / m.enclosure.volume, 0.0);
}

Leak leak_through(const MembraneModel& m, double area, Vec3d place, Vec3d direction, const MembraneWork& w,
                  MembraneState& s) noexcept {
  if (!(area > 0) || !(m.enclosure.density > 0)) return {};
  return run_out({area, place, direction}, m, w, s);
}

Leak leak(const MembraneModel& m, std::span<const std::uint8_t> parted, const MembraneWork& w,
          MembraneState& s) noexcept {
  if (s.enclosure.leaking == 0 || !(m.enclosure.density > 0)) return {};
  return run_out(hole_of(m, parted, s), m, w, s);
}

}  // namespace trocar::tissue
