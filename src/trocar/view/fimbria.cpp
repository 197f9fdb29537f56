#include <algorithm>
#include <array>
#include <cmath>

#include <trocar/view/fimbria.hpp>

namespace trocar::view {
namespace {

constexpr double kPi = 3.14159265358979;
constexpr int kRings = 18;          // along a leaf
constexpr double kWall = 0.0002;    // [m] half the thickness of the rim's wall
constexpr double kPlump = 0.00042;  // [m] the same of a leaf
constexpr double kPleat = 0.00034;  // [m] height of the folds on the inner side
constexpr int kFolds = 2;           // of them on a leaf

/// Rings of the bell beyond the tube's end: forwards and outwards, in radii of the end.
constexpr std::array<std::array<double, 2>, 4> kBell{{{0.14, 1.01}, {0.34, 1.05}, {0.52, 1.12}, {0.68, 1.24}}};
constexpr double kRimLean = 0.85;  // [rad] from the tube's direction outwards, of the wall at the rim

/// The inside, from below the rim to the mouth: as the bell, and how much light gets there.
struct FunnelRow {
  double along, radius, openness;
};
constexpr std::array<FunnelRow, 7> kFunnel{{{0.50, 1.04, 0.92},
                                            {0.24, 0.84, 0.74},
                                            {-0.06, 0.63, 0.50},
                                            {-0.36, 0.44, 0.26},
                                            {-0.64, 0.32, 0.12},
                                            {-0.94, 0.22, 0.05},
                                            {-1.25, 0.12, 0.02}}};

/// One leaf: where it grows, how far, and how it bends.
struct Leaf {
  double from, to;  ///< of the rim [rad]
  double length;    ///< [m]
  double lean;      ///< [rad] outwards at its end, more than at the rim
  double sway;      ///< [rad] sideways
  double reaches;   ///< 0..1: how far it is drawn to the ovary
  int seed;
  double middle() const { return 0.5 * (from + to); }
};

Vec3d outwards(double angle) { return {0, std::cos(angle), std::sin(angle)}; }
Vec3d around(double angle) { return {0, -std::sin(angle), std::cos(angle)}; }
double apart(double a, double b) { return std::fabs(std::remainder(a - b, 2 * kPi)); }

/// Unequal shares of the rim in three orders: long ones that fall outwards, middling ones, and between them short ones
/// that stand up around the mouth.
std::vector<Leaf> leaves_of(const FimbriaSite& site) {
  std::vector<Leaf> leaves(kLeaves);
  std::vector<double> border(kLeaves + 1);
  const int seed = 1000 * site.seed;
  for (int i = 0; i < kLeaves; ++i)
    border[std::size_t(i)] = 2 * kPi * (i + 0.55 * (varied(seed + i, 3) - 0.5)) / kLeaves;
  border[kLeaves] = border[0] + 2 * kPi;
  const double to_ovary = std::atan2(site.land.z, site.land.y);
  for (int i = 0; i < kLeaves; ++i) {
    Leaf& f = leaves[std::size_t(i)];
    const int order = i % 2 == 1 ? 2 : (i / 2) % 2;
    constexpr double longest[] = {1.7, 1.3, 0.85}, falls[] = {1.05, 0.5, 0.0};
    f.seed = seed + i;
    f.from = border[std::size_t(i)];
    f.to = border[std::size_t(i) + 1];
    f.length = site.radius * longest[order] * (0.7 + 0.6 * varied(f.seed, 4));
    f.lean = falls[order] + 0.8 * (varied(f.seed, 6) - 0.5);
    f.sway = 1.3 * (varied(f.seed, 8) - 0.5);
    const double off = apart(f.middle(), to_ovary);
    f.reaches = site.ovary ? smooth(1.2, 0.35, off) : 0;
  }
  if (site.ovary) {  // the nearest of all gets there
    const auto nearest = std::min_element(leaves.begin(), leaves.end(), [&](const Leaf& a, const Leaf& b) {
      return apart(a.middle(), to_ovary) < apart(b.middle(), to_ovary);
    });
    for (Leaf& f : leaves) f.reaches = std::min(f.reaches, 0.75);
    nearest->reaches = 1;
  }
  return leaves;
}

/// A place on a leaf's middle line.
struct Spine {
  Vec3d point, along, across, flat;  ///< unit; flat: out of the inner side
};
using Spines = std::array<Spine, kRings + 1>;

/// Rings stand closer towards the tip.
double along_leaf(int ring) {
  const double t = double(ring) / kRings;
  return 0.35 * t + 0.65 * std::sin(0.5 * kPi * t);
}

/// By its own bend and weight.
Spines hanging(const Leaf& f, const FimbriaSite& site) {
  Spines spine;
  const Vec3d out = outwards(f.middle()), side = around(f.middle());
  const auto& rim = kBell.back();
  Vec3d p = site.radius * (rim[0] * Vec3d{1, 0, 0} + rim[1] * out);
  for (int i = 0; i <= kRings; ++i) {
    const double u = along_leaf(i), lean = kRimLean + f.lean * u + 0.16 * std::sin(5.5 * u + f.seed);
    Vec3d t = std::cos(lean) * Vec3d{1, 0, 0} + std::sin(lean) * out;
    t = std::cos(f.sway * u) * t + std::sin(f.sway * u) * side;
    t = normalised(t + (0.75 * u) * site.down, t);
    const Vec3d across = normalised(side - dot(side, t) * t, any_perpendicular(t));
    spine[std::size_t(i)] = {p, t, across, cross(t, across)};
    if (i < kRings) p += (f.length * (along_leaf(i + 1) - u)) * t;
  }
  return spine;
}

/// A curve from the rim to the ovary, along which the leaf's inner side comes to lie on it.
Spines landing(const Leaf& f, const FimbriaSite& site) {
  Spines spine;
  const Vec3d out = outwards(f.middle()), side = around(f.middle());
  const auto& rim = kBell.back();
  const Vec3d a = site.radius * (rim[0] * Vec3d{1, 0, 0} + rim[1] * out), b = site.land;
  const double far = length(b - a);
  const Vec3d da = (1.1 * far) * (std::cos(kRimLean) * Vec3d{1, 0, 0} + std::sin(kRimLean) * out),
              db = (1.3 * far) * normalised(site.slide - 0.25 * site.normal, site.slide);
  Vec3d carried = side;
  for (int i = 0; i <= kRings; ++i) {
    const double t = along_leaf(i), u = 1 - t;
    const Vec3d p = (u * u * (1 + 2 * t)) * a + (t * t * (3 - 2 * t)) * b + (u * u * t) * da - (t * t * u) * db;
    const Vec3d along = normalised((6 * t * u) * (b - a) + (u * (1 - 3 * t)) * da + (t * (3 * t - 2)) * db, site.slide);
    carried = normalised(carried - dot(carried, along) * along, any_perpendicular(along));
    spine[std::size_t(i)] = {p, along, carried, cross(along, carried)};
  }
  // What it must turn about itself to lie flat at the end is shared out along it.
  const Spine& last = spine[kRings];
  const Vec3d lying = cross(-site.normal, last.along);
  const double turn = std::remainder(std::atan2(dot(lying, last.flat), dot(lying, last.across)), kPi);
  for (int i = 0; i <= kRings; ++i) {
    Spine& s = spine[std::size_t(i)];
    const double by = turn * smooth(0.1, 0.8, along_leaf(i));
    s.across = std::cos(by) * s.across + std::sin(by) * s.flat;
    s.flat = cross(s.along, s.across);
  }
  return spine;
}

Spines spine_of(const Leaf& f, const FimbriaSite& site) {
  Spines own = hanging(f, site);
  if (f.reaches <= 0) return own;
  const Spines drawn = landing(f, site);
  if (f.reaches >= 1) return drawn;
  for (int i = 0; i <= kRings; ++i) {
    Spine& s = own[std::size_t(i)];
    const Spine& d = drawn[std::size_t(i)];
    s.point = (1 - 0.6 * f.reaches) * s.point + (0.6 * f.reaches) * d.point;
    s.along = normalised((1 - f.reaches) * s.along + f.reaches * d.along, s.along);
    s.across = normalised(s.across - dot(s.across, s.along) * s.along, any_perpendicular(s.along));
    s.flat = cross(s.along, s.across);
  }
  return own;
}

/// 1 up to the round end, 0 at the tip.
double round_end(double u, double end) {
  return std::sqrt(std::max(0.0, 1 - std::pow(std::max(0.0, (u - 1 + end) / end), 2.0)));
}

/// Half the width over half the share of the rim: a slender frond, widest in its middle, with soft scallops and a
/// round end.
double half_width(const Leaf& f, double u, double end, bool right) {
  const int k = 2 * f.seed + (right ? 1 : 0);
  const double body = 1 + (0.3 + 0.5 * varied(f.seed, 23)) * smooth(0.05, 0.5, u) - 0.62 * smooth(0.45, 1, u);
  const double turn = (11 + 7 * varied(k, 2)) * u + 6.3 * varied(k, 1);
  const double scallops = smooth(0.1, 0.35, u) * (0.16 * std::sin(turn) + 0.09 * std::sin(2.3 * turn + k));
  return (body + scallops) * (0.03 + 0.97 * round_end(u, end));
}

/// How far the column at `w` (-1..1 across) goes, over the leaf's length.
double reach(const Leaf& f, double w) { return 0.97 - 0.03 * std::sin(2.5 * w + f.seed); }

/// How high the folds of the inner side stand at a column of the rim, 0..1; each has its own height.
double fold_at(int column) {
  const double turn = double(kFolds * column) / kLeafColumns, own = varied(int(turn), 77);
  return (0.25 + 0.75 * own) * (0.5 - 0.5 * std::cos(2 * kPi * turn));
}

struct Sheets {
  Vec3d middle, inner;  ///< between both sides; half the thickness towards the inner one
};

Sheets place_on(const Leaf& f, const Spines& spine, const FimbriaSite& site, int ring, int column, double fold) {
  const double w = 2.0 * column / kLeafColumns - 1, v = along_leaf(ring);
  const double u = v * (1 + (reach(f, w) - 1) * v), at = std::clamp(u, 0.0, 1.0);
  // The spine at u, between its own rings.
  int i = 0;
  while (i + 2 <= kRings && along_leaf(i + 1) < at) ++i;
  const double t = (at - along_leaf(i)) / (along_leaf(i + 1) - along_leaf(i));
  const Spine &a = spine[std::size_t(i)], &b = spine[std::size_t(i) + 1];
  const Vec3d point = (1 - t) * a.point + t * b.point, across = (1 - t) * a.across + t * b.across,
              flat = (1 - t) * a.flat + t * b.flat;
  const double sector = 0.5 * (f.to - f.from) * kBell.back()[1] * site.radius;
  const double end = std::clamp(2.4 * sector / f.length, 0.35, 0.7);
  const double half = sector * half_width(f, v, end, w > 0);
  // Edges are longer than the middle: they rise and fall in a frill, and the leaf is a shallow trough.
  const double edge = std::fabs(w) * w * w, loose = smooth(0.05, 0.5, v) * (1 - 0.7 * smooth(0.8, 1, v));
  const double phase = 6.3 * varied(f.seed, w > 0 ? 21 : 22);
  const double frill =
      loose * (0.0007 * edge * std::sin(12 * v + phase) + 0.00026 * w * w * std::sin(26 * v + 1.7 * phase));
  const double trough = (f.reaches >= 1 ? 0.05 : 0.35 * varied(f.seed, 12) - 0.1) * half * w * w;
  const double pleats = kPleat * smooth(0, 0.15, v) * (1 - 0.6 * v) * (fold - 0.3);
  const double thick = (kWall + (kPlump - kWall) * smooth(0, 0.4, v) * (1 - 0.35 * v)) * round_end(v, end) *
                       std::sqrt(std::max(0.0, 1 - w * w));
  // At the root the leaf's line follows the rim.
  const double angle = f.from + (f.to - f.from) * double(column) / kLeafColumns, root = smooth(0.3, 0, v);
  const auto& rim = kBell.back();
  const Vec3d on_rim = site.radius * (rim[0] * Vec3d{1, 0, 0} + rim[1] * outwards(angle));
  const Vec3d base = spine[0].point + (sector * w) * spine[0].across;
  const Vec3d p = point + (w * half) * across + (frill + trough + pleats) * flat + root * (on_rim - base);
  return {p, thick * normalised(flat, a.flat)};
}

Paint painted(double openness, double tint) { return {to_byte(openness), 0, 0, to_byte(tint)}; }

/// The inner side is the mucosa's deep rose, darker between folds; the rims let light through.
Paint of_leaf(int column, double fold, double v, bool inside) {
  const double w = 2.0 * column / kLeafColumns - 1;
  const double rim = std::max(std::pow(std::fabs(w), 4.0), smooth(0.84, 1.0, v));
  const double groove = 1 - std::min(1.0, 1.5 * fold);
  if (inside) return painted(1 - 0.45 * groove * (1 - rim) * (1 - 0.5 * v), (1 - 0.2 * fold) * (1 - 0.6 * rim));
  return painted(0.95, (0.85 * smooth(0, 0.35, v)) * (1 - 0.65 * rim));
}

/// Vertices of the outside, from the tube's end to the rim; the last row is the rim.
std::vector<std::uint32_t> add_bell(MeshBuffer& b, const FimbriaSite& site, const std::vector<double>& angle) {
  for (std::size_t row = 0; row < kBell.size(); ++row) {
    const double share = double(row) / double(kBell.size() - 1);
    for (int k = 0; k < kRimColumns; ++k) {
      const double even = 2 * kPi * k / kRimColumns, a = (1 - share) * even + share * angle[std::size_t(k)];
      const double edge = double(k % kLeafColumns) / kLeafColumns, w = 2 * edge - 1;
      const double out =
          kWall / site.radius * (row + 1 == kBell.size() ? std::sqrt(std::max(0.0, 1 - w * w)) - 0.3 : 0);
      const Vec3d normal = std::sin(kRimLean) * Vec3d{-1, 0, 0} + std::cos(kRimLean) * outwards(a);
      const Vec3d p = site.radius * (kBell[row][0] * Vec3d{1, 0, 0} + kBell[row][1] * outwards(a) + out * normal);
      b.add(vec_cast<float>(p), painted(1, 0.05 * share));
    }
    if (row > 0)
      join_rows(b, std::uint32_t(row - 1) * kRimColumns, std::uint32_t(row) * kRimColumns, kRimColumns, true);
  }
  std::vector<std::uint32_t> rim;
  for (int k = 0; k < kRimColumns; ++k) rim.push_back(std::uint32_t(kBell.size() - 1) * kRimColumns + std::uint32_t(k));
  return rim;
}

/// The rim's inner row: its own vertices, but for those where two leaves part.
std::vector<std::uint32_t> add_inner_rim(MeshBuffer& b, const std::vector<std::uint32_t>& rim,
                                         const std::vector<double>& angle) {
  std::vector<std::uint32_t> inner = rim;
  for (int k = 0; k < kRimColumns; ++k) {
    if (k % kLeafColumns == 0) continue;
    const double w = 2.0 * (k % kLeafColumns) / kLeafColumns - 1, thick = 2 * kWall * std::sqrt(1 - w * w);
    const Vec3d in = std::sin(kRimLean) * Vec3d{1, 0, 0} - std::cos(kRimLean) * outwards(angle[std::size_t(k)]);
    const Vec3d p = vec_cast<double>(b.positions[rim[std::size_t(k)]]) + (thick + 0.4 * kPleat * fold_at(k)) * in;
    inner[std::size_t(k)] = b.add(vec_cast<float>(p), of_leaf(k % kLeafColumns, fold_at(k), 0, true));
  }
  return inner;
}

void add_leaf(MeshBuffer& b, const Leaf& f, int index, const FimbriaSite& site, const std::vector<std::uint32_t>& rim,
              const std::vector<std::uint32_t>& inner_rim) {
  const Spines spine = spine_of(f, site);
  std::vector<std::uint32_t> outside, inside;  // of the row before
  for (int j = 0; j <= kLeafColumns; ++j) {
    const auto k = std::size_t((index * kLeafColumns + j) % kRimColumns);
    outside.push_back(rim[k]);
    inside.push_back(inner_rim[k]);
  }
  for (int i = 1; i <= kRings; ++i) {
    std::vector<std::uint32_t> out_row, in_row;
    for (int j = 0; j <= kLeafColumns; ++j) {
      const double v = along_leaf(i), fold = fold_at(index * kLeafColumns + j);
      const Sheets s = place_on(f, spine, site, i, j, fold);
      // At the edge both lie in the same place, each with the normal of its side: a rim that looked sideways would
      // be dark, and a real one lets light through.
      out_row.push_back(b.add(vec_cast<float>(s.middle - s.inner), of_leaf(j, fold, v, false)));
      in_row.push_back(b.add(vec_cast<float>(s.middle + s.inner), of_leaf(j, fold, v, true)));
    }
    for (std::size_t j = 0; j < std::size_t(kLeafColumns); ++j) {
      b.quad(outside[j], outside[j + 1], out_row[j + 1], out_row[j]);
      b.quad(inside[j + 1], inside[j], in_row[j], in_row[j + 1]);
    }
    outside = std::move(out_row);
    inside = std::move(in_row);
  }
}

void add_funnel(MeshBuffer& b, const std::vector<std::uint32_t>& rim, const FimbriaSite& site,
                const std::vector<double>& angle) {
  std::vector<std::uint32_t> before = rim;
  for (const FunnelRow& row : kFunnel) {
    std::vector<std::uint32_t> now;
    for (int k = 0; k < kRimColumns; ++k) {
      const double fold = fold_at(k) * smooth(0.05, 0.3, row.radius), out = row.radius - 0.1 * (fold - 0.3);
      const Vec3d p = site.radius * (row.along * Vec3d{1, 0, 0} + out * outwards(angle[std::size_t(k)]));
      now.push_back(b.add(vec_cast<float>(p), painted(row.openness * (0.65 + 0.35 * fold), 1)));
    }
    for (std::size_t k = 0; k < std::size_t(kRimColumns); ++k) {
      const std::size_t next = (k + 1) % kRimColumns;
      b.quad(before[k], before[next], now[next], now[k]);
    }
    before = std::move(now);
  }
  const std::uint32_t pole = b.add({float(-1.15 * site.radius), 0, 0}, painted(0.03, 1));
  for (std::size_t k = 0; k < std::size_t(kRimColumns); ++k) b.triangle(before[k], before[(k + 1) % kRimColumns], pole);
}

}  // namespace

MeshBuffer fimbriae(const FimbriaSite& site) {
  const std::vector<Leaf> leaves = leaves_of(site);
  std::vector<double> angle;
  for (const Leaf& f : leaves)
    for (int j = 0; j < kLeafColumns; ++j) angle.push_back(f.from + (f.to - f.from) * double(j) / kLeafColumns);
  MeshBuffer b;
  const std::vector<std::uint32_t> rim = add_bell(b, site, angle), inner = add_inner_rim(b, rim, angle);
  for (int i = 0; i < kLeaves; ++i) add_leaf(b, leaves[std::size_t(i)], i, site, rim, inner);
  add_funnel(b, inner, site, angle);
  return b;
}

double bell_flare(double before) {
  const double u = std::clamp(1 - before / kBellLength, 0.0, 1.0);
  return 1 + (kBellFlare - 1) * u * u * (0.55 + 0.45 * u);
}

}  // namespace trocar::view
