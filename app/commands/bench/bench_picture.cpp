#include "commands/bench/bench_picture.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <map>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <trocar/attempt/lesson.hpp>
#include <trocar/core/log.hpp>
#include <trocar/core/text.hpp>
#include <trocar/render/backend/backend.hpp>
#include <trocar/render/frame/governor.hpp>
#include <trocar/render/gl/gl_context.hpp>
#include <trocar/view/scene/scene_view.hpp>

#include "commands/bench/bench_inputs.hpp"

namespace trocar::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kBetween = 40;     // ticks from picture to picture: 25 a second
constexpr std::uint64_t kLookEvery = 500;  // ticks, where the costliest moment is looked for
constexpr int kWarmUp = 3;                 // pictures that are not counted: what is first used is made ready

double median(std::vector<double> x) {
  if (x.empty()) return 0;
  std::nth_element(x.begin(), x.begin() + std::ptrdiff_t(x.size() / 2), x.end());
  return x[x.size() / 2];
}

/// Of all threads [ms].
double processor_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * double(t.tv_sec) + 1e-6 * double(t.tv_nsec);
}

struct PassCost {
  double wall_ms = 0, processor_ms = 0;
};

/// What everything since it was made has cost.
class Stopwatch {
 public:
  PassCost read() const {
    return {std::chrono::duration<double, std::milli>(Clock::now() - m_wall).count(), processor_ms() - m_processor};
  }

 private:
  Clock::time_point m_wall = Clock::now();
  double m_processor = processor_ms();
};

/// An operation that can be had at rising ticks.
class Operation {
 public:
  Operation(const sim::Model& model, const std::vector<sim::Input>& inputs)
      : m_model(model), m_inputs(inputs), m_state(sim::initial_state(model)), m_work(sim::make_work(model)) {}

  const sim::State& at(std::uint64_t tick) {
    while (m_done < tick && m_done < m_inputs.size()) sim::step(m_model, m_inputs[m_done++], m_state, m_work);
    return m_state;
  }

 private:
  const sim::Model& m_model;
  const std::vector<sim::Input>& m_inputs;
  sim::State m_state;
  sim::Work m_work;
  std::size_t m_done = 0;
};

/// Context, backend and view of a scene.
class Easel {
 public:
  Easel(const sim::Model& model, pictures::PictureSize size)
      : m_context(render::GlContext::off_screen()),
        m_backend(render::make_gl_backend(*m_context)),
        m_view(model, *m_backend),
        m_target(render::Target::off_screen(size.width, size.height)) {
    if (model.wet.there || !model.cuttables.empty()) m_backend->prepare_liquids();
  }

  const std::string& driver() const { return m_context->description(); }
  render::BackendStats stats() const { return m_backend->stats(); }

  /// Meshes as of the state, on their way to the driver; and what that has cost.
  render::Frame meshes(const sim::State& state, render::Quality quality, PassCost* cost = nullptr) {
    const Stopwatch watch;
    view::ViewOptions options;
    options.quality = quality;
    options.picture_height = m_target.height;
    render::Frame frame = m_view.frame(state, options);
    if (cost) *cost = watch.read();
    return frame;
  }
  void draw(const render::Frame& frame, std::vector<render::PassCost>* costs) {
    m_backend->profile(costs);
    render::draw_frame(*m_backend, frame, m_target);
    m_backend->profile(nullptr);
  }
  /// Triangles of each part of the scene, as the frame would draw them.
  Json triangles(const render::Frame& frame) {
    Json parts = Json::array();
    for (std::size_t part = 0; part <= m_view.parts().size(); ++part) {
      render::Frame alone = frame;
      std::erase_if(alone.items, [part](const render::DrawItem& i) { return i.part != part; });
      const std::uint64_t before = m_backend->stats().triangles;
      draw(alone, nullptr);
      const std::uint64_t count = m_backend->stats().triangles - before;
      if (count > 0)
        parts.push_back({{"part", part > 0 ? m_view.parts()[part - 1].name : "others"}, {"triangles", count}});
    }
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Json& a, const Json& b) { return a["triangles"] > b["triangles"]; });
    return parts;
  }
  /// A whole picture, as a window would draw it.
  PassCost whole(const sim::State& state, render::Quality quality) {
    const Stopwatch watch;
    draw(meshes(state, quality), nullptr);
    glFinish();
    return watch.read();
  }

 private:
  std::unique_ptr<render::GlContext> m_context;
  std::unique_ptr<render::Backend> m_backend;
  view::SceneView m_view;
  render::Target m_target;
};

