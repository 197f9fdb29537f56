#include <algorithm>
#include <cmath>

#include <trocar/view/fimbria.hpp>

namespace trocar::view {
namespace {

constexpr double kPi = 3.14159265358979;
constexpr int kSides = 16, kRings = 18;
constexpr double kThick = 0.00042;  // [m] half a petal's thickness at its root
constexpr double kPleat = 0.00022;  // [m] folds that run along it
constexpr double kRuffle = 0.0007;  // [m] its edges rise and fall

/// One finger: where it grows from, which way, how it curls.
struct Finger {
  double angle, along, out;  ///< root on the rim [rad, rim radii along and across]
  double length, width;      ///< [m]
  double lean;               ///< from the tube's direction outwards at the root [rad]
  double curl;               ///< further outwards over its length [rad]
  double sway;               ///< sideways [rad]
  int seed;
};

struct Spine {
  Vec3d point, along, across, flat;  ///< flat = normal of the petal
};

/// Rings stand closer towards the tip, which is round.
double along_finger(int ring) { return std::sin(0.5 * kPi * ring / (kRings - 1)); }

/// Width over length: broad at the root, where petals touch, widest before the middle, then a frilled, tapering end.
double leaf(double u, int seed) {
  const double body = smooth(-0.3, 0.25, u) * 0.85 + 0.5 * std::sin(0.9 * kPi * std::min(u + 0.12, 1.0)) - 0.1 * u;
  const double tip = std::sqrt(std::max(0.0, 1 - std::pow(std::max(0.0, (u - 0.66) / 0.34), 2)));
  const double lobes = 1 + 0.14 * std::sin(11 * u + 6.3 * varied(seed, 1)) + 0.12 * std::sin(23 * u + seed);
  return body * tip * lobes;
}

std::vector<Spine> spine_of(const Finger& f, double radius) {
  std::vector<Spine> spine;
  const Vec3d out{0, std::cos(f.angle), std::sin(f.angle)}, around{0, -std::sin(f.angle), std::cos(f.angle)};
  Vec3d p = Vec3d{f.along * radius, 0, 0} + f.out * radius * out;
  for (int i = 0; i < kRings; ++i) {
    const double u = along_finger(i);
    const double lean = f.lean + f.curl * u * (0.4 + 0.6 * u) + 0.1 * std::sin(5 * u + f.seed);
    const double sway = f.sway * u;
    Vec3d t = std::cos(lean) * Vec3d{1, 0, 0} + std::sin(lean) * out;
    t = std::cos(sway) * t + std::sin(sway) * around;
    const Vec3d across = normalised(around - dot(around, t) * t);
    spine.push_back({p, t, across, cross(t, across)});
    if (i + 1 < kRings) p += (f.length * (along_finger(i + 1) - u)) * t;
  }
  return spine;
}

void add_finger(MeshBuffer& b, const Finger& f, double radius) {
  const std::vector<Spine> spine = spine_of(f, radius);
  std::uint32_t last = 0;
  for (int i = 0; i < kRings; ++i) {
    const double u = along_finger(i);
    const Spine& s = spine[std::size_t(i)];
    const bool end = i == 0 || i == kRings - 1;
    const Paint paint{to_byte(0.5 + 0.5 * smooth(0, 0.55, u)), 0, 0, to_byte(0.9 - 0.3 * u - 0.3 * varied(f.seed, 9))};
    if (end) {
      const std::uint32_t pole = b.add(vec_cast<float>(s.point), paint);
      if (i > 0) join_pole(b, last, kSides, pole, true);
      continue;
    }
    const double half = 0.5 * f.width * leaf(u, f.seed), thick = kThick * (1.2 - 0.6 * u);
    const std::uint32_t row = b.size();
    for (int k = 0; k < kSides; ++k) {
      const double a = 2 * kPi * k / kSides, c = std::cos(a), sn = std::sin(a);
      // Ruffled: the edges rise and fall along the finger, in turn on either side.
      const double ruffle = kRuffle * (0.35 + 1.4 * u * (1 - u)) * c * c *
                            std::sin(17 * u + (c > 0 ? 0.0 : 2.1) + 6.3 * varied(f.seed, 2));
      const double cupped = (0.9 * varied(f.seed, 12) - 0.6) * half * c * c +
                            kPleat * std::sin(7 * c + f.seed + 3 * u) * smooth(0, 0.3, u);  // folds along it
      const Vec3d p = s.point + (half * c) * s.across + (thick * sn + ruffle + cupped) * s.flat;
      Paint edge = paint;  // thin edges are paler than the crest
      edge.tint = std::uint8_t(paint.tint * (1 - 0.8 * c * c));
      b.add(vec_cast<float>(p), edge);
    }
    if (i == 1)
      join_pole(b, row, kSides, row - 1, false);
    else
      join_rows(b, last, row, kSides, true);
    last = row;
  }
}

}  // namespace

namespace {

/// One whorl of fingers.
struct Whorl {
  int count;
  double along, out;     ///< roots [rim radii]
  double length, width;  ///< [rim radii]
  double lean, curl;     ///< [rad]
};

}  // namespace

MeshBuffer fimbriae(double radius, int seed) {
  // Around an opening that stays free: the outer ones fall back over the rim, the inner ones line the funnel.
  static const Whorl whorls[] = {{17, -0.1, 0.88, 1.2, 0.4, 1.1, 1.2},
                                 {17, -0.16, 0.78, 1.4, 0.36, 0.75, 0.9},
                                 {12, -0.3, 0.6, 1.0, 0.32, 0.45, 0.6}};
  MeshBuffer b;
  int k = 1000 * seed;
  for (const Whorl& w : whorls)
    for (int i = 0; i < w.count; ++i, ++k) {
      Finger f;
      f.angle = 2 * kPi * (i + 0.7 * (varied(k, 3) - 0.5)) / w.count;
      f.along = w.along + 0.08 * (varied(k, 10) - 0.5);
      f.out = w.out * (1 - 0.08 * varied(k, 11));
      f.length = radius * w.length * (0.62 + 0.45 * varied(k, 4) + (i == 0 ? 0.3 : 0.0));  // one reaches for the ovary
      f.width = radius * w.width * (0.75 + 0.6 * varied(k, 5));
      f.lean = w.lean + 0.35 * (varied(k, 6) - 0.5);
      f.curl = w.curl * (0.3 + 1.1 * varied(k, 7));
      f.sway = 1.3 * (varied(k, 8) - 0.5);
      f.seed = k;
      add_finger(b, f, radius);
    }
  return b;
}

double bell_flare(double before) {
  const double u = std::clamp(1 - before / kBellLength, 0.0, 1.0);
  return 1 + (kBellFlare - 1) * u * u * (0.55 + 0.45 * u);
}

const std::vector<FunnelRow>& funnel() {
  static const std::vector<FunnelRow> rows{{-0.03, 0.93, 0.8},  {-0.16, 0.74, 0.62}, {-0.34, 0.52, 0.42},
                                           {-0.52, 0.34, 0.25}, {-0.66, 0.2, 0.12},  {-0.74, 0, 0.05}};
  return rows;
}

}  // namespace trocar::view
