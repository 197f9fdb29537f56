// What levels of detail save and change, from near to far; built with the tests, run by hand:
//   detail_sample OUT_DIR
// For each distance: in full, by distance, borders at 1 / 2.5 of it: triangles, processor time of the opaque pass, mean
// difference to the full picture (of 255); pictures of them and of eight times their difference. And what the levels
// cost when a scene is opened.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include <trocar/render/gl/gl_context.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/view/scene/scene_view.hpp>

using namespace trocar;

namespace {

constexpr float kFull = 1e-6f;
constexpr int kRounds = 15;
const Vec3d kTarget{0.040, -0.150, -0.098}, kTowardsEye{-0.25, 0.75, 0.61};

class Sample {
 public:
  explicit Sample(const sim::Model& model)
      : m_context(render::GlContext::off_screen()),
        m_backend(render::make_gl_backend(*m_context)),
        m_view(std::make_unique<view::SceneView>(model, *m_backend)),
        m_state(sim::initial_state(model)) {}

  struct Drawn {
    render::Image image;
    std::uint64_t triangles = 0;
    double opaque_ms = 0;
  };
  Drawn draw(double distance, float coarser) {
    view::ViewOptions options;
    options.camera = view::ViewOptions::Camera::inside;
    options.eye = kTarget + distance * normalised(kTowardsEye);
    options.target = kTarget;
    options.quality.coarser = coarser;
    options.instruments = false;
    render::Frame frame = m_view->frame(m_state, options);
    frame.look.noise = 0;
    std::vector<double> ms;
    Drawn drawn;
    for (int i = 0; i < kRounds; ++i) {
      frame.tick = std::uint64_t(2000 * i);  // the exposure settles
      std::vector<render::PassCost> costs;
      const std::uint64_t before = m_backend->stats().triangles;
      m_backend->profile(&costs);
      render::draw_frame(*m_backend, frame, render::Target::off_screen(800, 600));
      m_backend->profile(nullptr);
      drawn.triangles = m_backend->stats().triangles - before;
      for (const render::PassCost& c : costs)
        if (c.pass == std::string("opaque")) ms.push_back(c.processor_ms);
    }
    std::nth_element(ms.begin(), ms.begin() + kRounds / 2, ms.end());
    drawn.opaque_ms = ms[kRounds / 2];
    drawn.image = m_backend->read_pixels();
    return drawn;
  }

 private:
  std::unique_ptr<render::GlContext> m_context;
  std::unique_ptr<render::Backend> m_backend;
  std::unique_ptr<view::SceneView> m_view;
  sim::State m_state;
};

double difference(const render::Image& a, const render::Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) sum += std::abs(int(a.rgb[i]) - int(b.rgb[i]));
  return sum / double(a.rgb.size());
}

render::Image enlarged_difference(const render::Image& a, const render::Image& b) {
  render::Image d = a;
  for (std::size_t i = 0; i < a.rgb.size(); ++i)
    d.rgb[i] = std::uint8_t(std::min(255, 8 * std::abs(int(a.rgb[i]) - int(b.rgb[i]))));
  return d;
}

/// Processor time of making the view [s].
double making(const sim::Model& model) {
  auto backend = render::make_null_backend();
  const std::clock_t start = std::clock();
  const view::SceneView view(model, *backend);
  return double(std::clock() - start) / CLOCKS_PER_SEC;
}

/// The same scene, always in full.
sim::Model without_levels(sim::Model model) {
  auto backend = render::make_null_backend();
  const view::SceneView view(model, *backend);
  for (const view::ScenePart& part : view.parts()) model.drawn_detail.push_back({part.name, {}});
  for (const sim::HandModel& hand : model.hands)
    for (const interactions::ToolModel& tool : hand.rack) model.drawn_detail.push_back({tool.name, {}});
  return model;
}

}  // namespace

int main(int count, char** words) {
  if (count != 2) return std::fputs("detail_sample OUT_DIR\n", stderr), 2;
  const sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/gynaecology/scene.json"));
  std::printf("the view is made in %.2f s, without levels in %.2f s\n", making(model), making(without_levels(model)));
  Sample sample(model);
  std::printf("%6s  %26s  %34s  %34s\n", "mm", "in full: triangles, ms", "by distance: triangles, ms, change",
              "1 / 2.5: triangles, ms, change");
  for (const double distance : {0.03, 0.05, 0.07, 0.10, 0.14}) {
    const Sample::Drawn full = sample.draw(distance, kFull), now = sample.draw(distance, 1),
                        nearer = sample.draw(distance, 2.5f);
    std::printf("%6.0f  %16llu %9.2f  %16llu %9.2f %7.2f  %16llu %9.2f %7.2f\n", 1000 * distance,
                static_cast<unsigned long long>(full.triangles), full.opaque_ms,
                static_cast<unsigned long long>(now.triangles), now.opaque_ms, difference(full.image, now.image),
                static_cast<unsigned long long>(nearer.triangles), nearer.opaque_ms,
                difference(full.image, nearer.image));
    const std::string stem = std::string(words[1]) + "/" + std::to_string(int(1000 * distance + 0.5));
    render::write_png(stem + "-full.png", full.image);
    render::write_png(stem + "-by-distance.png", now.image);
    render::write_png(stem + "-nearer.png", nearer.image);
    render::write_png(stem + "-change.png", enlarged_difference(full.image, now.image));
    render::write_png(stem + "-nearer-change.png", enlarged_difference(full.image, nearer.image));
  }
  return 0;
}