/// The tick of the picture that takes most processor time.
std::uint64_t costliest(Easel& easel, const sim::Model& model, const std::vector<sim::Input>& inputs) {
  Operation operation(model, inputs);
  std::uint64_t best = 0;
  double most = 0;
  for (std::uint64_t tick = kLookEvery; tick <= inputs.size(); tick += kLookEvery) {
    const sim::State& state = operation.at(tick);
    if (tick == kLookEvery)
      for (int i = 0; i < kWarmUp; ++i) easel.whole(state, {});
    const double cost = std::min(easel.whole(state, {}).processor_ms, easel.whole(state, {}).processor_ms);
    if (cost <= most) continue;
    most = cost;
    best = tick;
  }
  return best;
}

/// States one picture apart, the chosen moment in their middle.
std::vector<sim::State> story(const sim::Model& model, const std::vector<sim::Input>& inputs, std::uint64_t tick,
                              int frames) {
  const std::uint64_t all = kBetween * std::uint64_t(frames + kWarmUp),
                      end = std::max<std::uint64_t>(inputs.size(), all);
  const std::uint64_t from = std::min(tick > all / 2 ? tick - all / 2 : 0, end - all);
  Operation operation(model, inputs);
  std::vector<sim::State> states;
  for (int i = 0; i < frames + kWarmUp; ++i) states.push_back(operation.at(from + kBetween * std::uint64_t(i)));
  return states;
}

struct Figures {
  std::vector<double> wall_ms, processor_ms, gpu_ms;
  void add(double wall, double processor, double gpu) {
    wall_ms.push_back(wall);
    processor_ms.push_back(processor);
    gpu_ms.push_back(gpu);
  }
  Json median_of() const {
    return {{"wall_ms", median(wall_ms)}, {"processor_ms", median(processor_ms)}, {"gpu_ms", median(gpu_ms)}};
  }
};

/// Of which a picture's passes are measured: every detail at full size, and the cheapest of all.
std::vector<std::pair<std::string, render::Quality>> columns() {
  return {
      {"detail_2", {1, 2}}, {"detail_1", {1, 1}}, {"detail_0", {1, 0}}, {"cheapest", render::quality_levels().back()}};
}

/// A row a pass, a column a quality.
Json bench_passes(Easel& easel, const std::vector<sim::State>& states) {
  std::vector<std::string> names{"meshes"};
  std::map<std::string, Json> rows;
  for (const auto& [column, quality] : columns()) {
    std::map<std::string, Figures> figures;
    for (std::size_t i = 0; i < states.size(); ++i) {
      std::vector<render::PassCost> costs;
      PassCost meshes;
      const render::Frame frame = easel.meshes(states[i], quality, &meshes);
      easel.draw(frame, &costs);
      if (i < std::size_t(kWarmUp)) continue;
      figures["meshes"].add(meshes.wall_ms, meshes.processor_ms, 0);
      for (const render::PassCost& c : costs) {
        if (std::find(names.begin(), names.end(), c.pass) == names.end()) names.emplace_back(c.pass);
        figures[c.pass].add(c.wall_ms, c.processor_ms, c.gpu_ms);
      }
    }
    for (const auto& [name, f] : figures) rows[name][column] = f.median_of();
  }
  Json table = Json::array();
  for (const std::string& name : names) {
    Json row{{"pass", name}};
    row.update(rows[name]);
    table.push_back(row);
  }
  return table;
}

/// What it saves to draw things coarsely: all in full, as levels of detail ask for, their borders nearer, all at their
/// coarsest.
Json bench_fineness(Easel& easel, const std::vector<sim::State>& states) {
  Json table = Json::array();
  for (const auto& [name, coarser] : std::initializer_list<std::pair<const char*, float>>{
           {"in full", 1e-6f}, {"by distance", 1.0f}, {"borders at 1 / 2.5", 2.5f}, {"coarsest", 1e6f}}) {
    std::vector<double> meshes, opaque, whole;
    std::uint64_t triangles = 0;
    for (std::size_t i = 0; i < states.size(); ++i) {
      const Stopwatch watch;
      PassCost cost;
      const render::Frame frame = easel.meshes(states[i], {1, 2, coarser}, &cost);
      std::vector<render::PassCost> costs;
      const std::uint64_t before = easel.stats().triangles;
      easel.draw(frame, &costs);
      triangles = easel.stats().triangles - before;
      if (i < std::size_t(kWarmUp)) continue;
      meshes.push_back(cost.processor_ms);
      whole.push_back(watch.read().processor_ms);
      for (const render::PassCost& c : costs)
        if (c.pass == std::string("opaque")) opaque.push_back(c.processor_ms);
    }
    table.push_back({{"things", name},
                     {"triangles", triangles},
                     {"meshes_ms", median(meshes)},
                     {"opaque_ms", median(opaque)},
                     {"picture_ms", median(whole)}});
  }
  return table;
}

