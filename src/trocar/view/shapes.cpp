#include <cmath>

#include <trocar/view/shapes.hpp>

namespace trocar::view {
namespace {

constexpr double kTwoPi = 6.28318530717959;

/// Points around a super-ellipse, from round (2 corners shaped 1) to a box whose edges are slightly broken.
std::vector<Vec3d> rim(double roundness, int count) {
  std::vector<Vec3d> points;
  const double power = 0.12 + 0.88 * roundness;
  for (int i = 0; i < count; ++i) {
    const double a = kTwoPi * (i + 0.5) / count, c = std::cos(a), s = std::sin(a);
    points.push_back(
        {std::copysign(std::pow(std::fabs(c), power), c), std::copysign(std::pow(std::fabs(s), power), s), 0});
  }
  return points;
}

std::uint32_t add_cap(MeshBuffer& b, const BarSection& s, const std::vector<Vec3d>& shape, bool beyond) {
  const std::uint32_t row = b.size(), count = std::uint32_t(shape.size());
  for (const Vec3d& q : shape) b.add(vec_cast<float>(s.centre + q.x * s.wide + q.y * s.deep), s.paint);
  join_pole(b, row, count, b.add(vec_cast<float>(s.centre), s.paint), beyond);
  return row;
}

}  // namespace

MeshBuffer turned(const std::vector<TurnPoint>& outline, int sides) {
  MeshBuffer b;
  const auto count = std::uint32_t(sides);
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const TurnPoint& p = outline[i];
    const std::uint32_t first = b.size();
    const bool pole = p.radius == 0;
    for (int k = 0; k < (pole ? 1 : sides); ++k) {
      const double a = kTwoPi * k / sides;
      b.add(vec_cast<float>(Vec3d{p.radius * std::cos(a), p.radius * std::sin(a), p.z}), p.paint);
    }
    const bool edge = i > 0 && outline[i - 1].z == p.z && outline[i - 1].radius == p.radius;
    if (i > 0 && !edge) {
      if (pole)
        join_pole(b, before, count, first, true);
      else if (outline[i - 1].radius == 0)
        join_pole(b, first, count, before, false);
      else
        join_rows(b, before, first, count, true);
    }
    before = first;
  }
  return b;
}

MeshBuffer bar(const std::vector<BarSection>& sections, double roundness) {
  MeshBuffer b;
  const std::vector<Vec3d> shape = rim(roundness, 16);
  const auto count = std::uint32_t(shape.size());
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const BarSection& s = sections[i];
    const std::uint32_t row = b.size();
    for (const Vec3d& q : shape) b.add(vec_cast<float>(s.centre + q.x * s.wide + q.y * s.deep), s.paint);
    if (i > 0) join_rows(b, before, row, count, true);
    before = row;
  }
  add_cap(b, sections.front(), shape, false);
  add_cap(b, sections.back(), shape, true);
  return b;
}

MeshBuffer plate(const Outline& outer, const Outline& inner, const Height& low, const Height& high, int around,
                 int across, const std::function<Paint(bool inside, double y, double z)>& paint) {
  MeshBuffer b;
  const auto count = std::uint32_t(around);
  const auto add_row = [&](double t, const Height& height, bool inside) {
    const std::uint32_t row = b.size();
    for (int i = 0; i < around; ++i) {
      const double u = double(i) / around;
      const Vec3d o = outer(u), n = inner(u), p = o + t * (n - o);
      b.add(vec_cast<float>(Vec3d{height(p.y, p.z), p.y, p.z}), paint(inside, p.y, p.z));
    }
    return row;
  };
  const auto face = [&](const Height& height, bool inside) {
    std::uint32_t before = add_row(0, height, inside);
    for (int k = 1; k <= across; ++k) {
      const std::uint32_t row = add_row(double(k) / across, height, inside);
      if (inside)
        join_rows(b, row, before, count, true);
      else
        join_rows(b, before, row, count, true);
      before = row;
    }
  };
  face(high, false);
  face(low, true);
  const std::uint32_t out_low = add_row(0, low, false), out_high = add_row(0, high, false);
  join_rows(b, out_low, out_high, count, true);
  const std::uint32_t in_low = add_row(1, low, false), in_high = add_row(1, high, false);
  join_rows(b, in_high, in_low, count, true);
  return b;
}

}  // namespace trocar::view
