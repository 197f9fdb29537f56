// Smoke and a lens that fogs, all of it as the simulation has it: in the bleeding scene a hook coagulates the uterus
// until the lens is fogged, then the wipe's pedal is pressed. Writes pictures before, in the smoke, fogged, wiped and
// after, and prints the fog.
//
//   lens_in_view OUT_DIR [WIDTH HEIGHT]
#include <cstdio>
#include <cstdlib>
#include <string>

#include <trocar/render/gl/gl_context.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/sim/stages/visibility.hpp>
#include <trocar/view/scene/scene_view.hpp>

using namespace trocar;

namespace {

constexpr int kHand = 1;

/// Ticks of the story.
constexpr std::uint64_t kDown = 1200, kCurrentEnds = 12'000, kWipe = 15'000, kEnd = 26'000;

struct Shot {
  std::uint64_t at;
  const char* name;
};
constexpr Shot kShots[] = {
    {1100, "clear"}, {6000, "smoke"}, {14'900, "fogged"}, {kWipe + 1300, "wiping"}, {25'500, "wiped"}};

struct Story {
  sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/bleeding/scene.json"));
  sim::State state = sim::initial_state(model);
  sim::Work work = sim::make_work(model);
  sim::Input input = model.start;
  Vec3d at;  ///< of the uterus, as drawn, nearest to the hand's port

  Story() {
    double least = 1;
    for (const Vec3f& p : model.skin(model.organ_index("uterus")).rest)
      if (const double d = length(vec_cast<double>(p) - model.hands[kHand].port); d < least)
        least = d, at = vec_cast<double>(p);
    state.tools[kHand].instrument = model.hands[kHand].find("hook");
  }
  void tick() {
    const Vec3d port = model.hands[kHand].port;
    // New tissue under the wire every second: what is charred gives little steam.
    const double along = 0.001 * double(state.tick / 1000 % 6);
    const Vec3d tip = at + Vec3d{along, 0, 0} + (state.tick < 600 ? 0.010 : -0.001) * normalised(port - at);
    input.tools[kHand] = sim::tool_input(kinematics::inverse(port, tip, 0), 0, state.tools[kHand].instrument);
    input.pedals = 0;
    if (state.tick >= kDown && state.tick < kCurrentEnds) input.pedals |= sim::kBlue;
    if (state.tick >= kWipe && state.tick < kWipe + 100) input.pedals |= sim::kWipe;
    sim::step(model, input, state, work);
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "lens_in_view OUT_DIR [WIDTH HEIGHT]\n");
    return 2;
  }
  const int width = argc > 3 ? std::atoi(argv[2]) : 800, height = argc > 3 ? std::atoi(argv[3]) : 600;
  Story story;
  auto context = render::GlContext::off_screen();
  auto backend = render::make_gl_backend(*context);
  view::SceneView view(story.model, *backend);
  const Shot* shot = std::begin(kShots);
  while (story.state.tick < kEnd && shot != std::end(kShots)) {
    story.tick();
    const fluids::SmokeState& smoke = story.state.fluids.smoke;
    if (story.state.tick % 1000 == 0)
      std::printf("%4.0f s: fog %.2f, %.2f g/m^3 at the lens\n", 1e-3 * double(story.state.tick), smoke.fog,
                  density_at(story.model.wet.model.smoke, smoke, sim::scope_of(story.model, story.state).eye));
    // As a display would ask: exposure and the wipe's smear have memories.
    const bool shown = story.state.tick == shot->at;
    if (!shown && story.state.tick % 500 != 0) continue;
    for (int k = shown ? 6 : 0; k >= 0; --k)
      draw_frame(*backend, view.frame(story.state, {}), render::Target::off_screen(width, height));
    if (!shown) continue;
    write_png(std::string(argv[1]) + "/" + shot->name + ".png", backend->read_pixels());
    std::printf("%s: fog %.2f\n", shot->name, smoke.fog);
    std::fflush(stdout);
    ++shot;
  }
}