/// What a whole picture costs at each of the governor's qualities.
Json bench_qualities(Easel& easel, const std::vector<sim::State>& states) {
  Json table = Json::array();
  for (const render::Quality& quality : render::quality_levels()) {
    std::vector<double> wall, processor;
    for (std::size_t i = 0; i < states.size(); ++i) {
      const PassCost cost = easel.whole(states[i], quality);
      if (i < std::size_t(kWarmUp)) continue;
      wall.push_back(cost.wall_ms);
      processor.push_back(cost.processor_ms);
    }
    table.push_back({{"render_scale", quality.render_scale},
                     {"samples", quality.samples},
                     {"detail", quality.detail},
                     {"coarser", quality.coarser},
                     {"wall_ms", median(wall)},
                     {"processor_ms", median(processor)}});
  }
  return table;
}

}  // namespace

Json bench_picture(const std::string& exercise, double seconds, const PictureBench& options) {
  const std::unique_ptr<attempt::Lesson> lesson = attempt::load_lesson(exercise);
  const sim::Model& model = lesson->model;
  const std::vector<sim::Input> inputs = bench_inputs(*lesson, seconds);
  Easel easel(model, options.size);
  if (!options.at) core::log::info("looking for the moment whose picture costs most");
  const std::uint64_t tick = options.at ? std::uint64_t(*options.at / sim::kTick) : costliest(easel, model, inputs);
  const std::vector<sim::State> states = story(model, inputs, tick, options.frames);
  const render::BackendStats before = easel.stats();
  const render::Frame frame = easel.meshes(states[states.size() / 2], {});
  easel.draw(frame, nullptr);
  const render::BackendStats after = easel.stats();
  return {{"name", exercise},
          {"size", {options.size.width, options.size.height}},
          {"driver", easel.driver()},
          {"seconds", double(states[states.size() / 2].tick) * sim::kTick},
          {"frames", options.frames},
          {"items", after.items - before.items},
          {"triangles", after.triangles - before.triangles},
          {"splats", after.splats - before.splats},
          {"pool_triangles", after.sheet_triangles - before.sheet_triangles},
          {"parts", easel.triangles(frame)},
          {"passes", bench_passes(easel, states)},
          {"fineness", bench_fineness(easel, states)},
          {"qualities", bench_qualities(easel, states)}};
}

void print_picture_bench(const Json& r) {
  fmt::print("{}", tr("{}, {} x {}, {} pictures around {:.1f} s, {}\n", r["name"].get<std::string>(),
                      r["size"][0].get<int>(), r["size"][1].get<int>(), r["frames"].get<int>(),
                      r["seconds"].get<double>(), r["driver"].get<std::string>()));
  fmt::print("{}", tr("  {} things of {} triangles, {} drops and films, pool of {} triangles\n",
                      r["items"].get<std::uint64_t>(), r["triangles"].get<std::uint64_t>(),
                      r["splats"].get<std::uint64_t>(), r["pool_triangles"].get<std::uint64_t>()));
  std::string parts = "  triangles:";
  for (const Json& part : r["parts"])
    parts += fmt::format(" {} {},", part["part"].get<std::string>(), part["triangles"].get<std::uint64_t>());
  parts.back() = '\n';
  fmt::print("{}", parts);
  fmt::print("{}", tr("  medians [ms]: wall, processor (all threads), graphics card where it has a clock\n"));
  fmt::print("  {:16} {:>26} {:>26} {:>26} {:>26}\n", "pass", "detail 2", "detail 1", "detail 0", "cheapest quality");
  for (const Json& row : r["passes"]) {
    std::string line = fmt::format("  {:16}", row["pass"].get<std::string>());
    for (const auto& [column, quality] : columns()) {
      const Json& c = row[column];
      line += fmt::format("   {:7.2f} {:7.2f} {:7.2f}", c["wall_ms"].get<double>(), c["processor_ms"].get<double>(),
                          c["gpu_ms"].get<double>());
    }
    fmt::print("{}\n", line);
  }
  fmt::print("  {:20} {:>9} {:>8} {:>8} {:>8}  [ms, processor]\n", "things", "triangles", "meshes", "opaque",
             "picture");
  for (const Json& row : r["fineness"])
    fmt::print("  {:20} {:9} {:8.2f} {:8.2f} {:8.2f}\n", row["things"].get<std::string>(),
               row["triangles"].get<std::uint64_t>(), row["meshes_ms"].get<double>(), row["opaque_ms"].get<double>(),
               row["picture_ms"].get<double>());
  fmt::print("{}", tr("  whole pictures at the governor's qualities:\n"));
  for (const Json& q : r["qualities"])
    fmt::print("{}", tr("  scale {:.2f}, samples {}, detail {}, coarser {:.1f}   {:7.2f} {:7.2f}\n",
                        q["render_scale"].get<double>(), q["samples"].get<int>(), q["detail"].get<int>(),
                        q["coarser"].get<double>(), q["wall_ms"].get<double>(), q["processor_ms"].get<double>()));
}

}  // namespace trocar::app
