// A plain picture of the fluids alone, to look at them without a scene: an artery on a slope spurts into a basin, a
// nozzle irrigates beside it, an instrument stirs, something smokes.
//
//   build/release/bench/fluids/fluids_picture OUT.png [SECONDS]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <trocar/fluids/fluids.hpp>
#include <trocar/fluids/optics.hpp>
#include <trocar/render/frame/image.hpp>

namespace {

using namespace trocar;
using namespace trocar::fluids;

const Vec3f kSlopePoint{-0.035f, 0, 0.035f}, kSlopeNormal{0.6f, 0, 0.8f};
constexpr float kSlopeFrom = -0.075f, kSlopeTo = -0.006f;

FluidsDescription description() {
  FluidsDescription d;
  d.pool.origin = {-0.08, -0.08, 0};
  d.droplets.capacity = 20000;
  d.droplets.film_cells = 128 * 128;
  d.droplets.film_capacity = 80'000;
  d.smoke.origin = {-0.1, -0.1, 0};
  return d;
}

struct Demo {
  FluidsModel m = build(description());
  FluidsState s = initial_state(m);
  FluidsWork w = make_work(m);
  std::vector<float> floor;
  Capsule tool{.a = {0.045f, 0.03f, 0.004f}, .b = {0.09f, 0.07f, 0.2f}, .radius = 0.0025f, .body = 9};
  std::vector<Outlet> openings;
  std::vector<SuctionIrrigator> tools;
  Boiled boiled{{-0.03, 0.03, 0.04}, 6e-9};

  Demo() {
    for (int j = 0; j < 128; ++j)
      for (int i = 0; i < 128; ++i) {
        const float x = 0.00125f * (float(i) + 0.5f) - 0.08f, y = 0.00125f * (float(j) + 0.5f) - 0.08f;
        const float bowl = 6.0f * ((x - 0.02f) * (x - 0.02f) + y * y);
        floor.push_back(bowl + 0.0015f * float(std::sin(120 * double(x)) * std::cos(90 * double(y))));
      }
  }
  static int film_at(Vec3f p) {
    const auto cell = [](float q) { return std::clamp(int((q + 0.08f) * 800), 0, 127); };
    return cell(p.y) * 128 + cell(p.x);
  }
  Contact answer(Vec3f p, float reach) const {
    const float off = dot(p - kSlopePoint, kSlopeNormal);
    if (p.x < kSlopeFrom || p.x > kSlopeTo || off > reach || off < -0.01f) return {};
    return {p - off * kSlopeNormal, kSlopeNormal, {0, 0, 0}, 0, film_at(p)};
  }
  void tick(int t) {
    const double beat = 0.55 + 0.45 * std::sin(0.0075 * t);
    Outlet o;
    o.position = {-0.04f, -0.02f, 0.042f}, o.direction = {0.5f, 0.1f, 0.86f};
    o.direction = normalised(o.direction);
    o.area = 1.0e-6, o.flow.blood = std::int64_t(1.3e6 * beat);
    openings = {o};
    tools = {{.tip = {0.05f, -0.03f, 0.05f}, .direction = {0, 0, -1}, .irrigation = t > 1200 ? 0.5 : 0.0}};
    const float sway = 0.012f * float(std::sin(0.006 * t));
    tool.a = {0.03f + sway, 0.03f, 0.002f};
    tool.va = {0.072f * float(std::cos(0.006 * t)), 0, 0};
    const FluidsInput in{openings, tools, {&tool, 1}, floor, {}, {&boiled, 1}, {}};
    begin_tick(m, in, s, w);
    for (int k = 0; k < w.droplets.questions; ++k) {
      const int i = w.droplets.asking[k];
      const DropletState& d = s.droplets;
      w.droplets.answers[k] =
          d.body[i] < 0 ? answer({w.droplets.to_x[i], w.droplets.to_y[i], w.droplets.to_z[i]}, 0.5f * d.radius[i])
                        : answer({d.x[i], d.y[i], d.z[i]}, 3 * d.radius[i]);
    }
    finish_tick(m, in, s, w);
  }
};

// ---- looking at it

struct Hit {
  float far = 1e9f;
  Vec3d colour{0, 0, 0}, normal{0, 0, 1};
  bool wet = false;
};

struct View {
  const Demo& demo;
  std::vector<float> surface;
  Vec3d eye{0.17, -0.15, 0.15}, target{0.005, 0, 0.012};
  Vec3d light = normalised(Vec3d{0.3, -0.5, 0.8});

