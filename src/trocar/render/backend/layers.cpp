#include <algorithm>
#include <cmath>
#include <limits>

#include <trocar/render/backend/layers.hpp>
#include <trocar/render/backend/packing.hpp>

namespace trocar::render {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// Fills pixel `to` from texel (i, j).
void take(const RawLayers& raw, int i, int j, const Projection& now, const Projection& before, Layers& out,
          std::size_t to) {
  const float* surface = &raw.surface[4 * (std::size_t(j) * raw.width + i)];
  const float* places = &raw.places[4 * (std::size_t(j) * raw.width + i)];
  if (surface[3] == 0) return;
  out.part[to] = std::uint16_t(std::lround(std::fabs(surface[3])) - 1);
  out.normal[to] = {surface[0], -surface[1], -surface[2]};
  out.depth[to] = places[0];
  if (surface[3] < 0) return;
  // From the texel's own middle, so that what rests has no flow.
  const std::array<float, 2> here =
      now.bent(float(i) + 0.5f - 0.5f * float(raw.width), 0.5f * float(raw.height) - float(j) - 0.5f);
  const std::array<float, 2> there = before.seen_at({places[1], places[2], places[3]});
  out.flow[to] = {there[0] - here[0], there[1] - here[1]};
}

}  // namespace

Layers Layers::nothing(int width, int height) {
  const std::size_t n = std::size_t(width) * std::size_t(height);
  Layers out{width, height, {}, {}, {}, {}};
  out.depth.assign(n, kUnknown);
  out.normal.assign(n, {kUnknown, kUnknown, kUnknown});
  out.part.assign(n, 0);
  out.flow.assign(n, {kUnknown, kUnknown});
  return out;
}

Projection::Projection(const Camera& camera, const EndoscopeLook& look, int width, int height)
    : shift(camera.shift), barrel(look.barrel), circle(look.mask) {
  const Layout layout(Target::off_screen(width, height), look, 1);
  centre_x = 0.5f * float(width) - 0.5f;
  centre_y = 0.5f * float(height) - 0.5f;
  focal = 0.5f * float(height) / std::tan(camera.vertical_fov / 2);
  radius = layout.radius;
}

std::array<float, 2> Projection::straightened(float x, float y) const {
  const float r2 = (x * x + y * y) / (radius * radius), scale = (1 + barrel * r2) / (1 + barrel);
  return {x * scale, y * scale};
}

std::array<float, 2> Projection::bent(float u, float v) const {
  // r (1 + k r^2) = (1 + k) s by Newton's method; it converges from s as the left side grows and bends one way.
  const float s = std::sqrt(u * u + v * v) / radius;
  if (!(s > 0)) return {u, v};
  float r = s;
  constexpr int kSteps = 8;
  for (int i = 0; i < kSteps; ++i) r -= (r * (1 + barrel * r * r) - (1 + barrel) * s) / (1 + 3 * barrel * r * r);
  return {u * r / s, v * r / s};
}

std::array<float, 2> Projection::seen_at(Vec3f eye) const {
  if (!(eye.z < 0)) return {kUnknown, kUnknown};
  return bent(focal * (eye.x / -eye.z - shift), -focal * eye.y / -eye.z);
}

Layers through_lens(const RawLayers& raw, const Projection& now, const Projection& before, int width, int height) {
  Layers out = Layers::nothing(width, height);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const float x = float(column) - now.centre_x, y = float(row) - now.centre_y;
      if (now.circle && x * x + y * y > now.radius * now.radius) continue;
      const std::array<float, 2> at = now.straightened(x, y);
      const int i = int(std::floor(at[0] + 0.5f * float(raw.width)));
      const int j = int(std::floor(0.5f * float(raw.height) - at[1]));
      if (i < 0 || j < 0 || i >= raw.width || j >= raw.height) continue;
      take(raw, i, j, now, before, out, std::size_t(row) * std::size_t(width) + std::size_t(column));
    }
  return out;
}

}  // namespace trocar::render
