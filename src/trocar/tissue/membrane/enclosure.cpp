#include <algorithm>

#include <trocar/core/field_hash.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/tissue/membrane/enclosure.hpp>

namespace trocar::tissue {

PressureLaw pressure_at(const Enclosure& e, double volume, double left) noexcept {
  const double v = std::max(volume, 0.05 * e.volume);
  if (e.kind == Enclosure::liquid) return {e.pressure + e.bulk * (left * e.volume - v) / e.volume, e.bulk / e.volume};
  if (e.kind == Enclosure::gas) {
    const double inside = (e.pressure + kAtmosphere) * left * e.volume / v;
    return {inside - kAtmosphere, inside / v};
  }
  return {e.kind == Enclosure::constant ? left * e.pressure : 0, 0};
}

double pressure_energy(const Enclosure& e, double volume) noexcept {
  const double more = volume - e.volume;
  if (e.kind == Enclosure::constant) return -e.pressure * more;
  if (e.kind == Enclosure::liquid) return -e.pressure * more + 0.5 * e.bulk * more * more / e.volume;
  if (e.kind == Enclosure::gas)
    return kAtmosphere * more - (e.pressure + kAtmosphere) * e.volume * portable::log(volume / e.volume);
  return 0;
}

EnclosedVolume enclosed_volume(std::span<const std::array<int, 3>> triangles, std::span<const Vec3d> x,
                               std::span<Vec3d> gradient, Vec3d heavy, std::span<Vec3d> weight) noexcept {
  for (Vec3d& each : gradient) each = {};
  for (Vec3d& each : weight) each = {};
  EnclosedVolume sum;
  if (x.empty()) return sum;
  const Vec3d o = x[0];  // near the surface, so that few digits cancel
  for (const auto& t : triangles) {
    const Vec3d a = x[std::size_t(t[0])] - o, b = x[std::size_t(t[1])] - o, c = x[std::size_t(t[2])] - o;
    const Vec3d third = (1.0 / 6) * cross(b - a, c - a), thrice = a + b + c;
    const double part = dot(a, third);
    sum.volume += part;
    sum.centre += (0.25 * part) * thrice;
    if (!gradient.empty())
      for (int node : t) gradient[std::size_t(node)] += third;
    if (weight.empty()) continue;
    const Vec3d pressed = ((1.0 / 3) * dot(heavy, thrice)) * third;  // as deep below x[0]
    for (int node : t) weight[std::size_t(node)] += pressed;
  }
  const Vec3d from_o = sum.volume > 0 ? sum.centre / sum.volume : Vec3d{};
  for (std::size_t i = 0; i < weight.size(); ++i) weight[i] -= dot(heavy, from_o) * gradient[i];
  sum.centre = o + from_o;
  return sum;
}

void press_step(const Enclosure& e, double volume, double rate, double give, double dt, EnclosureState& s) noexcept {
  const double others = volume - s.expected;
  const PressureLaw now = pressure_at(e, volume, s.left);
  s.pressure = (now.pressure - now.fall * (dt * rate + others)) / (1 + now.fall * dt * dt * give);
  if (s.leaking) s.pressure = std::max(s.pressure, 0.0);  // below it gas comes in, and nothing pulls on the wall
  s.volume = volume;
  s.expected = volume + dt * (rate + dt * give * s.pressure);
}

void add_to_hash(core::Hasher& h, const Enclosure& e) noexcept { core::add_fields(h, e); }

}  // namespace trocar::tissue
