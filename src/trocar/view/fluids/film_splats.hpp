// What drawings of fluids share: a mix's shares and how dark it is, and a film's volume as a splat.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include <trocar/fluids/fluids.hpp>
#include <trocar/fluids/optics.hpp>
#include <trocar/render/frame/liquid.hpp>
#include <trocar/view/fluids/wound.hpp>

namespace trocar::view {

template <class Volume>
std::array<float, 3> shares_of(const Volume& v) {
  const double all = double(std::max<std::int64_t>(v.total(), 1));
  return {float(double(v.blood) / all), float(double(v.saline) / all), float(double(v.bile) / all)};
}

/// How much darker than fresh arterial blood, 0 to 1: what comes from veins, and what clots; next to none of it does
/// not show. Venous blood half-way to a clot, as its colour is (our choice).
float darkness(float now, fluids::Blood blood, const std::array<float, 3>& share);

inline Vec3f at(const fluids::DropletState& d, std::int32_t i) {
  const auto k = std::size_t(i);
  return {d.x[k], d.y[k], d.z[k]};
}
inline Vec3f speed(const fluids::DropletState& d, std::int32_t i) {
  const auto k = std::size_t(i);
  return {d.vx[k], d.vy[k], d.vz[k]};
}

/// -1 .. 1, a drop's own.
float own(std::uint32_t id, int which);

/// Of a stain whose blobs add up to `volume` [m^3]: a splat's film is its height times (1 - r^2)^2, r in reaches
/// (splat.frag), which makes pi/3 of a round end's area and 16/15 of a reach of the rest's.
float film_height(float volume, float radius, float tail);

/// `volume` [m^3] of film as a rivulet left it: downhill through the place, as wide as there is enough for; round
/// where it is level. @param own 0..1, for variety
render::Splat stain(const FilmPlace& place, float volume, float own, Vec3f down);

/// What runs down gathers in rivulets: how thick it is at a place, 1 in the mean or so.
float rivulets(const FilmPlace& place, Vec3f down);

}  // namespace trocar::view
