#include <algorithm>
#include <array>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/view/bodies/fimbria.hpp>

namespace trocar::view {
namespace {

constexpr int kFrondRings = 25;          // along a frond ...
constexpr int kCapRings = 6;             // ... of which so many round off its end
constexpr double kFrondThick = 0.00024;  // [m] half of a frond's thickness
constexpr double kFrondWave = 0.0021;    // [m] from crest to crest of its frill
constexpr double kMostWaves = 3.3;       // that its rings can follow
constexpr double kFrill = 0.00058;       // [m] how far that goes to either side, at the most
constexpr double kFrondSlack = 0.0011;   // [m] by which one that reaches the ovary swings aside on its way
constexpr double kLobes = 1.45;          // scallops of its edge a wave of its frill
constexpr double kOwnRoot = 0.3;         // of its length: on it a frond goes over from the bell's shape to its own
constexpr std::size_t kFoldSides = 6;    // vertices around a frond that grows out of a fold

/// The bell beyond the tube's end, over its rim and down to the mouth: forwards and outwards, in radii of the end, how
/// much light gets there, how thin it is, and how far out of it (inwards where negative) the folds stand that run on
/// into the fronds.
struct BellRow {
  double along, radius, openness, thin, fold;
};
constexpr std::array<BellRow, 11> kBell{{{0.14, 1.01, 1.00, 0.0, 0.0},
                                         {0.30, 1.06, 1.00, 0.04, 0.008},
                                         {0.44, 1.13, 1.00, 0.12, 0.02},
                                         {0.56, 1.22, 1.00, 0.26, 0.035},
                                         {0.63, 1.12, 0.85, 0.30, -0.04},
                                         {0.52, 0.99, 0.72, 0.26, -0.06},
                                         {0.34, 0.83, 0.58, 0.20, -0.08},
                                         {0.02, 0.62, 0.38, 0.12, -0.09},
                                         {-0.36, 0.42, 0.22, 0.06, -0.09},
                                         {-0.80, 0.26, 0.10, 0.0, -0.06},
                                         {-1.20, 0.12, 0.04, 0.0, 0.0}}};
constexpr std::size_t kOuterRim = 3;  // fronds grow between this row and the next

/// Fronds that grow out of the folds within the bell stand around the mouth in rows. Lengths in radii of the tube's
/// end, angles from the tube's direction outwards.
struct FrondRow {
  int count;
  double along, radius;  ///< of their roots, below the bell's inner side
  double length, half_width;
  double lean, falls;  ///< [rad] at the root, and how much more at the tip
};
constexpr std::array<FrondRow, 2> kFrondRows{
    {{16, 0.38, 0.89, 1.45, 0.25, 0.66, 0.55}, {9, 0.10, 0.69, 1.25, 0.22, 0.50, 0.20}}};
static_assert(kFrondRows[0].count + kFrondRows[1].count == kFoldFronds);
constexpr FrondRow kFrondRim{kRimFronds, 0, 0, 1.20, 0, 0.70, 0.95};  // those of the rim: their roots are its own
constexpr int kClump = 3;                                             // neighbours that cling together

/// One frond: where it grows, how far, and how it bends.
struct Frond {
  Vec3d root;           ///< [m]
  double angle;         ///< around the rim [rad]
  double length, half;  ///< half its width [m]
  double end;           ///< of its length: what is rounded off
  double root_lean;     ///< [rad] as the bell's wall, which it grows out of
  double lean, falls;   ///< as FrondRow
  double sway, twist;   ///< sideways, and about itself, at its end [rad]
  double reaches;       ///< 0..1: how far it is drawn to the ovary
  int seed;
};

/// 0..1: how much of a row of the bell is lining, which is a deeper rose than the tube.
double rose_of_bell(std::size_t row) { return row > kOuterRim ? 0.85 : 1.8 * kBell[row].thin; }

Vec3d outwards(double angle) { return {0, std::cos(angle), std::sin(angle)}; }
Vec3d around(double angle) { return {0, -std::sin(angle), std::cos(angle)}; }
double apart(double a, double b) { return std::fabs(std::remainder(a - b, 2 * portable::pi)); }
double frond_swing(int i, int k) { return 2 * varied(i, k) - 1; }

/// Column of the rim at which its i-th frond begins: they are of unequal width.
int border(const FimbriaSite& site, int i) {
  constexpr int each = kRimColumns / kRimFronds;
  return each * i + int(std::lround(1.45 * frond_swing(1000 * site.seed + i % kRimFronds, 2)));
}

/// -1 between two fronds of the rim .. 1 in the middle of one.
double fold_at(const FimbriaSite& site, int column) {
  for (int i = 0; i <= kRimFronds; ++i) {
    const int from = border(site, i - 1 + kRimFronds) - kRimColumns, to = border(site, i);
    if (column <= to) return -std::cos(2 * portable::pi * (column - from) / (to - from));
  }
  return fold_at(site, column - kRimColumns);
}

Vec3d on_bell(const FimbriaSite& site, std::size_t row, int column) {
  const BellRow& r = kBell[row];
  const double a = 2 * portable::pi * column / kRimColumns;
  // Its rim is uneven too.
  const double uneven =
      r.openness < 0.3 ? 0 : 3 * r.thin * (std::sin(2 * a + site.seed) + std::sin(5 * a + 3 * site.seed));
  const double out = r.radius * (1 + r.fold * fold_at(site, column));
  return site.radius * ((r.along + 0.05 * uneven) * Vec3d{1, 0, 0} + out * outwards(a));
}

/// Where two rows of the rim bound a frond: outer side onwards around the bell, inner side back.
std::vector<std::uint32_t> root_loop(const FimbriaSite& site, int i) {
  std::vector<std::uint32_t> loop;
  const auto vertex = [](std::size_t row, int column) {
    return std::uint32_t(int(row) * kRimColumns + (column + kRimColumns) % kRimColumns);
  };
  const int from = border(site, i), to = i + 1 < kRimFronds ? border(site, i + 1) : border(site, 0) + kRimColumns;
  for (int k = from; k <= to; ++k) loop.push_back(vertex(kOuterRim, k));
  for (int k = to; k >= from; --k) loop.push_back(vertex(kOuterRim + 1, k));
  return loop;
}

Frond grown(const FimbriaSite& site, const FrondRow& row, int index) {
  Frond f;
  f.seed = 1000 * site.seed + index;
  const int clump = 1000 * site.seed + 500 + index / kClump;
  // Those of a clump lean the same way, and towards its middle.
  const double aside = index % kClump - 0.5 * (kClump - 1);
  f.length = site.radius * row.length * (1 + 0.25 * frond_swing(f.seed, 4) + 0.2 * frond_swing(clump, 4));
  f.lean = row.lean + 0.12 * frond_swing(f.seed, 6);
  f.falls = row.falls + 0.5 * frond_swing(clump, 7) + 0.25 * frond_swing(f.seed, 7);
  f.sway = 0.3 * frond_swing(clump, 8) + 0.2 * frond_swing(f.seed, 8) - 0.35 * aside;
  f.twist = 0.5 * frond_swing(f.seed, 9);
  f.root_lean = 0.66;
  f.reaches = 0;
  return f;
}

void set_width(Frond& f, double half) {
  f.half = half;
  f.end = std::min(0.45, half / f.length);
}

Frond rim_frond(const FimbriaSite& site, int i) {
  Frond f = grown(site, kFrondRim, i);
  const int from = border(site, i), to = i + 1 < kRimFronds ? border(site, i + 1) : border(site, 0) + kRimColumns;
  f.angle = portable::pi * (from + to) / kRimColumns;
  const std::vector<std::uint32_t> loop = root_loop(site, i);
  f.root = {};
  for (const std::uint32_t v : loop)
    f.root += on_bell(site, v / kRimColumns, int(v % kRimColumns)) / double(loop.size());
  set_width(f, site.radius * kBell[kOuterRim].radius * portable::pi * (to - from) / kRimColumns);
  return f;
}

Frond fold_frond(const FimbriaSite& site, const FrondRow& row, int i, int index) {
  Frond f = grown(site, row, index);
  f.angle = 2 * portable::pi * (i + 0.35 * frond_swing(f.seed, 3)) / row.count + 0.4 * row.count;
  f.root = site.radius * (row.along * Vec3d{1, 0, 0} + row.radius * outwards(f.angle));
  set_width(f, site.radius * row.half_width * (1 + 0.35 * frond_swing(f.seed, 5)));
  return f;
}

std::vector<Frond> fronds_of(const FimbriaSite& site) {
  std::vector<Frond> fronds;
  for (int i = 0; i < kRimFronds; ++i) fronds.push_back(rim_frond(site, i));
  for (const FrondRow& row : kFrondRows)
    for (int i = 0; i < row.count; ++i) fronds.push_back(fold_frond(site, row, i, int(fronds.size())));
  if (!site.ovary) return fronds;
  const double to_ovary = std::atan2(site.land.z, site.land.y);
  const auto outer = fronds.begin() + kRimFronds;
  for (auto f = fronds.begin(); f != outer; ++f) f->reaches = 0.5 * smooth(1.0, 0.35, apart(f->angle, to_ovary));
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
using Spines = std::array<Spine, kFrondRings + 1>;

/// Rings stand closer where its end is rounded off.
double along_frond(const Frond& f, int ring) {
  constexpr int body = kFrondRings - kCapRings;
  if (ring <= body) return (1 - f.end) * ring / body;
  return 1 - f.end + f.end * std::sin(0.5 * portable::pi * (ring - body) / kCapRings);
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
  for (int i = 0; i <= kFrondRings; ++i) {
    const double u = along_frond(f, i), own = smooth(0, 0.5, u);
    const double bent = f.lean + f.falls * u + 0.45 * std::sin(5.5 * u + f.seed);
    const double lean = f.root_lean + own * (bent - f.root_lean);
    const double aside = own * (f.sway * (0.4 + 0.6 * u) + 0.35 * std::sin(5 * u + 2.3 * f.seed));
    Vec3d t = std::cos(lean) * Vec3d{1, 0, 0} + std::sin(lean) * out;
    t = std::cos(aside) * t + std::sin(aside) * side;
    t = normalised(t + (0.8 * u) * site.down, t);
    const Vec3d across = normalised(side - dot(side, t) * t, any_perpendicular(t));
    spine[std::size_t(i)] = {p, t, across, cross(t, across)};
    turn(spine[std::size_t(i)], f.twist * u);
    if (i < kFrondRings) p += (f.length * (along_frond(f, i + 1) - u)) * t;
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
  for (int i = 0; i <= kFrondRings; ++i) {
    const double t = along_frond(f, i), u = 1 - t;
    const double aside = kFrondSlack * std::sin(2 * portable::pi * t + f.seed) * smooth(0, 0.4, t) * smooth(1, 0.7, t);
    const Vec3d p =
        (u * u * (1 + 2 * t)) * a + (t * t * (3 - 2 * t)) * b + (u * u * t) * da - (t * t * u) * db + aside * side;
    const Vec3d along = normalised((6 * t * u) * (b - a) + (u * (1 - 3 * t)) * da + (t * (3 * t - 2)) * db, site.slide);
    carried = normalised(carried - dot(carried, along) * along, any_perpendicular(along));
    spine[std::size_t(i)] = {p, along, carried, cross(along, carried)};
  }
  // What it must turn about itself to lie flat at the end is shared out along it.
  const Spine& last = spine[kFrondRings];
  const Vec3d lying = cross(-site.normal, last.along);
  const double all = std::remainder(std::atan2(dot(lying, last.flat), dot(lying, last.across)), portable::pi);
  for (int i = 0; i <= kFrondRings; ++i) turn(spine[std::size_t(i)], all * smooth(0.1, 0.8, along_frond(f, i)));
  return spine;
}

Spines spine_of(const Frond& f, const FimbriaSite& site) {
  Spines own = hanging(f, site);
  if (f.reaches <= 0) return own;
  const Spines drawn = landing(f, site);
  if (f.reaches >= 1) return drawn;
  for (int i = 0; i <= kFrondRings; ++i) {
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

/// A vertex of a frond's cross-section: -1..1 across, and -1..1 out of its inner side.
struct Corner {
  double across, side;
};

Corner corner_of(std::size_t k, std::size_t count) {
  const double a = 2 * portable::pi * (double(k) + 0.5) / double(count);
  return {-std::cos(a), -std::sin(a)};
}

/// Half its width over that at its root: it has a belly, and tapers.
double belly(double u) { return 1 + 0.55 * smooth(0.05, 0.45, u) - 0.85 * smooth(0.45, 1.0, u); }

struct FrondPlace {
  Vec3d offset;  ///< from the middle line [m]
  double dip;    ///< 0 .. 1: how deep in a fold of the frill
};

/// A frond's edges are longer than its middle: they swing to and fro across it in a soft frill, each by its own
/// measure, and are scalloped.
FrondPlace place_on(const Frond& f, const Spines& spine, double span, int ring, Corner corner) {
  const Spine& s = spine[std::size_t(ring)];
  const double w = corner.across, u = along_frond(f, ring), tip = round_end(u, f.end);
  const int side = 2 * f.seed + (w > 0 ? 1 : 0);
  const double waves = std::min(span / kFrondWave, kMostWaves) * (0.75 + 0.25 * varied(side, 21));
  const double phase = 2 * portable::pi * (waves * (u + 0.05 * std::sin(6 * u + side)) + varied(side, 22));
  const double loose = smooth(0.12, 0.5, u) * tip;
  const double up = std::sin(phase);
  const double across = w * f.half * belly(u) * tip * (1 + 0.24 * loose * std::sin(kLobes * phase + side));
  const double edge = w * w, cup = 0.35 * frond_swing(f.seed, 12) * f.half * edge * loose;
  const double thick = kFrondThick * tip * (1.1 - 0.5 * u);
  return {across * s.across + (kFrill * loose * edge * up + cup + corner.side * thick) * s.flat,
          std::max(0.0, (corner.side < 0 ? up : -up) * loose * edge)};
}

Paint painted(double openness, double tint) { return {to_byte(openness), 0, 0, to_byte(tint)}; }

void add_bell(MeshBuffer& b, const FimbriaSite& site) {
  for (std::size_t row = 0; row < kBell.size(); ++row) {
    const BellRow& r = kBell[row];
    for (int k = 0; k < kRimColumns; ++k) {
      const double groove = row > kOuterRim ? 0.5 - 0.5 * fold_at(site, k) : 0;
      b.add(vec_cast<float>(on_bell(site, row, k)), painted(r.openness * (1 - 0.3 * groove), rose_of_bell(row)));
    }
    if (row > 0 && row != kOuterRim + 1)
      join_rows(b, std::uint32_t(row - 1) * kRimColumns, std::uint32_t(row) * kRimColumns, kRimColumns, true);
  }
  const std::uint32_t pole = b.add({float(-1.3 * site.radius), 0, 0}, painted(0.04, 0));
  join_pole(b, pole - kRimColumns, kRimColumns, pole, true);
}

void join_loops(MeshBuffer& b, const std::vector<std::uint32_t>& low, const std::vector<std::uint32_t>& high) {
  for (std::size_t i = 0; i < low.size(); ++i) {
    const std::size_t j = (i + 1) % low.size();
    b.quad(low[i], low[j], high[j], high[i]);
  }
}

/// Deep rose along its middle and in the folds of its frill; its edges and tip are thin and paler. Velvet: it shines
/// little but there.
Paint paint_on(const Frond& f, double u, Corner corner, double dip) {
  const double thin = 1 - round_end(u, f.end), edge = smooth(0.6, 1.0, std::fabs(corner.across));
  const double rim = std::max(edge, thin) * smooth(0.05, 0.4, u);
  const double own = 0.75 + 0.2 * frond_swing(f.seed, 31), root = rose_of_bell(kOuterRim);
  const double tint = root + smooth(0, 0.35, u) * (own - root);
  return painted((0.56 + 0.26 * rim + 0.44 * smooth(0.3, 0, u) * (1 - rim)) * (1 - 0.25 * dip),
                 (tint + (1 - tint) * 0.5 * dip) * (1 - 0.85 * rim));
}

/// Onwards from a closed row of vertices, its root.
void add_frond(MeshBuffer& b, const Frond& f, const FimbriaSite& site, std::vector<std::uint32_t> row) {
  const Spines spine = spine_of(f, site);
  double span = 0;
  for (std::size_t i = 1; i < spine.size(); ++i) span += length(spine[i].point - spine[i - 1].point);
  std::vector<Vec3d> root;
  for (const std::uint32_t v : row) root.push_back(vec_cast<double>(b.positions[v]) - spine[0].point);
  for (int i = 1; i < kFrondRings; ++i) {
    const double u = along_frond(f, i), own = smooth(0, kOwnRoot, u);
    std::vector<std::uint32_t> next;
    for (std::size_t k = 0; k < row.size(); ++k) {
      const Corner corner = corner_of(k, row.size());
      const FrondPlace place = place_on(f, spine, span, i, corner);
      const Vec3d offset = (1 - own) * root[k] + own * place.offset;
      next.push_back(b.add(vec_cast<float>(spine[std::size_t(i)].point + offset), paint_on(f, u, corner, place.dip)));
    }
    join_loops(b, row, next);
    row = std::move(next);
  }
  const std::uint32_t tip = b.add(vec_cast<float>(spine[kFrondRings].point), painted(1, 1));
  join_pole(b, row.front(), std::uint32_t(row.size()), tip, true);
}

/// A small closed end below the bell's inner side, out of which a fold rises.
std::vector<std::uint32_t> add_root(MeshBuffer& b, const Frond& f, const FimbriaSite& site) {
  const Spine s = spine_of(f, site)[0];
  std::vector<std::uint32_t> row;
  const std::uint32_t pole = b.add(vec_cast<float>(s.point - kFrondThick * s.along), painted(0.7, 0.2));
  for (std::size_t k = 0; k < kFoldSides; ++k) {
    const Corner c = corner_of(k, kFoldSides);
    const Vec3d offset = (0.5 * f.half * c.across) * s.across + (0.5 * kFrondThick * c.side) * s.flat;
    row.push_back(b.add(vec_cast<float>(s.point + offset), painted(0.7, 0.2)));
  }
  join_pole(b, row.front(), kFoldSides, pole, false);
  return row;
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

/// Fronds shade each other: deep between them it is darker and red, their tips are open and pale.
void shade(MeshBuffer& b) {
  constexpr float kFar = 0.004f;  // [m] beyond that, what is baked for the whole scene says enough
  constexpr double kLeast = 0.5;  // thin mucosa lets light through: there are no black slits at roots
  constexpr double kDark = 2.0;   // beyond what is hidden: what is reflected there goes through wet mucosa again
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
    paint.openness = to_byte(paint.openness / 255.0 * open);
  }
}

}  // namespace

MeshBuffer fimbriae(const FimbriaSite& site) {
  MeshBuffer b;
  add_bell(b, site);
  const std::vector<Frond> fronds = fronds_of(site);
  for (int i = 0; i < kRimFronds + kFoldFronds; ++i) {
    const Frond& f = fronds[std::size_t(i)];
    add_frond(b, f, site, i < kRimFronds ? root_loop(site, i) : add_root(b, f, site));
  }
  shade(b);
  return b;
}

double bell_flare(double before) {
  const double u = std::clamp(1 - before / kBellLength, 0.0, 1.0);
  return 1 + (kBellFlare - 1) * u * u * (0.55 + 0.45 * u);
}

}  // namespace trocar::view
