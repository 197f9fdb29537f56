// People in gowns, and the things about a table.
#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/view/operating_room/room_meshes.hpp>

namespace trocar::view::room {
namespace {

/// Of a gown, in statures: height, half breadth, half depth, how far forwards.
struct GownRing {
  double up, wide, deep, ahead;
};
constexpr GownRing kGownRings[] = {
    {0.20, 0.118, 0.092, 0.000},   {0.22, 0.122, 0.095, 0.000},  {0.32, 0.118, 0.090, 0.000},
    {0.44, 0.112, 0.084, 0.002},   {0.54, 0.106, 0.078, 0.004},  {0.62, 0.104, 0.074, 0.004},
    {0.70, 0.112, 0.076, 0.004},   {0.76, 0.122, 0.074, 0.002},  {0.80, 0.124, 0.064, -0.002},
    {0.825, 0.108, 0.052, -0.003}, {0.845, 0.072, 0.042, 0.000}, {0.856, 0.042, 0.036, 0.004}};

}  // namespace

MeshBuffer person_mesh(const Scenery::Person& p, double floor) {
  MeshBuffer b;
  const double h = p.stature;
  const Vec3d ahead = p.facing, left = cross(Vec3d{0, 0, 1}, ahead), up{0, 0, 1};
  const auto at = [&](double f, double s, double u) { return p.foot + h * (f * ahead + s * left + u * up); };
  const Colour gown = p.scrubbed ? kGown : Colour{104, 136, 166};
  if (p.step > 0.01)
    add_box(b, Vec3d{p.foot.x, p.foot.y, floor + p.step / 2}, Mat3d::from_columns(left, -ahead, up),
            {0.28, 0.19, p.step / 2}, 0.01, kGunmetal);
  for (const double side : {-1.0, 1.0}) {  // legs and shoes
    add_rod(b, at(0, side * 0.050, 0.05), at(0, side * 0.055, 0.36), 0.030 * h, 0.046 * h, kTrousers);
    add_rod(b, at(-0.020, side * 0.052, 0.020), at(0.055, side * 0.062, 0.016), 0.020 * h, 0.018 * h, {228, 230, 230});
  }
  std::vector<std::vector<Vec3d>> rings;
  std::vector<Colour> colours;
  constexpr int kAround = 72;
  for (const GownRing& r : kGownRings) {
    std::vector<Vec3d> ring;
    const double loose = std::clamp((0.60 - r.up) / 0.4, 0.0, 1.0);
    for (int k = 0; k < kAround; ++k) {
      const double a = portable::two_pi * k / kAround;
      const double fold = 1 + 0.035 * loose * std::sin(9 * a + 7 * r.up) + 0.02 * loose * std::sin(17 * a);
      ring.push_back(at(r.ahead + fold * r.deep * std::sin(a), -fold * r.wide * std::cos(a), r.up));
    }
    std::reverse(ring.begin(), ring.end());
    rings.push_back(std::move(ring));
    colours.push_back(darker(gown, 0.30 * std::clamp((0.62 - r.up) / 0.42, 0.0, 1.0)));
  }
  add_loft(b, rings, colours);
  for (int side = 0; side < 2; ++side) {
    const Vec3d s = p.shoulder[side] - 0.012 * h * up, e = p.elbow[side], w = p.hand[side];
    const Vec3d wrist = e + 0.86 * (w - e);
    add_rod(b, s, e, 0.041 * h, 0.033 * h, gown);
    add_rod(b, e, wrist, 0.033 * h, 0.024 * h, gown);
    add_rod(b, e + 0.80 * (w - e), w, 0.021 * h, 0.023 * h, p.scrubbed ? kGlove : kSkin);
  }
  // neck, head, cap, mask
  const Colour skin{208, 160, 134};
  add_rod(b, at(0.004, 0, 0.845), at(0.010, 0, 0.885), 0.032 * h, 0.032 * h, skin);
  add_rod(b, at(0.014, 0, 0.908), at(0.008, 0, 0.944), 0.044 * h, 0.052 * h, skin, 72);
  add_rod(b, at(0.001, 0, 0.955), at(-0.004, 0, 0.960), 0.0595 * h, 0.0575 * h, gown, 72);
  add_rod(b, at(0.022, 0, 0.897), at(0.024, 0, 0.916), 0.041 * h, 0.0395 * h, kMask, 72);
  return b;
}

MeshBuffer floor_mesh(const Scenery& s) {
  // grid, fading into the background; shadows are those of a wide lamp: darker the nearer what hangs above it is
  constexpr double kHalf = 5.5, kFine = 0.055;
  const int n = int(2 * kHalf / kFine) + 1;
  MeshBuffer b;
  struct Blob {
    Vec3d a, b;
    double radius, dark;
  };
  std::vector<Blob> blobs{
      {s.table * Vec3d{0, s.figure.soles(), s.top}, s.table * Vec3d{0, s.figure.crown(), s.top}, 0.36, 0.46}};
  for (const Scenery::Person& p : s.people) blobs.push_back({p.foot, p.foot + 0.1 * p.facing, 0.24, 0.42});
  for (const Scenery::Arm& a : s.arms)
    if (!a.on_table) blobs.push_back({a.foot, a.foot, 0.30, 0.45});
  for (const Scenery::Monitor& m : s.monitors) blobs.push_back({m.middle, m.middle, 0.24, 0.4});
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const Vec3d p{-kHalf + i * kFine, -kHalf + j * kFine, s.floor};
      double light = 1;
      for (const Blob& o : blobs) {
        const Vec3d a{o.a.x, o.a.y, p.z}, c{o.b.x, o.b.y, p.z};
        const double whole = dot(c - a, c - a), t = whole > 0 ? std::clamp(dot(p - a, c - a) / whole, 0.0, 1.0) : 0;
        const double d = length(p - a - t * (c - a)) / o.radius;
        light *= 1 - o.dark * std::exp(-0.8 * d * d);
      }
      const double away = std::clamp((length(Vec3d{p.x, p.y, 0}) - 1.2) / 3.6, 0.0, 1.0);
      const Colour lit = darker({196, 203, 206}, 1 - light);
      b.add(vec_cast<float>(p), mixed(lit, {222, 227, 229}, away * away * (3 - 2 * away)).paint());
    }
  for (int j = 0; j + 1 < n; ++j)
    for (int i = 0; i + 1 < n; ++i) {
      const auto v = [&](int a, int c) { return std::uint32_t(c * n + a); };
      b.quad(v(i, j), v(i + 1, j), v(i + 1, j + 1), v(i, j + 1));
    }
  return b;
}

