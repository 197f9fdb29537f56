#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/view/painted/solids.hpp>

namespace trocar::view::painted {
namespace {

struct LatheRing {
  double along = 0, radius = 0;
};

/// Rings along an axis; radius 0 is a pole.
void add_rings(MeshBuffer& b, Vec3d from, Vec3d axis, const std::vector<LatheRing>& rings, Colour colour, int sides) {
  const auto [u, v] = across(axis);
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const std::uint32_t first = b.size();
    const bool pole = rings[i].radius <= 0;
    for (int k = 0; k < (pole ? 1 : sides); ++k) {
      const double a = portable::two_pi * k / sides;
      b.add(vec_cast<float>(from + rings[i].along * axis + rings[i].radius * (std::cos(a) * u + std::sin(a) * v)),
            colour.paint());
    }
    if (i > 0) {
      if (pole)
        join_pole(b, before, std::uint32_t(sides), first, true);
      else if (rings[i - 1].radius <= 0)
        join_pole(b, first, std::uint32_t(sides), before, false);
      else
        join_rows(b, before, first, std::uint32_t(sides), true);
    }
    before = first;
  }
}

}  // namespace

Colour darker(Colour c, double share) {
  const auto f = [&](std::uint8_t x) { return std::uint8_t(std::clamp(x * (1 - share), 0.0, 255.0)); };
  return {f(c.r), f(c.g), f(c.b), c.a};
}
Colour mixed(Colour a, Colour b, double t) {
  t = std::clamp(t, 0.0, 1.0);
  const auto f = [&](std::uint8_t x, std::uint8_t y) { return std::uint8_t(x + t * (double(y) - x) + 0.5); };
  return {f(a.r, b.r), f(a.g, b.g), f(a.b, b.b), f(a.a, b.a)};
}

std::pair<Vec3d, Vec3d> across(Vec3d axis) {
  const Vec3d other = std::fabs(axis.z) < 0.9 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0};
  Vec3d u = cross(other, axis);
  u = u / length(u);
  return {u, cross(axis, u)};
}

void add_rod(MeshBuffer& b, Vec3d from, Vec3d to, double ra, double rb, Colour colour, int sides) {
  const int round = std::max(6, sides / 4);
  const double whole = length(to - from);
  const Vec3d axis = whole > 1e-9 ? (to - from) / whole : Vec3d{0, 0, 1};
  std::vector<LatheRing> rings{{-ra, 0}};
  for (int k = 1; k <= round; ++k) {
    const double a = portable::pi / 2 * k / round;
    rings.push_back({-ra * std::cos(a), ra * std::sin(a)});
  }
  for (int k = 0; k < round; ++k) {
    const double a = portable::pi / 2 * k / round;
    rings.push_back({whole + rb * std::sin(a), rb * std::cos(a)});
  }
  rings.push_back({whole + rb, 0});
  add_rings(b, from, axis, rings, colour, sides);
}

void add_cylinder(MeshBuffer& b, Vec3d from, Vec3d to, double r, Colour colour, int sides) {
  const double whole = length(to - from), e = std::min(0.25 * r, 0.2 * whole);
  const Vec3d axis = whole > 1e-9 ? (to - from) / whole : Vec3d{0, 0, 1};
  // doubled rings keep the faces flat and the edges round
  add_rings(b, from, axis,
            {{0, 0},
             {0, r - e},
             {0, r - e},
             {0.3 * e, r - 0.3 * e},
             {e, r},
             {e, r},
             {whole - e, r},
             {whole - e, r},
             {whole - 0.3 * e, r - 0.3 * e},
             {whole, r - e},
             {whole, r - e},
             {whole, 0}},
            colour, sides);
}

void add_box(MeshBuffer& b, Vec3d middle, const Mat3d& axes, Vec3d half, double bevel, Colour colour) {
  // a rounded rectangle in its x and y, drawn in at both ends of its z
  constexpr int kCorner = 5;
  const double e = std::min({bevel, 0.9 * half.x, 0.9 * half.y, 0.9 * half.z});
  const auto ring = [&](double in, double z) {
    std::vector<Vec3d> points;
    for (int c = 0; c < 4; ++c)
      for (int k = 0; k <= kCorner; ++k) {
        const double a = portable::pi / 2 * (c + double(k) / kCorner);
        const double sx = c == 0 || c == 3 ? 1 : -1, sy = c < 2 ? 1 : -1;
        const double r = std::max(e - in, 1e-6);
        points.push_back(middle +
                         axes * Vec3d{sx * (half.x - e) + r * std::cos(a), sy * (half.y - e) + r * std::sin(a), z});
      }
    return points;
  };
  std::vector<std::vector<Vec3d>> rings;
  for (int k = 0; k <= kCorner; ++k) {
    const double a = portable::pi / 2 * k / kCorner;
    rings.push_back(ring(e * (1 - std::sin(a)), -half.z + e * (1 - std::cos(a))));
  }
  for (int k = kCorner; k >= 0; --k) {
    const double a = portable::pi / 2 * k / kCorner;
    rings.push_back(ring(e * (1 - std::sin(a)), half.z - e * (1 - std::cos(a))));
  }
  add_loft(b, rings, std::vector<Colour>(rings.size(), colour));
}

void add_loft(MeshBuffer& b, const std::vector<std::vector<Vec3d>>& rings, const std::vector<Colour>& colours) {
  if (rings.size() < 2) return;
  const auto count = std::uint32_t(rings[0].size());
  const auto cap = [&](std::size_t i, bool beyond) {
    Vec3d middle;
    const std::uint32_t row = b.size();
    for (const Vec3d& p : rings[i]) {
      b.add(vec_cast<float>(p), colours[i].paint());
      middle += p / double(count);
    }
    join_pole(b, row, count, b.add(vec_cast<float>(middle), colours[i].paint()), beyond);
  };
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const std::uint32_t row = b.size();
    for (const Vec3d& p : rings[i]) b.add(vec_cast<float>(p), colours[i].paint());
    if (i > 0) join_rows(b, before, row, count, true);
    before = row;
  }
  cap(0, false);
  cap(rings.size() - 1, true);
}

}  // namespace trocar::view::painted
