#include <trocar/geometry/curves/frames.hpp>

namespace trocar::geometry {
namespace {

// Unit direction from point i to the next one that differs from it; `fallback` where there is none.
Vec3d direction_after(std::span<const Vec3d> points, std::size_t i, Vec3d fallback) noexcept {
  for (std::size_t j = i + 1; j < points.size(); ++j) {
    const Vec3d d = points[j] - points[i];
    if (dot(d, d) > 0.0) return normalised(d, fallback);
  }
  return fallback;
}

Vec3d tangent_at(std::span<const Vec3d> points, std::size_t i, Vec3d before) noexcept {
  const Vec3d after = direction_after(points, i, before);
  return normalised(before + after, after);  // a line that turns back on itself keeps the new direction
}

}  // namespace

void line_tangents(std::span<const Vec3d> points, std::span<Vec3d> tangents) noexcept {
  Vec3d before = points.empty() ? Vec3d{1, 0, 0} : direction_after(points, 0, {1, 0, 0});
  for (std::size_t i = 0; i < points.size(); ++i) {
    tangents[i] = tangent_at(points, i, before);
    before = direction_after(points, i, before);
  }
}

Frame frame_about(Vec3d tangent, Vec3d wished_normal) noexcept {
  const Vec3d across = wished_normal - dot(wished_normal, tangent) * tangent;
  const bool parallel = !(dot(across, across) > 1e-24 * dot(wished_normal, wished_normal));
  Vec3d normal = parallel ? any_perpendicular(tangent) : normalised(across);
  normal = normalised(normal - dot(normal, tangent) * tangent);  // twice: what the first left over
  return {tangent, normal, cross(tangent, normal)};
}

Frame transported(const Frame& from, Vec3d p, Vec3d q, Vec3d tangent) noexcept {
  // First reflection: in the plane that swaps p and q. Second: in the one that takes the reflected tangent to the new.
  const Vec3d chord = q - p;
  const double chord2 = dot(chord, chord);
  Vec3d normal = from.normal, old_tangent = from.tangent;
  if (chord2 > 0.0) {
    normal -= (2.0 / chord2 * dot(chord, normal)) * chord;
    old_tangent -= (2.0 / chord2 * dot(chord, old_tangent)) * chord;
  }
  const Vec3d step = tangent - old_tangent;
  const double step2 = dot(step, step);
  if (step2 > 0.0) normal -= (2.0 / step2 * dot(step, normal)) * step;
  return frame_about(tangent, normal);  // against drift
}

void transport_frames(std::span<const Vec3d> points, Vec3d first_normal, std::span<Frame> frames) noexcept {
  if (points.empty()) return;
  Vec3d before = direction_after(points, 0, {1, 0, 0});
  frames[0] = frame_about(before, first_normal);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vec3d tangent = tangent_at(points, i, before);
    frames[i] = transported(frames[i - 1], points[i - 1], points[i], tangent);
    before = direction_after(points, i, before);
  }
}

}  // namespace trocar::geometry
