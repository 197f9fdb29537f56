#include <cmath>

#include <trocar/view/base/mesh_buffer.hpp>
#include <trocar/view/base/relief.hpp>
#include <trocar/view/fluids/film_splats.hpp>

namespace trocar::view {
namespace {

// Our choice, all of them: from the look of rivulets in endoscopic films.
constexpr float kRunThickness = 20e-6f;  // [m] of what a running drop leaves; where there is less it covers less
constexpr float kWidestRun = 0.0032f;    // [m] ... and how wide: what lies beyond is drawn out downhill
constexpr float kThinnestRun = 0.0008f;  // [m] ... and how narrow
constexpr float kSplatOverlap = 1.5f;    // a rivulet's length within a place over the place's edge: no gaps
constexpr float kWander = 0.0009f;       // [m]

/// Rivulets do not run straight: how far aside of the steepest way one is at `p` [m].
float wander(Vec3f p, Vec3f down) {
  const float along = dot(p, down), phase = 260 * (p.x + p.y + p.z);
  return kWander * (std::sin(520 * along + phase) + 0.5f * std::sin(1270 * along - 1.7f * phase));
}

}  // namespace

float darkness(float now, fluids::Blood blood, const std::array<float, 3>& share) {
  constexpr float kVenous = 0.6f;
  if (share[0] <= 0.02f) return 0;
  const float brightness = float(fluids::clot_brightness(double(now - blood.born)));
  const float clot = (1 - brightness) / 0.6f;
  return 1 - (1 - clot) * (1 - kVenous * blood.venous);
}

float own(std::uint32_t id, int which) { return 2 * float(varied(int(id & 0xffffff), which)) - 1; }

float film_height(float volume, float radius, float tail) {
  const float reach = render::kSplatReach * radius;
  return volume / (1.0472f * reach * reach + 1.0667f * reach * tail);
}

render::Splat stain(const FilmPlace& place, float volume, float own, Vec3f down) {
  const Vec3f fall = down - dot(down, place.normal) * place.normal;
  const float steep = length(fall), covered = std::min(place.area, volume / kRunThickness);
  const Vec3f along = steep > 1e-3f ? (1 / steep) * fall : Vec3f{0, 0, 0}, across = cross(place.normal, along);
  const float round = std::sqrt(covered), through = std::max(kSplatOverlap * std::sqrt(place.area), round);
  const float far = round + std::min(2 * steep, 1.0f) * (through - round);
  const float width = std::clamp(covered / far * (0.7f + 0.6f * own), kThinnestRun, kWidestRun);
  const Vec3f half = (0.5f * std::max(far - width, 0.0f)) * along;
  render::Splat s;
  s.kind = render::SplatKind::film;
  s.from = place.position - half, s.to = place.position + half;
  s.from += (steep * wander(s.from, down)) * across, s.to += (steep * wander(s.to, down)) * across;
  s.normal = place.normal;
  s.radius = 0.7f * width;
  s.height = film_height(volume, s.radius, length(s.to - s.from));
  return s;
}

float rivulets(const FilmPlace& place, Vec3f down) {
  const Vec3d p = vec_cast<double>(place.position), fall = vec_cast<double>(down);
  const Vec3d across = normalised(cross(vec_cast<double>(place.normal), fall), {1, 0, 0});
  const double a = dot(p, across) + 0.0015 * waves(p, 0.02), b = dot(p, fall);
  return float(std::clamp(0.85 + 1.1 * waves({a, 0.12 * b, 0}, 0.009), 0.04, 2.0));
}

}  // namespace trocar::view
