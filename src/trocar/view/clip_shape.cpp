#include <algorithm>
#include <cmath>

#include <trocar/view/clip_shape.hpp>
#include <trocar/view/pinch.hpp>
#include <trocar/view/shapes.hpp>

namespace trocar::view {
namespace {

constexpr double kPi = 3.14159265358979;
constexpr int kGrooves = 5, kLegSteps = 3 * kGrooves, kBendSteps = 6;
constexpr double kGrooveLeft = 0.72;  // of a leg's thickness, in its grooves
constexpr double kBevel = 0.42;       // its edges are broken, its faces flat

/// The middle line of the wire, from the tip of one leg round the bend to the tip of the other.
std::vector<Vec3d> wire(double leg, double gap) {
  const double bow = kClipHalfGap + 0.5 * kClipLegThickness, eye = 1.5 * bow;
  std::vector<Vec3d> half;
  for (int i = 0; i < kLegSteps; ++i) {
    const double u = 1 - double(i) / kLegSteps, z = eye + (leg - eye) * u;
    const double knee = std::min(1.0, u / 0.4);
    half.push_back({bow + 0.5 * gap * knee * (2 - knee), 0, z});
  }
  for (int i = 0; i <= kBendSteps; ++i) {
    const double a = 0.5 * kPi * i / kBendSteps;
    half.push_back({bow * std::cos(a) * (1 + 0.25 * std::sin(2 * a)), 0, eye * (1 - std::sin(a))});
  }
  std::vector<Vec3d> line = half;
  for (std::size_t i = half.size() - 1; i-- > 0;) line.push_back({-half[i].x, 0, half[i].z});
  return line;
}

/// Legs are grooved across on their inner sides, so that tissue does not slip out between them.
bool in_groove(std::size_t i, std::size_t count) {
  const std::size_t from_tip = std::min(i, count - 1 - i);
  return from_tip < std::size_t(kLegSteps) && from_tip % 3 == 2;
}

}  // namespace

MeshBuffer clip_shape(double leg_length, double gap) {
  const std::vector<Vec3d> line = wire(leg_length, gap);
  std::vector<BarSection> sections;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vec3d along = normalised(line[std::min(i + 1, line.size() - 1)] - line[i > 0 ? i - 1 : 0]);
    const Vec3d y{0, 1, 0};
    const double left = in_groove(i, line.size()) ? kGrooveLeft : 1;
    const Vec3d inwards = cross(y, along);  // the wire runs up one leg and down the other
    const double half = 0.5 * kClipLegThickness;
    sections.push_back(
        {line[i] - ((1 - left) * half) * inwards, (left * half) * inwards, (0.5 * kClipLegWidth) * y, {}});
  }
  return bar(sections, kBevel);
}

}  // namespace trocar::view
