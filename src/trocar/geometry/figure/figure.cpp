#include <algorithm>
#include <cmath>

#include <trocar/geometry/figure/figure.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::geometry {
namespace {

constexpr double kPatternStature = 1.70, kPatternBreadth = 0.326, kPatternDepth = 0.205, kPatternRise = 0.030;

/// Of the pattern [m]: y, half breadth, front, where it is broadest, back.
constexpr double kPattern[][5] = {{-0.240, 0.120, -0.088, -0.128, -0.185}, {-0.205, 0.168, -0.052, -0.122, -0.210},
                                  {-0.120, 0.178, -0.010, -0.112, -0.215}, {-0.050, 0.170, -0.001, -0.098, -0.209},
                                  {0.000, 0.163, 0.000, -0.090, -0.205},   {0.060, 0.160, 0.000, -0.088, -0.205},
                                  {0.125, 0.160, 0.000, -0.088, -0.208},   {0.180, 0.163, -0.009, -0.092, -0.212},
                                  {0.250, 0.168, -0.022, -0.098, -0.215},  {0.320, 0.175, -0.036, -0.108, -0.215},
                                  {0.375, 0.184, -0.058, -0.122, -0.208},  {0.415, 0.140, -0.082, -0.130, -0.192},
                                  {0.450, 0.070, -0.098, -0.132, -0.180}};

constexpr double kAbdomenLow = -0.20, kAbdomenHigh = 0.26;  // between which gas lifts the wall [m]

double eased(double t) noexcept {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}
/// 1 at the umbilicus, 0 beyond the abdomen.
double lifted(double y) noexcept { return y < 0 ? eased(1 - y / kAbdomenLow) : eased(1 - y / kAbdomenHigh); }

double mixed(double a, double b, double c, double d, double t) noexcept {  // Catmull-Rom from b to c
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}
double square(double x) noexcept { return x * x; }

}  // namespace

double distance(const Limb& limb, Vec3d p) noexcept {
  const Vec3d along = limb.b - limb.a;
  const double whole = dot(along, along);
  const double t = whole > 0 ? std::clamp(dot(p - limb.a, along) / whole, 0.0, 1.0) : 0;
  return length(p - limb.a - t * along) - (limb.radius_a + t * (limb.radius_b - limb.radius_a));
}

Figure::Figure(const FigureSizes& sizes) : m_sizes(sizes) {
  const double sy = sizes.stature / kPatternStature, sx = sizes.breadth / kPatternBreadth;
  const double deep = sizes.depth - (sizes.rise - kPatternRise);  // of a pattern with the pattern's gas
  const double sz = deep / kPatternDepth, more = sizes.rise - kPatternRise;
  for (const auto& p : kPattern) {
    Row row{sy * p[0], {sx * p[1], sz * p[2] + more * (lifted(p[0]) - 1), sz * p[3] - more, sz * p[4] - more}};
    row.s.middle = std::min(row.s.middle, row.s.front - 0.01);
    m_back = std::min(m_back, row.s.back);
    m_rows.push_back(row);
  }
  const auto at = [&](double x, double y, double z) { return Vec3d{sx * x, sy * y, sz * z - more}; };
  const double s = sy;
  const auto limb = [&](Vec3d a, Vec3d b, double ra, double rb) { m_limbs.push_back({a, b, s * ra, s * rb}); };
  limb(at(0, 0.440, -0.140), at(0, 0.520, -0.135), 0.058, 0.055);
  limb(at(0, 0.555, -0.128), at(0, 0.612, -0.112), 0.083, 0.078);
  for (const double side : {-1.0, 1.0}) {
    const Vec3d shoulder = at(side * 0.172, 0.365, -0.135);
    Vec3d elbow = at(side * 0.212, 0.085, -0.160), wrist = at(side * 0.208, -0.150, -0.165),
          hand = at(side * 0.205, -0.240, -0.170);
    if (sizes.arms_out) {
      elbow = at(side * 0.420, 0.330, -0.150);
      wrist = at(side * 0.665, 0.300, -0.150);
      hand = at(side * 0.755, 0.292, -0.150);
    }
    limb(shoulder, elbow, 0.052, 0.042);
    limb(elbow, wrist, 0.041, 0.029);
    limb(wrist, hand, 0.030, 0.026);
    const double half = sizes.legs_apart / 2;
    const double sine = portable::sin(half), cosine = portable::cos(half);
    const Vec3d hip = at(side * 0.092, -0.185, -0.130);
    const auto leg = [&](double x, double y, double z) {  // from the hip, turned outwards
      const Vec3d p = at(side * x, y, z) - hip;
      return hip + Vec3d{p.x * cosine - side * sine * p.y, p.y * cosine + side * sine * p.x, p.z};
    };
    const Vec3d knee = leg(0.098, -0.600, -0.128), ankle = leg(0.096, -0.985, -0.155),
                toes = leg(0.108, -1.015, -0.055);
    limb(hip, knee, 0.086, 0.060);
    limb(knee, ankle, 0.058, 0.038);
    limb(ankle, toes, 0.040, 0.030);
  }
}

