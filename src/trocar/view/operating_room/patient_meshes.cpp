// The patient as an operating room shows one: cloth, and skin where ports go.
#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/view/base/colour_scale.hpp>
#include <trocar/view/operating_room/room_meshes.hpp>

namespace trocar::view::room {
namespace {

constexpr double kCell = 0.012;                                                  // of the cloth [m]
constexpr double kWindowSide = 0.156, kWindowLow = -0.156, kWindowHigh = 0.216;  // [m]
constexpr double kScreenHigh = 0.30, kSkirt = 0.42;                              // [m]
constexpr int kSkirtRows = 14;

double eased(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}
bool in_window(double x, double y) { return std::fabs(x) < kWindowSide && y > kWindowLow && y < kWindowHigh; }

/// Height of the body's front, or of the table.
double bare_height(const Scenery& s, double x, double y) {
  double z = s.top;
  const geometry::Figure& f = s.figure;
  if (y > f.low() && y < f.high() && std::fabs(x) < f.section(y).half) z = std::max(z, f.front(x, y));
  for (const geometry::Limb& l : f.limbs()) {
    const Vec3d a{l.a.x, l.a.y, 0}, b{l.b.x, l.b.y, 0}, p{x, y, 0};
    const double whole = dot(b - a, b - a);
    const double t = whole > 0 ? std::clamp(dot(p - a, b - a) / whole, 0.0, 1.0) : 0;
    const double r = l.radius_a + t * (l.radius_b - l.radius_a), off = length(p - a - t * (b - a));
    if (off < r) z = std::max(z, l.a.z + t * (l.b.z - l.a.z) + std::sqrt(r * r - off * off));
  }
  return z;
}

struct Cloth {
  int nx = 0, ny = 0;
  double x0 = 0, y0 = 0;
  std::vector<double> z;
  double x(int i) const { return x0 + i * kCell; }
  double y(int j) const { return y0 + j * kCell; }
  double& at(int i, int j) { return z[std::size_t(j * nx + i)]; }
  double at(int i, int j) const { return z[std::size_t(j * nx + i)]; }
};

/// Cloth lies on what is below and is taut between.
Cloth cloth_over(const Scenery& s) {
  Cloth c;
  const double side = s.table_width / 2 + 0.02, low = s.figure.soles() - 0.05, high = 0.40;
  c.nx = int(2 * side / kCell) + 1;
  c.ny = int((high - low) / kCell) + 1;
  c.x0 = -0.5 * (c.nx - 1) * kCell;
  c.y0 = high - (c.ny - 1) * kCell;
  std::vector<double> floor(std::size_t(c.nx * c.ny));
  for (int j = 0; j < c.ny; ++j)
    for (int i = 0; i < c.nx; ++i) floor[std::size_t(j * c.nx + i)] = bare_height(s, c.x(i), c.y(j)) + 0.006;
  c.z = floor;
  for (int round = 0; round < 160; ++round)
    for (int j = 0; j < c.ny; ++j)
      for (int i = 0; i < c.nx; ++i) {
        const auto z = [&](int a, int b) { return c.at(std::clamp(a, 0, c.nx - 1), std::clamp(b, 0, c.ny - 1)); };
        const double mean = 0.25 * (z(i - 1, j) + z(i + 1, j) + z(i, j - 1) + z(i, j + 1));
        double& here = c.at(i, j);
        here = std::max(floor[std::size_t(j * c.nx + i)], 0.3 * here + 0.7 * (mean - 0.00055));
      }
  for (int j = 0; j < c.ny; ++j)  // creases
    for (int i = 0; i < c.nx; ++i) {
      const double x = c.x(i), y = c.y(j);
      const double over = c.at(i, j) - floor[std::size_t(j * c.nx + i)];
      c.at(i, j) += 0.1 * std::min(over, 0.03) * std::sin(38 * (y + 0.6 * x) + 2 * std::sin(9 * x));
    }
  return c;
}

Colour shade_of(double z, double top) { return darker(kDrape, 0.42 * (1 - eased((z - top + 0.30) / 0.42))); }

}  // namespace

MeshBuffer drape_mesh(const Scenery& s) {
  MeshBuffer b;
  const Cloth c = cloth_over(s);
  std::vector<std::uint32_t> of(std::size_t(c.nx * c.ny));
  for (int j = 0; j < c.ny; ++j)
    for (int i = 0; i < c.nx; ++i) {
      const double rim = std::max({std::fabs(c.x(i)) - kWindowSide, kWindowLow - c.y(j), c.y(j) - kWindowHigh});
      const double up = rim > 0 ? 0.006 * (1 - eased(rim / 0.03)) : 0.0;  // a doubled edge around the window
      Colour colour = shade_of(c.at(i, j), s.top);
      if (rim > 0 && rim < 0.028) colour = mixed(colour, {150, 190, 196}, 0.55);
      of[std::size_t(j * c.nx + i)] = b.add(vec_cast<float>(Vec3d{c.x(i), c.y(j), c.at(i, j) + up}), colour.paint());
    }
  const auto vertex = [&](int i, int j) { return of[std::size_t(j * c.nx + i)]; };
  for (int j = 0; j + 1 < c.ny; ++j)
    for (int i = 0; i + 1 < c.nx; ++i) {
      if (in_window(c.x(i) + kCell / 2, c.y(j) + kCell / 2)) continue;
      b.quad(vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1));
    }
  // what hangs: down one side from the head, along the feet, up the other side
  struct Edge {
    Vec3d place, out;
    std::uint32_t vertex;
    double way;
  };
  std::vector<Edge> edge;
  double way = 0;
  const auto put = [&](int i, int j, Vec3d out) {
    const Vec3d p{c.x(i), c.y(j), c.at(i, j)};
    if (!edge.empty()) way += std::max(length(p - edge.back().place), 0.0);
    edge.push_back({p, out, vertex(i, j), way});
  };
  for (int j = c.ny - 1; j > 0; --j) put(0, j, {-1, 0, 0});
  for (int k = 0; k <= 4; ++k) {
    const double a = portable::pi / 2 * k / 4;
    put(0, 0, {-std::cos(a), -std::sin(a), 0});
  }
  for (int i = 1; i < c.nx - 1; ++i) put(i, 0, {0, -1, 0});
  for (int k = 0; k <= 4; ++k) {
    const double a = portable::pi / 2 * k / 4;
    put(c.nx - 1, 0, {std::sin(a), -std::cos(a), 0});
  }
  for (int j = 1; j < c.ny; ++j) put(c.nx - 1, j, {1, 0, 0});
  std::vector<std::uint32_t> before;
  for (const Edge& e : edge) before.push_back(e.vertex);
  for (int row = 1; row <= kSkirtRows; ++row) {
    const double t = double(row) / kSkirtRows;
    std::vector<std::uint32_t> now;
    for (const Edge& e : edge) {
      const double wave = std::sin(26 * e.way + 1.3 * std::sin(5 * e.way)) + 0.5 * std::sin(47 * e.way + 2);
      const double away = 0.035 * std::sqrt(t) + 0.020 * t * wave;
      const double bottom = s.top - kSkirt - 0.015 * std::sin(6 * e.way);
      const double z = e.place.z + t * (bottom - e.place.z);
      const Vec3d p = e.place + away * e.out;
      const Colour colour = darker(shade_of(z, s.top), 0.10 * t * (1 - wave));
      now.push_back(b.add(vec_cast<float>(Vec3d{p.x, p.y, z}), colour.paint()));
    }
    for (std::size_t k = 0; k + 1 < now.size(); ++k) b.quad(before[k], now[k], now[k + 1], before[k + 1]);
    before = now;
  }
  // the screen before the head
  before.clear();
  for (int i = 0; i < c.nx; ++i) before.push_back(vertex(i, c.ny - 1));
  for (int row = 1; row <= 20; ++row) {
    const double t = row / 20.0;
    std::vector<std::uint32_t> now;
    for (int i = 0; i < c.nx; ++i) {
      const double z0 = c.at(i, c.ny - 1), x = c.x(i);
      const double z = z0 + t * (kScreenHigh - z0), sag = 0.012 * std::sin(24 * x + 3 * std::sin(4 * x)) * (1 - t);
      now.push_back(b.add(vec_cast<float>(Vec3d{x * (1 + 0.14 * t), 0.40 + 0.05 * t + sag, z}),
                          darker(kDrape, 0.06 + 0.10 * (1 - t)).paint()));
    }
    for (int i = 0; i + 1 < c.nx; ++i)
      b.quad(before[std::size_t(i)], before[std::size_t(i) + 1], now[std::size_t(i) + 1], now[std::size_t(i)]);
    before = now;
  }
  return b;
}