MeshBuffer monitor_mesh(const Scenery::Monitor& m, double floor) {
  MeshBuffer b;
  const Vec3d ahead = m.axes.column(1);
  add_box(b, m.middle - 0.01 * ahead, m.axes, {m.half.x + 0.015, m.half.y, m.half.z + 0.015}, 0.012, kGunmetal);
  // what it shows: the endoscope's round picture, dimly
  const std::uint32_t centre =
      b.add(vec_cast<float>(m.middle + (m.half.y + 0.002 - 0.01) * ahead), Paint{150, 78, 66, 255});
  std::uint32_t before = 0;
  constexpr int kSides = 64;
  for (const auto& [share, colour] : {std::pair(0.6, Colour{128, 58, 50}), std::pair(0.97, Colour{66, 26, 24})}) {
    const std::uint32_t first = b.size();
    for (int k = 0; k < kSides; ++k) {
      const double a = portable::two_pi * k / kSides;
      const Vec3d p =
          m.middle + m.axes * Vec3d{share * m.half.z * std::cos(a), m.half.y - 0.008, -share * m.half.z * std::sin(a)};
      b.add(vec_cast<float>(p), colour.paint());
    }
    if (before == 0)
      join_pole(b, first, kSides, centre, true);
    else
      join_rows(b, first, before, kSides, true);
    before = first;
  }
  const Vec3d foot{m.middle.x - 0.06 * ahead.x, m.middle.y - 0.06 * ahead.y, floor};
  add_rod(b, foot + Vec3d{0, 0, 0.04}, Vec3d{foot.x, foot.y, m.middle.z}, 0.025, 0.025, kEnamel);
  add_cylinder(b, foot, foot + Vec3d{0, 0, 0.045}, 0.24, kEnamel);
  return b;
}

MeshBuffer port_mesh(const Scenery::Port& p) {
  MeshBuffer b;
  const double r = p.radius + 0.0012;
  const Colour body = p.radius > 0.004 ? Colour{74, 96, 150} : Colour{186, 196, 204};
  add_cylinder(b, p.place - 0.03 * p.out, p.place + 0.020 * p.out, r, {212, 218, 222}, 24);
  add_cylinder(b, p.place + 0.016 * p.out, p.place + 0.046 * p.out, r + 0.0065, body, 32);
  add_cylinder(b, p.place + 0.044 * p.out, p.place + 0.052 * p.out, r + 0.0045, darker(body, 0.3), 32);
  return b;
}

MeshBuffer handle_mesh(const Scenery::Instrument& i) {
  MeshBuffer b;
  const double whole = length(i.handle - i.tip);
  const Vec3d out = (i.handle - i.tip) / whole;
  add_cylinder(b, i.tip, i.handle - 0.01 * out, i.radius, kSteel, 24);
  if (i.camera) {
    add_cylinder(b, i.handle - 0.05 * out, i.handle - 0.02 * out, 0.011, kGunmetal);
    add_cylinder(b, i.handle - 0.02 * out, i.handle + 0.075 * out, 0.021, {206, 210, 214});
    add_cylinder(b, i.handle + 0.073 * out, i.handle + 0.083 * out, 0.017, kRubber);
    const auto [u, v] = across(out);
    add_rod(b, i.handle - 0.035 * out, i.handle - 0.035 * out + 0.05 * v, 0.006, 0.005, kSteel);  // light post
    return b;
  }
  Vec3d down = Vec3d{0, 0, -1} - dot(Vec3d{0, 0, -1}, out) * out;
  down = length(down) > 0.1 ? down / length(down) : across(out).first;
  add_rod(b, i.handle - 0.045 * out, i.handle + 0.02 * out, 0.010, 0.013, kGunmetal);
  add_rod(b, i.handle + 0.015 * out, i.handle + 0.035 * out + 0.075 * down, 0.010, 0.008, kGunmetal);
  add_rod(b, i.handle - 0.010 * out, i.handle - 0.012 * out + 0.065 * down, 0.006, 0.006, kSteel);
  return b;
}

}  // namespace trocar::view::room
