// Fluids as the endoscope shows them, in the gynaecology scene standing still: an artery on the uterus spurts, blood
// runs down and gathers behind it, a nozzle washes it, something smokes, the lens fogs and is wiped. Writes pictures at
// moments and prints what drawing fluids costs, all together and one by one.
//
//   fluids_in_view OUT_DIR [WIDTH HEIGHT] [DETAIL]
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include <trocar/fluids/fluids.hpp>
#include <trocar/render/gl/gl_context.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/view/fluids/fluid_drawing.hpp>
#include <trocar/view/fluids/lens.hpp>
#include <trocar/view/fluids/smoke_drawing.hpp>
#include <trocar/view/scene/scene_view.hpp>

#include "organ_contacts.hpp"

using namespace trocar;

namespace {

double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * double(t.tv_sec) + 1e-6 * double(t.tv_nsec);
}

fluids::FluidsDescription description(const sim::Model& model, std::size_t places) {
  fluids::FluidsDescription d;
  const Vec3d up = normalised(-model.gravity);
  d.pool.u = {1, 0, 0};
  d.pool.v = normalised(cross(up, d.pool.u));
  const Vec3d middle{0, -0.150, -0.165};
  d.pool.origin = middle - 0.08 * d.pool.u - 0.08 * d.pool.v;
  d.droplets.capacity = 12000;
  d.droplets.film_cells = int(places);
  d.droplets.film_capacity = 60'000;  // 27 um
  d.droplets.gravity = model.gravity;
  d.smoke.origin = {-0.1, -0.24, -0.19};
  return d;
}

/// Seconds of the story.
struct Story {
  double cut = 0.2, clipped = 5.2, water = 5.8, dry = 9.0, smoke = 9.4, smoke_ends = 14.0, wipe = 16.0, end = 25;
};

struct Demo {
  const Story story;
  sim::Model scene = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/gynaecology/scene.json"));
  sim::State state = settled(scene);
  OrganContacts contacts{scene, state};
  fluids::FluidsModel m = fluids::build(description(scene, contacts.places().size()));
  fluids::FluidsState s = initial_state(m);
  fluids::FluidsWork w = make_work(m);
  std::vector<float> floor;
  std::vector<view::FilmPlace> places = contacts.places();
  Vec3f artery, outward, vein, vein_outward;
  std::uint64_t t = 0;

