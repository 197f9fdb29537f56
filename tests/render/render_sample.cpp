// Draws the stand-in scene from a few places and says what a frame costs; built with the tests, run by hand:
//   render_sample OUT_DIR [WIDTH HEIGHT]
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

#include <trocar/render/backend/backend.hpp>
#include <trocar/render/frame/governor.hpp>
#include <trocar/render/gl/gl_context.hpp>

#include "sample_scene.hpp"

using namespace trocar;
using namespace trocar::render;

namespace {

double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * double(t.tv_sec) + 1e-6 * double(t.tv_nsec);
}

struct Shot {
  const char* name;
  int kind;
  Vec3f eye, target;
};
constexpr Shot kShots[] = {
    {"overview", 0, {0.012f, -0.012f, 0.070f}, {0.0f, 0.004f, -0.030f}},
    {"near", 0, {0.030f, 0.008f, 0.016f}, {0.024f, 0.008f, -0.03f}},
    {"hurt", 2, {0.004f, 0.006f, 0.040f}, {0.0f, 0.008f, -0.030f}},
    {"close", 2, {-0.010f, 0.002f, 0.012f}, {-0.006f, 0.003f, -0.030f}},
    {"fat", 1, {0.005f, -0.025f, -0.010f}, {0.002f, -0.035f, -0.050f}},
    {"upper", 1, {0.020f, -0.018f, 0.030f}, {0.0f, 0.004f, -0.050f}},
};

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : ".";
  const int width = argc > 3 ? std::atoi(argv[2]) : 800, height = argc > 3 ? std::atoi(argv[3]) : 600;
  auto context = GlContext::off_screen();
  std::printf("%s\n", context->description().c_str());
  const double before = cpu_ms();
  auto backend = make_gl_backend(*context);
  std::printf("backend ready after %.0f cpu-ms\n", cpu_ms() - before);
  const Target target = Target::off_screen(width, height);
  for (const Shot& shot : kShots) {
    Frame frame;
    frame.camera = look_at(shot.eye, shot.target, {0, 1, 0});
    sample::build(*backend, shot.kind, frame);
    for (const Quality& quality : quality_levels()) {
      frame.quality = quality;
      double best = 1e9;
      for (int i = 0; i < 8; ++i) {
        frame.tick += 40;
        const double start = cpu_ms();
        draw_frame(*backend, frame, target);
        if (i == 0) {
          const int level = int(&quality - quality_levels().data());
          const std::string file = folder + "/" + shot.name + (level ? "_q" + std::to_string(level) : "") + ".png";
          if (level == 0 || level == 4) write_png(file, backend->read_pixels());
        } else {
          backend->read_pixels();
        }
        if (i > 1) best = std::min(best, cpu_ms() - start);
      }
      std::printf("%-9s scale %.2f detail %d: %.1f cpu-ms a frame\n", shot.name, double(quality.render_scale),
                  quality.detail, best);
    }
    for (const DrawItem& item : frame.items) backend->destroy_mesh(item.mesh);
  }
}