MeshBuffer skin_mesh(const Scenery& s) {
  constexpr double kFine = 0.004, kUnder = 0.028;  // under the cloth's edge [m]
  MeshBuffer b;
  const Colour plain{206, 150, 116}, warm{188, 128, 92};  // as disinfected
  const int nx = int(2 * (kWindowSide + kUnder) / kFine) + 1,
            ny = int((kWindowHigh - kWindowLow + 2 * kUnder) / kFine) + 1;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const double x = -kWindowSide - kUnder + i * kFine, y = kWindowLow - kUnder + j * kFine;
      double z = s.figure.front(x, y);
      const double navel = std::sqrt(x * x / 1.2 + y * y);
      z -= 0.007 * std::exp(-navel * navel / (2 * 0.006 * 0.006));
      Colour colour = mixed(plain, warm, 0.5 + 0.5 * std::sin(31 * x + 2 * std::sin(17 * y)) * std::sin(23 * y));
      colour = mixed(colour, darker(warm, 0.45), std::exp(-navel * navel / (2 * 0.008 * 0.008)));
      double sum = 0, weight = 0;
      for (const Vec3d& h : s.heat) {
        const double dx = (x - h.x) / s.heat_spacing, dy = (y - h.y) / s.heat_spacing, d2 = dx * dx + dy * dy;
        if (d2 > 4 || h.z < 0) continue;
        const double w = std::exp(-2.2 * d2);
        sum += w * h.z;
        weight += w;
      }
      if (weight > 0.02) {
        const double value = sum / weight;
        const view::Colour on = colour_on(Scale::sequential, value);
        const Colour heat{to_byte(on.r), to_byte(on.g), to_byte(on.b)};
        colour = mixed(colour, heat, 0.9 * eased(weight / 0.35) * eased((value - 0.01) / 0.25));
      }
      b.add(vec_cast<float>(Vec3d{x, y, z}), colour.paint());
    }
  for (int j = 0; j + 1 < ny; ++j)
    for (int i = 0; i + 1 < nx; ++i) {
      const auto v = [&](int a, int c) { return std::uint32_t(c * nx + a); };
      b.quad(v(i, j), v(i + 1, j), v(i + 1, j + 1), v(i, j + 1));
    }
  return b;
}