  Demo() {
    const int holds[] = {solid("bowel"), solid("rectosigmoid"), solid("sigmoid")};
    floor = contacts.floor_of(m.pool, holds);
    // On the uterus, where the scope sees it from above.
    const OrganContacts::Near near = contacts.first_on_way({-0.0110f, -0.100f, -0.040f}, {-0.0125f, -0.152f, -0.100f});
    artery = near.point, outward = near.normal;
    const OrganContacts::Near other = contacts.first_on_way({0.008f, -0.120f, -0.030f}, {0.010f, -0.158f, -0.100f});
    vein = other.point, vein_outward = other.normal;
    std::printf("artery at %.3f %.3f %.3f, %zu places\n", double(artery.x), double(artery.y), double(artery.z),
                places.size());
  }
  static sim::State settled(const sim::Model& model) {
    sim::State state = sim::initial_state(model);
    sim::Work work = sim::make_work(model);
    for (int i = 0; i < 300; ++i) sim::step(model, model.start, state, work);
    return state;
  }
  int solid(const std::string& look) const {
    const auto at = std::find_if(scene.solids.begin(), scene.solids.end(),
                                 [&](const auto& body) { return body.look == look || body.name == look; });
    return at == scene.solids.end() ? -1 : int(at - scene.solids.begin());
  }
  fluids::Contact answer(const OrganContacts::Near& near, float reach) const {
    if (near.triangle < 0 || near.off > reach) return {};
    return {near.point, near.normal, {0, 0, 0}, contacts.body_of(near.triangle), contacts.place_at(near.point)};
  }
  /// Flow over a heart beat of 0.83 s: up in 0.1 s, then down.
  static double beat(double time) {
    const double phase = time / 0.83 - std::floor(time / 0.83);
    return 0.45 + 0.85 * (phase < 0.14 ? phase / 0.14 : std::exp(-(phase - 0.14) / 0.22));
  }
  void tick() {
    const double time = 1e-3 * double(++t);
    std::vector<fluids::Outlet> openings;
    if (time > story.cut && time < story.clipped) {
      fluids::Outlet o;
      o.direction = normalised(0.6f * outward + Vec3f{-0.22f, 0.22f, 1.0f});
      o.position = artery + 0.001f * outward;
      o.area = 2.0e-6;
      o.flow.blood = std::int64_t(1.7e6 * beat(time));  // 1.6 mm wide, 90 mL/min
      openings.push_back(o);
      o = {};
      o.direction = vein_outward, o.position = vein + 0.0008f * vein_outward;
      o.area = 5.0e-6;
      o.flow.blood = 330'000;  // 20 mL/min, wells up
      openings.push_back(o);
    }
    std::vector<fluids::SuctionIrrigator> tools;
    if (time > story.water && time < story.dry) {
      const float sway = 0.006f * float(std::sin(2.2 * time));
      tools.push_back({.tip = {-0.016f + sway, -0.108f, -0.095f},
                       .direction = normalised(Vec3f{-0.10f, -0.30f, -0.9f}),
                       .irrigation = 0.55});
    }
    const bool smokes = time > story.smoke && time < story.smoke_ends;
    const fluids::Boiled boiled{{-0.022, -0.150, -0.092}, smokes ? 9e-9 : 0};
    fluids::FluidsInput in{openings, tools, {}, floor, {}, {&boiled, 1}, {}};
    in.smoke.coagulating = smokes;
    in.smoke.lens = {0, -0.066, -0.0485};
    in.smoke.wipe = t == std::uint64_t(1000 * story.wipe);
    begin_tick(m, in, s, w);
    const fluids::DropletState& d = s.droplets;
    for (int k = 0; k < w.droplets.questions; ++k) {
      const auto i = std::size_t(w.droplets.asking[std::size_t(k)]);
      const Vec3f now{d.x[i], d.y[i], d.z[i]};
      const Vec3f next{w.droplets.to_x[i], w.droplets.to_y[i], w.droplets.to_z[i]};
      w.droplets.answers[std::size_t(k)] = d.body[i] < 0 ? answer(contacts.first_on_way(now, next), 0.5f * d.radius[i])
                                                         : answer(contacts.nearest(now), 3 * d.radius[i]);
    }
    for (int k = 0; k < w.droplets.film_questions; ++k) {
      const std::int32_t place = w.droplets.overfull[std::size_t(k)];
      const view::FilmPlace& at = places[std::size_t(place)];
      w.droplets.film_answers[std::size_t(k)] = {at.position, at.normal, {0, 0, 0}, 0, place};
    }
    finish_tick(m, in, s, w);
  }
};

struct Shot {
  double at;
  const char* name;
  int camera;  ///< 0 the scope at the start, 1 nearer, 2 at the pool
};
const Shot kShots[] = {{0.60, "spurt", 0},     {1.6, "run_early", 0},    {3.0, "run", 0},
                       {3.05, "jet_close", 1}, {5.1, "pool", 0},         {5.12, "pool_close", 2},
                       {6.6, "water", 0},      {8.8, "diluted", 0},      {8.85, "diluted_close", 2},
                       {10.5, "smoke", 0},     {13.9, "thick_smoke", 0}, {15.9, "fogged", 0},
                       {17.2, "wipe", 0},      {24.5, "wiped", 0}};

}  // namespace

