#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/view/instruments/shapes.hpp>

namespace trocar::view {
namespace {

/// Points around a super-ellipse, from round (2 corners shaped 1) to a box whose edges are slightly broken.
std::vector<Vec3d> rim(double roundness, int count) {
  std::vector<Vec3d> points;
  const double power = 0.12 + 0.88 * roundness;
  for (int i = 0; i < count; ++i) {
    const double a = portable::two_pi * (i + 0.5) / count, c = std::cos(a), s = std::sin(a);
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
      const double a = portable::two_pi * k / sides;
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
  constexpr double kBevel = 0.09, kSideBevel = 0.16;  // share of the way across and of the height, where an edge turns
  MeshBuffer b;
  const auto count = std::uint32_t(around);
  // Rows go once around the frame's cross-section. Its edges belong to both faces, so that they are worn round.
  const auto go_on = [&](double t, double up, bool inside) {
    const std::uint32_t row = b.size();
    for (int i = 0; i < around; ++i) {
      const double u = double(i) / around;
      const Vec3d o = outer(u), n = inner(u), p = o + t * (n - o);
      const double x = up * high(p.y, p.z) + (1 - up) * low(p.y, p.z);
      b.add(vec_cast<float>(Vec3d{x, p.y, p.z}), paint(inside, p.y, p.z));
    }
    if (row > 0) join_rows(b, row - count, row, count, true);
  };
  std::vector<double> way{0, kBevel};
  for (int k = 1; k < across; ++k) way.push_back(double(k) / across);
  way.insert(way.end(), {1 - kBevel, 1});
  for (const double t : way) go_on(t, 1, false);
  for (const double up : {1 - kSideBevel, kSideBevel}) go_on(1, up, false);
  for (std::size_t k = way.size(); k-- > 0;) go_on(way[k], 0, k > 0 && k + 1 < way.size());
  for (const double up : {kSideBevel, 1 - kSideBevel}) go_on(0, up, false);
  join_rows(b, b.size() - count, 0, count, true);
  return b;
}

}  // namespace trocar::view