double Figure::crown() const noexcept { return m_limbs[1].b.y + m_limbs[1].radius_b; }
double Figure::soles() const noexcept {
  double least = 0;
  for (const Limb& l : m_limbs) least = std::min(least, std::min(l.a.y - l.radius_a, l.b.y - l.radius_b));
  return least;
}

Figure::Section Figure::section(double y) const noexcept {
  if (y <= m_rows.front().y) return m_rows.front().s;
  if (y >= m_rows.back().y) return m_rows.back().s;
  std::size_t k = 1;
  while (k + 1 < m_rows.size() && m_rows[k].y < y) ++k;
  const std::size_t last = m_rows.size() - 1;
  const Row &a = m_rows[k >= 2 ? k - 2 : 0], &b = m_rows[k - 1], &c = m_rows[k], &d = m_rows[std::min(k + 1, last)];
  const double t = (y - b.y) / (c.y - b.y);
  Section s{mixed(a.s.half, b.s.half, c.s.half, d.s.half, t), mixed(a.s.front, b.s.front, c.s.front, d.s.front, t),
            mixed(a.s.middle, b.s.middle, c.s.middle, d.s.middle, t), mixed(a.s.back, b.s.back, c.s.back, d.s.back, t)};
  return s;
}

double Figure::front(double x, double y) const noexcept {
  const Section s = section(y);
  const double share = std::min(1.0, square(x / s.half));
  return s.middle + (s.front - s.middle) * std::sqrt(1 - share);
}

Vec3d Figure::normal(double x, double y) const noexcept {
  constexpr double kStep = 1e-4;
  const Section s = section(y);
  const double edge = 0.985 * s.half, inner = std::clamp(x, -edge, edge);
  const double dx = (front(inner + kStep, y) - front(inner - kStep, y)) / (2 * kStep);
  const double dy = (front(inner, y + kStep) - front(inner, y - kStep)) / (2 * kStep);
  const Vec3d n{-dx, -dy, 1};
  return n / length(n);
}

double Figure::trunk_distance(Vec3d p) const noexcept {
  const double beyond = std::max({0.0, low() - p.y, p.y - high()});
  const Section s = section(p.y);
  const bool before = p.z >= s.middle;
  const double depth = before ? s.front - s.middle : s.middle - s.back;
  const double u = p.x / s.half, w = (p.z - s.middle) / depth;
  // r = 1 on the skin: in front an ellipse, behind with fourth powers; (r - 1) / |grad r| is the distance to first
  // order
  double r = 0, gu = 0, gw = 0;
  if (before) {
    r = std::sqrt(u * u + w * w);
    if (r > 0) gu = u / r, gw = w / r;
  } else {
    r = std::sqrt(std::sqrt(square(u * u) + square(w * w)));
    if (r > 0) gu = u * u * u / (r * r * r), gw = w * w * w / (r * r * r);
  }
  const double slope = std::sqrt(square(gu / s.half) + square(gw / depth));
  const double off = slope > 0 ? (r - 1) / slope : -std::min(s.half, depth);
  if (beyond == 0) return off;
  return off > 0 ? std::sqrt(off * off + beyond * beyond) : beyond;
}

double Figure::distance(Vec3d p) const noexcept {
  double least = trunk_distance(p);
  for (const Limb& l : m_limbs) least = std::min(least, geometry::distance(l, p));
  return least;
}

double Figure::distance(Vec3d a, Vec3d b, double radius) const noexcept {
  constexpr double kEvery = 0.005;
  const double whole = length(b - a);
  double least = 1e9;
  for (double s = 0;;) {
    const double off = distance(a + (whole > 0 ? s / whole : 0) * (b - a));
    least = std::min(least, off);
    if (s >= whole) break;
    s = std::min(whole, s + std::max(kEvery, 0.5 * off));  // far away nothing is missed by longer steps
  }
  return least - radius;
}

}  // namespace trocar::geometry