/// Processor time of a frame at 640 x 480, at each detail, with one kind of thing in it at a time.
void print_costs(render::Backend& backend, const render::Frame& full, const char* name) {
  const char* parts[] = {"none", "splats", "sheet", "smoke", "fog", "lens", "all"};
  std::printf("%s, cpu-ms at 640 x 480:", name);
  for (const char* part : parts) std::printf(" %7s", part);
  std::printf("\n");
  for (int detail = 2; detail >= 0; --detail) {
    std::printf("  detail %d           ", detail);
    for (int k = 0; k < 7; ++k) {
      render::Frame frame = full;
      frame.quality.detail = detail;
      if (k != 1 && k != 6) frame.liquid.splats.clear();
      if (k != 2 && k != 6) frame.liquid.triangles.clear();
      if (k != 3 && k != 6) frame.smoke.density.clear();
      if (k < 4) frame.look.soil = {};
      if (k == 4) frame.look.soil.drop_count = 0, frame.look.soil.wipe = -1, frame.look.soil.smear = 0;
      double best = 1e9;
      for (int i = 0; i < 9; ++i) {
        const double before = cpu_ms();
        draw_frame(backend, frame, render::Target::off_screen(640, 480));
        backend.read_pixels();
        best = std::min(best, cpu_ms() - before);
      }
      std::printf(" %7.1f", best);
    }
    std::printf("\n");
  }
}

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "fluids_in_view OUT_DIR [WIDTH HEIGHT] [DETAIL]\n");
    return 2;
  }
  const std::string folder = argv[1];
  const int width = argc > 3 ? std::atoi(argv[2]) : 800, height = argc > 3 ? std::atoi(argv[3]) : 600;
  const int detail = argc > 4 ? std::atoi(argv[4]) : 2;
  Demo demo;
  auto context = render::GlContext::off_screen();
  auto backend = render::make_gl_backend(*context);
  view::SceneView view(demo.scene, *backend);
  view::FluidDrawing drawing(demo.m);
  view::Lens lens;
  const auto frame_of = [&](int camera, bool with_fluids) {
    view::ViewOptions options;
    options.quality.detail = detail;
    if (camera > 0) {
      options.camera = view::ViewOptions::Camera::inside;
      options.eye = camera > 1 ? Vec3d{-0.010, -0.086, -0.100} : Vec3d{0.006, -0.088, -0.075};
      options.target = camera > 1 ? Vec3d{-0.012, -0.140, -0.160} : Vec3d{0.010, -0.146, -0.128};
    }
    sim::State now = demo.state;
    now.tick = demo.t;
    options.eye_index = with_fluids;
    render::Frame frame = view.frame(now, options);
    if (!with_fluids) return frame;
    drawing.list({.state = demo.s, .floor = demo.floor, .places = demo.places}, frame);
    view::list_smoke(demo.m.smoke, demo.s.smoke, frame);
    lens.list(demo.m.smoke, demo.s.smoke, frame);
    return frame;
  };
  std::printf("%-14s %6s %6s %6s %6s | cpu-ms: list, without, with fluids, added | fog\n", "picture", "drops", "splats",
              "sheet", "pool");
  bool splashed = false;
  for (const Shot& shot : kShots) {
    while (1e-3 * double(demo.t) < shot.at) {
      demo.tick();
      if (!splashed && 1e-3 * double(demo.t) > demo.story.dry) {
        lens.splash(0.6, {.blood = 1, .saline = 3}, 7);
        splashed = true;
      }
      if (demo.t % 200 == 0) frame_of(0, true);  // as a display would ask; the lens' memory runs
    }
    for (int k = 0; k < 8; ++k)
      draw_frame(*backend, frame_of(shot.camera, true), render::Target::off_screen(width, height));
    double cost[2] = {1e9, 1e9}, list = 1e9;
    for (int i = 0; i < 5; ++i)
      for (const bool with : {false, true}) {
        const double before = cpu_ms();
        const render::Frame frame = frame_of(shot.camera, with);
        const double listed = cpu_ms();
        draw_frame(*backend, frame, render::Target::off_screen(width, height));
        const render::Image image = backend->read_pixels();
        cost[with] = std::min(cost[with], cpu_ms() - listed);
        if (with) list = std::min(list, listed - before);
        if (with && i == 4) {
          write_png(folder + "/" + shot.name + ".png", image);
          std::printf("%-14s %6d %6zu %6zu %6.2f | %5.1f %6.1f %6.1f %6.1f | %.2f\n", shot.name, demo.s.droplets.count,
                      frame.liquid.splats.size(), frame.liquid.triangles.size() / 3,
                      double(at(demo.s.ledger, fluids::Place::kPool).total()) / double(fluids::kMillilitre), list,
                      cost[0], cost[1], cost[1] - cost[0], demo.s.smoke.fog);
        }
      }
    const std::string name = shot.name;
    if (name == "pool_close" || name == "wipe") print_costs(*backend, frame_of(shot.camera, true), shot.name);
    std::fflush(stdout);
  }
  std::printf("the account %s\n", audit(demo.m, demo.s) ? "balances" : "is WRONG");
}
