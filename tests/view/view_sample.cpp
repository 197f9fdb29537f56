// Draws a scene from a few places, for people to look at; built with the tests, run by hand:
//   view_sample OUT_DIR [SHOT...]          (all shots without names)
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include <trocar/render/gl/gl_context.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/view/scene/scene_view.hpp>

using namespace trocar;

namespace {

double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * double(t.tv_sec) + 1e-6 * double(t.tv_nsec);
}

struct Shot {
  const char* name;
  int state;  ///< 0 start, 1 clipped and cut, 2 grasped, 3 to 5 a closed grasper 25, 8 and 0 mm above the uterus, 6 as
              ///< 1, apart
  bool outside;
  Vec3d eye, target;  ///< both zero: where the scope is
};
const Shot kShots[] = {
    {"start", 0, false, {}, {}},
    {"uterus", 0, false, {0.004, -0.105, -0.045}, {0, -0.158, -0.105}},
    {"left", 0, false, {0.030, -0.105, -0.062}, {0.045, -0.145, -0.105}},
    {"right", 0, false, {-0.028, -0.100, -0.066}, {-0.047, -0.142, -0.108}},
    {"isthmus", 0, false, {0.034, -0.125, -0.068}, {0.038, -0.152, -0.094}},
    {"fimbria", 0, false, {0.030, -0.095, -0.118}, {0.043, -0.123, -0.1335}},
    {"ovary", 0, false, {0.022, -0.105, -0.088}, {0.0435, -0.137, -0.117}},
    {"douglas", 0, false, {0.0, -0.105, -0.085}, {0.0, -0.19, -0.15}},
    {"bladder", 0, false, {0.0, -0.125, -0.055}, {0.0, -0.19, -0.085}},
    {"grasper", 0, false, {-0.008, -0.105, -0.045}, {-0.028, -0.116, -0.07}},
    {"scissors", 0, false, {0.008, -0.105, -0.05}, {0.028, -0.117, -0.07}},
    {"applier", 0, false, {0.004, -0.105, -0.045}, {0.006, -0.137, -0.055}},
    {"clipped", 1, false, {0.034, -0.122, -0.072}, {0.038, -0.152, -0.094}},
    {"cut", 1, false, {0.038, -0.135, -0.075}, {0.040, -0.152, -0.094}},
    {"grasped", 2, false, {0.020, -0.105, -0.060}, {0.040, -0.145, -0.088}},
    {"held", 2, false, {0.030, -0.120, -0.060}, {0.042, -0.145, -0.082}},
    {"sigmoid", 0, false, {0.0, -0.100, -0.115}, {-0.005, -0.135, -0.165}},
    {"bite", 1, false, {0.004, -0.122, -0.068}, {0.003, -0.151, -0.096}},
    {"hover_far", 3, false, {0.004, -0.088, -0.050}, {0.006, -0.150, -0.094}},
    {"hover_near", 4, false, {0.004, -0.088, -0.050}, {0.006, -0.150, -0.094}},
    {"touching", 5, false, {0.004, -0.088, -0.050}, {0.006, -0.150, -0.094}},
    {"sleeve_left", 0, false, {0.045, -0.105, -0.050}, {0.098, -0.082, -0.022}},
    {"stump", 1, false, {0.044, -0.136, -0.083}, {0.0395, -0.152, -0.094}},
    {"clip", 1, false, {0.036, -0.130, -0.080}, {0.034, -0.152, -0.096}},
    {"stumps", 6, false, {0.046, -0.128, -0.074}, {0.041, -0.1525, -0.0925}},
    {"outside", 0, true, {0.22, 0.12, 0.18}, {0, -0.14, -0.08}},
};

/// Two clips on the left tube and a cut between them, ends drawn apart.
void operate(const sim::Model& model, sim::State& state) {
  const int strand = std::max(0, model.strand_index("tube_left"));
  const interactions::StrandBody& body = model.strand_bodies[std::size_t(strand)];
  tissue::StrandState& tube = state.strands[std::size_t(strand)];
  for (const double s : {0.016, 0.030}) {
    interactions::Clip& clip = state.clips[std::size_t(state.clip_count++)];
    clip.strand = strand;
    clip.tool = 2;
    clip.s = s;
    clip.cover = 1;
    clip.opening[1] = 1;
    clip.axis[2] = 1;
    clip.reach = 0.0042;
    clip.length = 0.0085;
  }
  interactions::Cut& cut = state.cuts[std::size_t(state.cut_count++)];
  cut.strand = strand;
  cut.s = 0.0231;
  cut.fraction = 1;
  tissue::cut_element(tube, place_at(body, cut.s).element);
  const tissue::Skin& skin = model.solids[0].fine;  // and a bite out of the uterus
  for (std::size_t t = 0; t < skin.triangles.size(); ++t) {
    const Vec3d d = vec_cast<double>(skin.rest[std::size_t(skin.triangles[t][0])]) - Vec3d{0.004, -0.150, -0.094};
    if (std::fabs(d.x) < 0.007 && std::fabs(d.y + 0.6 * d.x) < 0.0016 && d.z > -0.01) state.parted[0][t] = 1;
  }
}

/// The closed grasper `above` the uterus [m].
void hover(const sim::Model& model, sim::State& state, sim::Work& work, double above) {
  sim::Input input = model.start;
  const Vec3d tip = Vec3d{0.008, -0.150, -0.095} + above * normalised(Vec3d{0, 0.55, 0.83});
  const kinematics::FulcrumPose pose = kinematics::inverse(model.hands[0].port, tip, double(input.tools[0].roll));
  input.tools[0] = sim::tool_input(pose, 1);
  for (int i = 0; i < 900; ++i) sim::step(model, input, state, work);
}

