#include <algorithm>
#include <array>
#include <cmath>

#include <trocar/render/mesh_arrays.hpp>
#include <trocar/view/fimbria.hpp>

namespace trocar::view {
namespace {

constexpr double kPi = 3.14159265358979;
constexpr int kRings = 24;          // along a frond ...
constexpr int kCapRings = 5;        // ... of which so many round off its end
constexpr double kThick = 0.00020;  // [m] half of a frond's thickness
constexpr double kWave = 0.0020;    // [m] from crest to crest of its frill
constexpr double kMostWaves = 3.9;  // that its rings can follow
constexpr double kFrill = 0.00054;  // [m] how far that goes to either side, at the most

/// The bell beyond the tube's end, over its rim and down to the mouth: forwards and outwards, in radii of the end, and
/// how much light gets there.
struct BellRow {
  double along, radius, openness, mucosa;
};
constexpr std::array<BellRow, 11> kBell{{{0.14, 1.01, 1.00, 0.0},
                                         {0.36, 1.08, 1.00, 0.05},
                                         {0.56, 1.20, 1.00, 0.2},
                                         {0.68, 1.30, 0.95, 0.5},
                                         {0.74, 1.27, 0.85, 0.8},
                                         {0.64, 1.10, 0.70, 1.0},
                                         {0.40, 0.86, 0.50, 1.0},
                                         {0.02, 0.62, 0.32, 1.0},
                                         {-0.36, 0.42, 0.20, 1.0},
                                         {-0.80, 0.26, 0.08, 1.0},
                                         {-1.20, 0.12, 0.02, 1.0}}};

/// Fronds grow in rows, from the rim inwards: long ones that fall outwards, and shorter ones that stand around the
/// mouth. Lengths in radii of the tube's end, angles from the tube's direction outwards.
struct FrondRow {
  int count;
  double along, radius;  ///< of their roots
  double length, half_width;
  double lean, falls;  ///< [rad] at the root, and how much more at the tip
};
constexpr std::array<FrondRow, 4> kRows{{{22, 0.34, 1.01, 1.65, 0.15, 0.74, 0.75},
                                         {15, 0.66, 1.22, 1.35, 0.145, 0.75, 0.50},
                                         {10, 0.50, 0.98, 1.10, 0.14, 0.45, 0.40},
                                         {6, 0.20, 0.72, 1.00, 0.13, 0.15, 0.25}}};
static_assert(kRows[0].count + kRows[1].count + kRows[2].count + kRows[3].count == kFronds);
constexpr int kClump = 3;  // neighbours that cling together

/// One frond: where it grows, how far, and how it bends.
struct Frond {
  Vec3d root;           ///< [m]
  double angle;         ///< around the rim [rad]
  double length, half;  ///< half its width [m]
  double end;           ///< of its length: what is rounded off
  double lean, falls;   ///< as FrondRow
  double sway, twist;   ///< sideways, and about itself, at its end [rad]
  double reaches;       ///< 0..1: how far it is drawn to the ovary
  int seed;
};

Vec3d outwards(double angle) { return {0, std::cos(angle), std::sin(angle)}; }
Vec3d around(double angle) { return {0, -std::sin(angle), std::cos(angle)}; }
double apart(double a, double b) { return std::fabs(std::remainder(a - b, 2 * kPi)); }
double swing(int i, int k) { return 2 * varied(i, k) - 1; }

Frond grown(const FimbriaSite& site, const FrondRow& row, int i, int index) {
  Frond f;
  f.seed = 1000 * site.seed + index;
  const int clump = 1000 * site.seed + 500 + index / kClump;
  // Those of a clump lean the same way, and towards its middle.
  const double aside = index % kClump - 0.5 * (kClump - 1);
  f.angle = 2 * kPi * (i + 0.45 * swing(f.seed, 3) - 0.1 * aside) / row.count + 0.4 * row.count;
  f.root = site.radius * (row.along * Vec3d{1, 0, 0} + row.radius * outwards(f.angle));
  f.length = site.radius * row.length * (1 + 0.3 * swing(f.seed, 4));
  f.half = site.radius * row.half_width * (1 + 0.35 * swing(f.seed, 5));
  f.end = std::min(0.4, 1.1 * f.half / f.length);
  f.lean = row.lean + 0.1 * swing(f.seed, 6);
  f.falls = row.falls + 0.6 * swing(clump, 7) + 0.3 * swing(f.seed, 7);
  f.sway = 0.3 * swing(clump, 8) + 0.3 * swing(f.seed, 8) - 0.15 * aside;
  f.twist = 1.0 * swing(f.seed, 9);
  f.reaches = 0;
  return f;
}

std::vector<Frond> fronds_of(const FimbriaSite& site) {
  std::vector<Frond> fronds;
  for (const FrondRow& row : kRows)
    for (int i = 0; i < row.count; ++i) fronds.push_back(grown(site, row, i, int(fronds.size())));
  if (!site.ovary) return fronds;
  const double to_ovary = std::atan2(site.land.z, site.land.y);
  const auto outer = fronds.begin() + kRows[0].count;
  for (auto f = fronds.begin(); f != outer; ++f) f->reaches = 0.75 * smooth(1.2, 0.35, apart(f->angle, to_ovary));
  const auto nearest = std::min_element(fronds.begin(), outer, [&](const Frond& a, const Frond& b) {
    return apart(a.angle, to_ovary) < apart(b.angle, to_ovary);
  });
  nearest->reaches = 1;  // it gets there
  return fronds;
}

/// A place on a frond's middle line.
struct Spine {
  Vec3d point, along, across, flat;  ///< unit; flat: out of the inner side
};
using Spines = std::array<Spine, kRings + 1>;

/// Rings stand closer where its end is rounded off.
double along_frond(const Frond& f, int ring) {
  constexpr int body = kRings - kCapRings;
  if (ring <= body) return (1 - f.end) * ring / body;
  return 1 - f.end + f.end * std::sin(0.5 * kPi * (ring - body) / kCapRings);
}

void turn(Spine& s, double by) {
  s.across = std::cos(by) * s.across + std::sin(by) * s.flat;
  s.flat = cross(s.along, s.across);
}

/// By its own bend and weight.
Spines hanging(const Frond& f, const FimbriaSite& site) {
  Spines spine;
  const Vec3d out = outwards(f.angle), side = around(f.angle);
  Vec3d p = f.root;
  for (int i = 0; i <= kRings; ++i) {
    const double u = along_frond(f, i), lean = f.lean + f.falls * u + 0.25 * std::sin(5 * u + f.seed) * u;
    Vec3d t = std::cos(lean) * Vec3d{1, 0, 0} + std::sin(lean) * out;
    t = std::cos(f.sway * u) * t + std::sin(f.sway * u) * side;
    t = normalised(t + (0.9 * u) * site.down, t);
    const Vec3d across = normalised(side - dot(side, t) * t, any_perpendicular(t));
    spine[std::size_t(i)] = {p, t, across, cross(t, across)};
    turn(spine[std::size_t(i)], f.twist * u);
    if (i < kRings) p += (f.length * (along_frond(f, i + 1) - u)) * t;
  }
  return spine;
}

/// A curve from the rim to the ovary, along which the frond's inner side comes to lie on it.
Spines landing(const Frond& f, const FimbriaSite& site) {
  Spines spine;
  const Vec3d out = outwards(f.angle), side = around(f.angle), a = f.root, b = site.land;
  const double far = length(b - a);
  const Vec3d da = (1.1 * far) * (std::cos(f.lean) * Vec3d{1, 0, 0} + std::sin(f.lean) * out),
              db = (1.3 * far) * normalised(site.slide - 0.25 * site.normal, site.slide);
  Vec3d carried = side;
  for (int i = 0; i <= kRings; ++i) {
    const double t = along_frond(f, i), u = 1 - t;
    const Vec3d p = (u * u * (1 + 2 * t)) * a + (t * t * (3 - 2 * t)) * b + (u * u * t) * da - (t * t * u) * db;
    const Vec3d along = normalised((6 * t * u) * (b - a) + (u * (1 - 3 * t)) * da + (t * (3 * t - 2)) * db, site.slide);
    carried = normalised(carried - dot(carried, along) * along, any_perpendicular(along));
    spine[std::size_t(i)] = {p, along, carried, cross(along, carried)};
  }
  // What it must turn about itself to lie flat at the end is shared out along it.
  const Spine& last = spine[kRings];
  const Vec3d lying = cross(-site.normal, last.along);
  const double all = std::remainder(std::atan2(dot(lying, last.flat), dot(lying, last.across)), kPi);
  for (int i = 0; i <= kRings; ++i) turn(spine[std::size_t(i)], all * smooth(0.1, 0.8, along_frond(f, i)));
  return spine;
}

Spines spine_of(const Frond& f, const FimbriaSite& site) {
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

/// A vertex of a frond's cross-section: -1..1 across, and whether on its inner (1) or outer (-1) side or edge (0).
struct Corner {
  double across, side;
};
constexpr std::array<Corner, 6> kCorners{{{1, 0}, {0.62, 1}, {-0.62, 1}, {-1, 0}, {-0.62, -1}, {0.62, -1}}};

struct Place {
  Vec3d point;
  double dip;  ///< 0 .. 1: how deep in a fold of the frill
};

/// A frond's edges are much longer than its middle: they swing to and fro across it and along it, in a frill, each by
/// its own measure.
Place place_on(const Frond& f, const Spines& spine, double span, int ring, Corner corner) {
  const Spine& s = spine[std::size_t(ring)];
  const double w = corner.across, u = along_frond(f, ring), tip = round_end(u, f.end), grown = smooth(0, 0.2, u);
  const int side = 2 * f.seed + (w > 0 ? 1 : 0);
  const double waves = std::min(span / kWave, kMostWaves) * (0.7 + 0.3 * varied(side, 21));
  const double phase = 2 * kPi * (waves * (u + 0.07 * std::sin(6 * u + side)) + varied(side, 22));
  const double loose = smooth(0.08, 0.45, u) * (f.reaches >= 1 ? 0.4 : 1) * tip;
  const double swell = kFrill * loose * (1 + 0.4 * std::sin(0.37 * phase + 3 * side));
  const double up = std::sin(phase) + 0.25 * std::sin(1.7 * phase + side);
  const double wide = f.half * tip * (0.45 + 0.45 * grown + 0.35 * smooth(0.2, 0.65, u));
  const double across = w * wide * (1 + 0.12 * loose * std::cos(phase + 0.8));
  const double trough = 0.3 * swing(f.seed, 12) * f.half * w * w, edge = std::fabs(w) * std::sqrt(std::fabs(w));
  const double thick = kThick * tip * (0.3 + 0.7 * grown) * (1.15 - 0.4 * u);
  const Vec3d p = s.point + across * s.across + (swell * edge * up + trough + corner.side * thick) * s.flat -
                  (0.12 * swell * edge * std::cos(phase + 0.5)) * s.along;
  return {p, std::max(0.0, -corner.side * up * loose)};
}

Paint painted(double openness, double tint) { return {to_byte(openness), 0, 0, to_byte(tint)}; }

void add_bell(MeshBuffer& b, const FimbriaSite& site) {
  for (std::size_t row = 0; row < kBell.size(); ++row) {
    const BellRow& r = kBell[row];
    for (int k = 0; k < kRimColumns; ++k) {
      const double a = 2 * kPi * k / kRimColumns;
      // Mucosa lies in folds that run down to the mouth, and the rim follows them.
      const double folds = std::sin(7 * a + 1.3 * std::sin(2 * a + site.seed)) + 0.5 * std::sin(12 * a + site.seed);
      const double out = r.radius * (1 + 0.05 * folds * r.mucosa);
      const Vec3d p = site.radius * (r.along * Vec3d{1, 0, 0} + out * outwards(a));
      b.add(vec_cast<float>(p), painted(r.openness * (1 - 0.1 * r.mucosa * folds), r.mucosa));
    }
    if (row > 0)
      join_rows(b, std::uint32_t(row - 1) * kRimColumns, std::uint32_t(row) * kRimColumns, kRimColumns, true);
  }
  const std::uint32_t pole = b.add({float(-1.3 * site.radius), 0, 0}, painted(0.02, 1));
  join_pole(b, pole - kRimColumns, kRimColumns, pole, true);
}

/// Deep rose along its middle and in the folds of its frill; its edges and tip are thin and paler.
void add_frond(MeshBuffer& b, const Frond& f, const FimbriaSite& site) {
  const Spines spine = spine_of(f, site);
  double span = 0;
  for (std::size_t i = 1; i < spine.size(); ++i) span += length(spine[i].point - spine[i - 1].point);
  const std::uint32_t root = b.add(vec_cast<float>(spine[0].point - kThick * spine[0].along), painted(1, 0));
  std::uint32_t row = root + 1;
  for (int i = 0; i < kRings; ++i) {
    const double u = along_frond(f, i), mucosa = smooth(0, 0.3, u), thin = 1 - round_end(u, f.end);
    for (const Corner& c : kCorners) {
      const Place place = place_on(f, spine, span, i, c);
      const double pale = std::max(c.side == 0 ? 1.0 : 0.0, thin);
      const double tint = (0.36 + 0.2 * swing(f.seed, 31) + 0.6 * place.dip) * (1 - 0.8 * pale * (1 - place.dip));
      const double open = (1 - 0.45 * std::min(1.0, place.dip)) * (c.side > 0 ? 0.8 + 0.2 * thin : 1);
      b.add(vec_cast<float>(place.point), painted(open, tint * mucosa));
    }
    const auto corners = std::uint32_t(kCorners.size());
    if (i == 0)
      join_pole(b, row, corners, root, false);
    else
      join_rows(b, row, row + corners, corners, true);
    row = b.size() - corners;
  }
  const std::uint32_t tip = b.add(vec_cast<float>(spine[kRings].point), painted(1, 0));
  join_pole(b, row, std::uint32_t(kCorners.size()), tip, true);
}

/// A piece of surface as a disc that takes light from what it faces. [Bunnell 05]
struct Disc {
  Vec3f place, normal;
  float area;
};

std::vector<Disc> discs_of(const MeshBuffer& b, const std::vector<Vec3f>& normals) {
  constexpr std::uint32_t kEvery = 11;  // vertices: next to no two in the same place of a ring
  std::vector<float> area(b.size());
  for (std::size_t i = 0; i + 2 < b.indices.size(); i += 3) {
    const Vec3f p = b.positions[b.indices[i]];
    const float third = length(cross(b.positions[b.indices[i + 1]] - p, b.positions[b.indices[i + 2]] - p)) / 6;
    for (std::size_t k = 0; k < 3; ++k) area[b.indices[i + k]] += third;
  }
  std::vector<Disc> discs;
  for (std::uint32_t v = 0; v < b.size(); v += kEvery) {
    float all = 0;
    for (std::uint32_t k = v; k < std::min(v + kEvery, b.size()); ++k) all += area[k];
    discs.push_back({b.positions[v], normals[v], all});
  }
  return discs;
}

/// Fronds shade each other: deep between them it is dark and red, their tips are open and pale.
void shade(MeshBuffer& b) {
  constexpr float kFar = 0.004f;  // [m] beyond that, what is baked for the whole scene says enough
  constexpr double kLeast = 0.4;  // thin mucosa lets light through: there are no black slits at roots
  constexpr double kDark = 2.6;   // beyond what is hidden: what is reflected there goes through wet mucosa again
  std::vector<Vec3f> normals;
  render::vertex_normals(b.positions, b.indices, normals);
  const std::vector<Disc> discs = discs_of(b, normals);
  for (std::uint32_t v = 0; v < b.size(); ++v) {
    const Vec3f p = b.positions[v] + 0.0001f * normals[v];
    float covered = 0;
    for (const Disc& d : discs) {
      const Vec3f way = d.place - p;
      const float far2 = dot(way, way);
      const float facing = dot(way, normals[v]);
      if (facing <= 0 || far2 > kFar * kFar) continue;
      const float far = std::sqrt(far2);
      const float seen = std::fabs(dot(way, d.normal)) / far;  // either side hides what is behind
      covered += facing / far * (0.3f + 0.7f * seen) * d.area / (3.14f * far2 + d.area) * (1 - far / kFar);
    }
    const double open = kLeast + (1 - kLeast) * std::exp(-kDark * double(covered));
    Paint& paint = b.paint[v];
    paint.tint = to_byte(paint.tint / 255.0 + 0.5 * (1 - open) * (1 - paint.tint / 255.0));
    paint.openness = to_byte(paint.openness / 255.0 * open);
  }
}

}  // namespace

MeshBuffer fimbriae(const FimbriaSite& site) {
  MeshBuffer b;
  add_bell(b, site);
  for (const Frond& f : fronds_of(site)) add_frond(b, f, site);
  shade(b);
  return b;
}

double bell_flare(double before) {
  const double u = std::clamp(1 - before / kBellLength, 0.0, 1.0);
  return 1 + (kBellFlare - 1) * u * u * (0.55 + 0.45 * u);
}

}  // namespace trocar::view