MeshBuffer head_mesh(const Scenery& s) {
  MeshBuffer b;
  const std::vector<geometry::Limb>& l = s.figure.limbs();
  const Colour skin{205, 158, 134};
  add_rod(b, l[0].a, l[0].b, l[0].radius_a, l[0].radius_b, skin);
  add_rod(b, l[1].a, l[1].b, l[1].radius_a, l[1].radius_b, skin, 40);
  add_rod(b, l[1].a + Vec3d{0, 0.035, -0.018}, l[1].b + Vec3d{0, 0.012, -0.012}, l[1].radius_a + 0.002,
          l[1].radius_b + 0.006, {128, 168, 186}, 40);  // cap
  add_box(b, {0, l[1].a.y + 0.03, s.top + 0.02}, Mat3d::identity(), {0.17, 0.12, 0.035}, 0.03, {214, 220, 224});
  return b;
}

MeshBuffer table_mesh(const Scenery& s) {
  MeshBuffer b;
  const double from = s.figure.soles() - 0.04, to = s.figure.crown() + 0.06, half = s.table_thickness / 2;
  add_box(b, {0, (from + to) / 2, s.top - half}, Mat3d::identity(), {s.table_width / 2, (to - from) / 2, half}, 0.02,
          kCushion);
  for (const double side : {-1.0, 1.0})
    add_box(b, {side * (s.table_width / 2 + 0.012), 0.15, s.top - s.table_thickness}, Mat3d::identity(),
            {0.006, 0.42, 0.014}, 0.004, kSteel);
  add_box(b, {0, 0.0, s.top - s.table_thickness - 0.05}, Mat3d::identity(), {0.19, 0.42, 0.05}, 0.02, kGunmetal);
  // poles of the screen
  for (const double side : {-1.0, 1.0}) {
    const double x = side * (s.table_width / 2 + 0.045);
    add_rod(b, {x, 0.42, s.top - 0.02}, {x, 0.452, 0.305}, 0.008, 0.008, kSteel, 16);
  }
  add_rod(b, {-s.table_width / 2 - 0.045, 0.452, 0.305}, {s.table_width / 2 + 0.045, 0.452, 0.305}, 0.008, 0.008,
          kSteel, 16);
  return b;
}

MeshBuffer table_column_mesh(const Scenery& s) {
  MeshBuffer b;
  const double high = s.top - s.table_thickness - 0.12;
  add_box(b, {0, 0, (s.floor + 0.08 + high) / 2}, Mat3d::identity(), {0.13, 0.17, (high - s.floor - 0.08) / 2}, 0.03,
          kEnamel);
  add_box(b, {0, -0.05, s.floor + 0.05}, Mat3d::identity(), {0.26, 0.56, 0.05}, 0.04, kGunmetal);
  return b;
}

}  // namespace trocar::view::room