  explicit View(const Demo& d) : demo(d) {
    for (int j = 0; j < 128; ++j)
      for (int i = 0; i < 128; ++i)
        surface.push_back(floor_at(d.m.pool, d.floor, i, j) + depth_at(d.m.pool, d.s.pool, i, j));
  }
  double height(double x, double y) const {
    const double a = std::clamp((x + 0.08) * 800 - 0.5, 0.0, 126.9), b = std::clamp((y + 0.08) * 800 - 0.5, 0.0, 126.9);
    const int i = int(a), j = int(b);
    const double fa = a - i, fb = b - j;
    const auto at = [&](int ii, int jj) { return double(surface[std::size_t(jj) * 128 + ii]); };
    return (1 - fb) * ((1 - fa) * at(i, j) + fa * at(i + 1, j)) +
           fb * ((1 - fa) * at(i, j + 1) + fa * at(i + 1, j + 1));
  }
  void look_at_ground(Vec3d dir, Hit& hit) const {
    bool above = false;
    for (double t = 0.05; t < 0.5; t += 0.0004) {
      const Vec3d p = eye + t * dir;
      if (std::fabs(p.x) > 0.08 || std::fabs(p.y) > 0.08) continue;
      if (p.z > height(p.x, p.y)) {
        above = true;
        continue;
      }
      if (!above) return;  // the cut edge of the basin
      const double h = 0.001;
      const Vec3d n = normalised(
          Vec3d{height(p.x - h, p.y) - height(p.x + h, p.y), height(p.x, p.y - h) - height(p.x, p.y + h), 2 * h});
      const int i = std::clamp(int((p.x + 0.08) * 800), 0, 127), j = std::clamp(int((p.y + 0.08) * 800), 0, 127);
      const Mix mix = mix_at(demo.m.pool, demo.s.pool, i, j);
      const double depth = double(depth_at(demo.m.pool, demo.s.pool, i, j)),
                   all = double(std::max<std::int64_t>(mix.total(), 1));
      const Rgb c = seen_through(Optics{}, {.blood = double(mix.blood) / all, .bile = double(mix.bile) / all},
                                 2 * depth, {0.62, 0.30, 0.27});
      hit = {float(t), {c.r, c.g, c.b}, n, depth > 2e-4};
      return;
    }
  }
  void look_at_slope(Vec3d dir, Hit& hit) const {
    const Vec3d n = vec_cast<double>(kSlopeNormal);
    const double t = dot(vec_cast<double>(kSlopePoint) - eye, n) / dot(dir, n);
    const Vec3d p = eye + t * dir;
    if (!(t > 0) || t > double(hit.far) || p.x < double(kSlopeFrom) || p.x > double(kSlopeTo) || std::fabs(p.y) > 0.06)
      return;
    const SmallMix& film = demo.s.droplets.film[std::size_t(Demo::film_at(vec_cast<float>(p)))];
    const double all = double(std::max<std::int64_t>(film.total(), 1));
    const Rgb c = seen_through(Optics{}, {.blood = film.blood / all}, 2 * all * 1e-15 / 1.95e-6, {0.70, 0.36, 0.32});
    hit = {float(t), {c.r, c.g, c.b}, n, film.total() > 2000};
  }
  void look_at_ball(Vec3d centre, double r, Vec3d dir, Vec3d colour, Hit& hit) const {
    const Vec3d d = centre - eye;
    const double along = dot(d, dir), rest = r * r - (dot(d, d) - along * along);
    if (!(rest > 0) || along - std::sqrt(rest) > double(hit.far)) return;
    const double t = along - std::sqrt(rest);
    hit = {float(t), colour, (eye + t * dir - centre) / r, true};
  }
  Vec3d shade(const Hit& hit, Vec3d dir) const {
    const double lit = 0.25 + 0.75 * std::max(dot(hit.normal, light), 0.0);
    const Vec3d half = normalised(light - dir);
    const double glint = hit.wet ? 0.5 * std::exp(-300 * (1 - std::max(dot(half, hit.normal), 0.0))) : 0.0;
    return lit * hit.colour + Vec3d{glint, glint, glint};
  }
};

/// Balls by the columns of pixels that they may cover, so that not every ray asks every drop.
render::Image picture(const Demo& demo, int width, int height) {
  const View view(demo);
  const Vec3d ahead = normalised(view.target - view.eye), right = normalised(cross(ahead, Vec3d{0, 0, 1}));
  const Vec3d up = cross(right, ahead);
  struct Ball {
    Vec3d centre, colour;
    double r;
  };
  std::vector<std::vector<Ball>> column(std::size_t(width), std::vector<Ball>{});
  const auto add = [&](Vec3d c, double r, Vec3d colour) {
    const Vec3d d = c - view.eye;
    const double z = dot(d, ahead), x = dot(d, right) / z, reach = r / z * 1.2;
    const auto px = [&](double q) { return std::clamp(int((q / 0.9 + 0.5) * width), 0, width - 1); };
    for (int i = px(x - reach); i <= px(x + reach); ++i) column[std::size_t(i)].push_back({c, colour, r});
  };
  const DropletState& d = demo.s.droplets;
  for (int i = 0; i < d.count; ++i) {
    const double all = double(std::max<std::int64_t>(d.volume[i].total(), 1));
    const Rgb c = seen_through(Optics{}, {.blood = d.volume[i].blood / all}, 2 * double(d.radius[i]), {0.55, 0.5, 0.5});
    add({d.x[i], d.y[i], d.z[i]}, double(d.radius[i]), {c.r, c.g, c.b});
  }
  for (int k = 0; k < 120; ++k)
    add(vec_cast<double>(demo.tool.a + (float(k) / 119) * (demo.tool.b - demo.tool.a)), double(demo.tool.radius),
        {0.6, 0.6, 0.62});
  render::Image image{width, height, std::vector<std::uint8_t>(std::size_t(3 * width * height))};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double a = 0.9 * ((x + 0.5) / width - 0.5), b = 0.9 * (0.5 * height - y - 0.5) / width;
      const Vec3d dir = normalised(ahead + a * right + b * up);
      Hit hit;
      view.look_at_ground(dir, hit);
      view.look_at_slope(dir, hit);
      for (const Ball& ball : column[std::size_t(x)]) view.look_at_ball(ball.centre, ball.r, dir, ball.colour, hit);
      Vec3d c = hit.far < 1e8f ? view.shade(hit, dir) : Vec3d{0.01, 0.01, 0.012};
      const double clear =
          visibility(demo.m.smoke, demo.s.smoke, view.eye, view.eye + std::min(double(hit.far), 0.4) * dir);
      c = clear * c + (1 - clear) * Vec3d{0.58, 0.60, 0.64};
      for (int k = 0; k < 3; ++k)
        image.rgb[std::size_t(3 * (y * width + x) + k)] =
            std::uint8_t(255 * std::pow(std::clamp(c[k], 0.0, 1.0), 1 / 2.2));
    }
  return image;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "fluids_picture OUT.png [SECONDS]\n");
    return 2;
  }
  Demo demo;
  const int ticks = int(1000 * (argc > 2 ? std::atof(argv[2]) : 3.0));
  for (int t = 0; t < ticks; ++t) demo.tick(t);
  const auto ml = [&](Place p) { return double(at(demo.s.ledger, p).total()) / double(kMillilitre); };
  std::printf("%d drops; mL: drops %.3f film %.3f pool %.3f; the account %s\n", demo.s.droplets.count,
              ml(Place::kDroplets), ml(Place::kFilm), ml(Place::kPool),
              audit(demo.m, demo.s) ? "balances" : "is WRONG");
  render::write_png(argv[1], picture(demo, 960, 600));
  return 0;
}