/// The grasper takes the left tube's ampulla and lifts it.
void grasp(const sim::Model& model, sim::State& state, sim::Work& work) {
  const int strand = std::max(0, model.strand_index("tube_left"));
  const interactions::StrandBody& body = model.strand_bodies[std::size_t(strand)];
  sim::Input input = model.start;
  const auto go = [&](Vec3d tip, double handle, int ticks) {
    const kinematics::FulcrumPose pose = kinematics::inverse(model.hands[0].port, tip, double(input.tools[0].roll));
    const sim::ToolInput from = input.tools[0];
    sim::ToolInput to = sim::tool_input(pose, float(handle));
    for (int i = 1; i <= ticks; ++i) {
      const float w = float(i) / float(ticks);
      input.tools[0] = {from.yaw + w * (to.yaw - from.yaw), from.pitch + w * (to.pitch - from.pitch), from.roll,
                        from.depth + w * (to.depth - from.depth), from.handle + w * (to.handle - from.handle)};
      sim::step(model, input, state, work);
    }
  };
  const auto at = [&] { return point_at(body, state.strands[std::size_t(strand)], place_at(body, 0.034)); };
  const Vec3d port = model.hands[0].port, before = at() + 0.02 * normalised(port - at());
  go(before, 0, 400);
  go(at() + 0.010 * normalised(at() - port), 0, 600);
  go(at() + 0.010 * normalised(at() - port), 1, 500);
  go(at() + Vec3d{-0.004, 0.012, 0.016}, 1, 800);
}

/// What a picture of the analysis view costs, from where the scope is.
void draw_figures(view::SceneView& view, render::Backend& backend, sim::State state,
                  const view::AnalysisOptions& figures) {
  view::ViewOptions options;
  options.analysis = figures;
  double update = 0, draw = 0;
  for (int i = 0; i < 6; ++i) {
    state.tick += 40;
    double before = cpu_ms();
    const render::Frame frame = view.frame(state, options);
    update = cpu_ms() - before;
    before = cpu_ms();
    render::draw_frame(backend, frame, render::Target::off_screen(800, 600));
    static_cast<void>(backend.read_pixels());
    draw = cpu_ms() - before;
  }
  std::printf("analysis: %s update %.1f draw %.1f cpu-ms\n",
              figures.strain    ? "strain"
              : figures.springs ? "springs"
                                : "forces",
              update, draw);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : ".";
  const sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/gynaecology/scene.json"));
  auto context = render::GlContext::off_screen();
  auto backend = render::make_gl_backend(*context);
  double before = cpu_ms();
  view::SceneView view(model, *backend);
  std::printf("view made in %.0f cpu-ms\n", cpu_ms() - before);
  std::vector<sim::State> states(7, sim::initial_state(model));
  operate(model, states[1]);
  sim::Work work = sim::make_work(model);
  for (sim::State& state : states)
    for (int i = 0; i < 300; ++i) sim::step(model, model.start, state, work);
  grasp(model, states[2], work);
  hover(model, states[3], work, 0.025);
  hover(model, states[4], work, 0.008);
  hover(model, states[5], work, -0.004);
  states[6] = states[1];
  if (const int tube = model.strand_index("tube_left"); tube >= 0) {  // the ends drawn apart
    std::vector<Vec3d>& x = states[6].strands[std::size_t(tube)].x;
    const auto cut = std::size_t(place_at(model.strand_bodies[std::size_t(tube)], 0.0231).element);
    for (std::size_t i = cut + 1; i < x.size(); ++i) {
      const double far = double(i - cut) / 6;
      x[i] += std::max(0.0, 1 - 0.2 * far) * Vec3d{0.006, 0.004 - 0.003 * far, 0.003};
    }
  }
  std::printf("grasper holds %d points with %.1f N\n", states[2].tools[0].holds, states[2].tools[0].pinch);

  for (const Shot& shot : kShots) {
    if (argc > 2 && std::find(argv + 2, argv + argc, std::string(shot.name)) == argv + argc) continue;
    view::ViewOptions options;
    if (shot.outside) options.camera = view::ViewOptions::Camera::outside;
    options.eye = shot.eye;
    options.target = shot.target;
    options.walls = !shot.outside;
    sim::State state = states[std::size_t(shot.state)];
    double update = 0, draw = 0;
    for (int i = 0; i < 12; ++i) {
      if (shot.state < 2)
        for (int k = 0; k < 4; ++k) sim::step(model, model.start, state, work);
      else
        state.tick += 40;
      before = cpu_ms();
      render::Frame frame = view.frame(state, options);
      update = cpu_ms() - before;
      if (length(shot.eye) > 0 && !shot.outside) {
        const float fov = frame.camera.vertical_fov;
        frame.camera = render::look_at(vec_cast<float>(shot.eye), vec_cast<float>(shot.target), {0, 0, 1});
        frame.camera.vertical_fov = fov;
        frame.camera.near_plane = 0.002f;
      }
      before = cpu_ms();
      render::draw_frame(*backend, frame, render::Target::off_screen(800, 600));
      const render::Image image = backend->read_pixels();
      draw = cpu_ms() - before;
      if (i == 11) render::write_png(folder + "/" + shot.name + ".png", image);
    }
    std::printf("%-9s update %.1f draw %.1f cpu-ms\n", shot.name, update, draw);
  }
  for (const view::AnalysisOptions& figures :
       {view::AnalysisOptions{.strain = true}, {.springs = true}, {.forces = true}})
    draw_figures(view, *backend, states[2], figures);
}
