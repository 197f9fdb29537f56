// trocar bench: what a tick costs, stage by stage, while somebody pulls on the scene's tissue; with --picture what a
// picture of that costs, pass by pass.
#include <algorithm>
#include <chrono>
#include <ctime>
#include <fstream>

#include <fmt/format.h>

#include <trocar/attempt/lesson.hpp>
#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/parallel.hpp>
#include <trocar/core/text.hpp>
#include <trocar/tissue/network/network.hpp>

#include "commands/bench/bench_inputs.hpp"
#include "commands/bench/bench_picture.hpp"
#include "commands/command.hpp"
#include "commands/number_options.hpp"

namespace trocar::app {
namespace {

using Clock = std::chrono::steady_clock;

double microseconds(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double, std::micro>(to - from).count();
}

/// Time that this thread has run, whatever else the machine does [us].
double thread_time() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * double(t.tv_sec) + 1e-3 * double(t.tv_nsec);
}

struct Summary {
  double mean = 0, median = 0, p99 = 0, most = 0;
};
Summary summary(std::vector<double> us) {
  Summary s;
  if (us.empty()) return s;
  std::sort(us.begin(), us.end());
  for (const double t : us) s.mean += t / double(us.size());
  s.median = us[us.size() / 2];
  s.p99 = us[std::min(us.size() - 1, us.size() * 99 / 100)];
  s.most = us.back();
  return s;
}
Json as_json(const Summary& s) {
  return {{"mean_us", s.mean}, {"median_us", s.median}, {"p99_us", s.p99}, {"max_us", s.most}};
}

struct Timing {
  std::vector<double> tick;                ///< [us] per tick
  std::vector<double> own;                 ///< the same in the calling thread's own time
  std::vector<std::vector<double>> stage;  ///< (stages) the same
  std::uint64_t hash = 0;
  std::size_t held = 0;  ///< ticks with tissue between jaws
};

Timing measure(const sim::Model& model, const std::vector<sim::Input>& inputs, int threads) {
  core::ThreadPool pool(threads);
  sim::State state = sim::initial_state(model);
  sim::Work work = sim::make_work(model, &pool);
  const auto stages = sim::stages();
  Timing t;
  t.stage.resize(stages.size());
  for (const sim::Input& input : inputs) {
    sim::StepReport report;
    sim::StepContext context{model, input, state, work, report};
    const double own = thread_time();
    const Clock::time_point start = Clock::now();
    Clock::time_point before = start;
    for (size_t i = 0; i < stages.size(); ++i) {
      stages[i].run(context);
      const Clock::time_point now = Clock::now();
      t.stage[i].push_back(microseconds(before, now));
      before = now;
    }
    t.tick.push_back(microseconds(start, before));
    t.own.push_back(thread_time() - own);
    for (const interactions::ToolState& tool : state.tools) t.held += tool.holds > 0;
  }
  t.hash = sim::hash_of(state);
  return t;
}

Json bench_scene(const std::string& name, double seconds) {
  const std::unique_ptr<attempt::Lesson> lesson = attempt::load_lesson(name);
  const std::vector<sim::Input> inputs = bench_inputs(*lesson, seconds);
  Json out{{"name", name},
           {"free_nodes", lesson->model.free_nodes()},
           {"simd", tissue::simd_name()},
           {"ticks", inputs.size()},
           {"runs", Json::array()}};
  for (const int threads : {1, 2}) {
    const Timing t = measure(lesson->model, inputs, threads);
    Json run{{"threads", threads},
             {"tick", as_json(summary(t.tick))},
             {"ticks_with_tissue_held", t.held},
             {"state_hash", core::hex(t.hash)},
             {"stages", Json::object()}};
    if (threads == 1) run["tick_cpu"] = as_json(summary(t.own));  // on a busy machine the truer figure
    for (size_t i = 0; i < t.stage.size(); ++i) run["stages"][sim::stages()[i].name] = as_json(summary(t.stage[i]));
    out["runs"].push_back(run);
  }
  return out;
}

/// Cost of one spring in one sub-step: the largest organ of the scene, alone, at rest under gravity.
Json bench_kernel() {
  const std::unique_ptr<attempt::Lesson> lesson = attempt::load_lesson("gynaecology");
  const auto largest = std::max_element(
      lesson->model.solids.begin(), lesson->model.solids.end(),
      [](const sim::SolidModel& a, const sim::SolidModel& b) { return a.network.springs < b.network.springs; });
  if (largest == lesson->model.solids.end()) throw core::BadInput({{{"gynaecology", 0, 0}, "the scene has no organ"}});
  const tissue::NetworkModel& network = largest->network;
  tissue::NetworkState state = tissue::rest_state(network);
  tissue::NetworkWork work = tissue::make_work(network);
  std::vector<double> us;
  for (int i = 0; i < 600; ++i) {
    const Clock::time_point start = Clock::now();
    tissue::advance(network, {}, {}, state, work);
    if (i >= 100) us.push_back(microseconds(start, Clock::now()));
  }
  const Summary s = summary(us);
  const double visits = double(network.springs) * network.substeps;
  return {{"name", "kernel"},
          {"organ", largest->name},
          {"simd", tissue::simd_name()},
          {"springs", network.springs},
          {"substeps", network.substeps},
          {"tick", as_json(s)},
          {"ns_per_spring_and_substep", 1000 * s.median / visits}};
}

void print_bench(const Json& r) {
  if (r["name"] == "kernel") {
    fmt::print("{}", tr("kernel ({}): {} springs x {} sub-steps, {:.2f} ns per spring and sub-step\n",
                        r["simd"].get<std::string>(), r["springs"].get<int>(), r["substeps"].get<int>(),
                        r["ns_per_spring_and_substep"].get<double>()));
    return;
  }
  fmt::print("{}", tr("{}: {} free nodes, {} ticks, {}\n", r["name"].get<std::string>(), r["free_nodes"].get<int>(),
                      r["ticks"].get<std::size_t>(), r["simd"].get<std::string>()));
  for (const Json& run : r["runs"]) {
    const auto line = [](const std::string& name, const Json& t) {
      fmt::print("{}", tr("    {:18} mean {:7.1f}  median {:7.1f}  p99 {:7.1f} us\n", name, t["mean_us"].get<double>(),
                          t["median_us"].get<double>(), t["p99_us"].get<double>()));
    };
    fmt::print("{}", tr("  {} thread(s), state {}, tissue held in {} ticks\n", run["threads"].get<int>(),
                        run["state_hash"].get<std::string>(), run["ticks_with_tissue_held"].get<std::size_t>()));
    line("tick", run["tick"]);
    if (run.contains("tick_cpu")) line("tick, processor", run["tick_cpu"]);
    for (const auto& stage : run["stages"].items()) line(stage.key(), stage.value());
  }
}

struct BenchChoice {
  std::vector<std::string> names;
  std::string file, size = "800x600";
  double seconds = 30;
  bool json = false, picture = false;
  PictureBench pictures;
};

/// A scene's name stands for the first of its exercises.
std::string exercise_of(const std::string& name) {
  for (const attempt::ExerciseEntry& e : attempt::list_exercises(attempt::scenes_folder()))
    if (e.name.starts_with(name + "/")) return e.name;
  return name;
}

Json bench_one(const std::string& name, const BenchChoice& o) {
  if (o.picture) return bench_picture(exercise_of(name), o.seconds, o.pictures);
  if (name == "kernel") return bench_kernel();
  return bench_scene(exercise_of(name), o.seconds);
}

int bench(BenchChoice o) {
  o.pictures.size = pictures::parse_size(o.size);
  if (o.names.empty())
    o.names = o.picture ? std::vector<std::string>{"gynaecology"} : std::vector<std::string>{"gynaecology", "kernel"};
  Json results = Json::array();
  for (const std::string& name : o.names) {
    results.push_back(bench_one(name, o));
    if (o.json) continue;
    if (o.picture)
      print_picture_bench(results.back());
    else
      print_bench(results.back());
  }
  const Json all{{"benchmarks", results}};
  if (!o.file.empty()) {
    std::ofstream out(o.file);
    out << all.dump(2) << '\n';
    if (!out.flush()) throw core::EnvironmentLacks(tr("cannot write {}: is the disk full?", o.file));
  }
  if (o.json) print(all);
  return core::kDone;
}

}  // namespace

void add_bench(CLI::App& program, Chosen& chosen) {
  auto o = std::make_shared<BenchChoice>();
  CLI::App* c = program.add_subcommand("bench", tr("Measure the time of a tick, stage by stage, or of a picture"));
  c->footer(
      "Example:\n  trocar bench gynaecology --json bench.json\n"
      "  trocar bench gynaecology/bleeding-control --picture --size 800x600");
  c->add_option("names", o->names, tr("an exercise, a scene, or kernel (one spring); default: gynaecology and kernel"));
  c->add_option("--json", o->file, tr("write the numbers to this file, or with - to standard output"))->expected(0, 1);
  c->add_option("--seconds", o->seconds, tr("most simulated time [s]"))
      ->capture_default_str()
      ->check(number_above(0, kLongestRun, "s"));
  c->add_flag("--picture", o->picture, tr("the time of a picture, pass by pass, at each level of detail and quality"));
  c->add_option("--size", o->size, tr("WIDTHxHEIGHT of the picture"))->capture_default_str();
  c->add_option("--frames", o->pictures.frames, tr("pictures for each number, which is their median"))
      ->capture_default_str()
      ->transform(whole_number(3, 300));
  c->add_option("--at", o->pictures.at, tr("moment of the exercise [s]; default: the slowest one"))
      ->check(number_between(0, kLongestRun, "s"));
  c->callback([o, c, &chosen] {
    o->json = chosen.json = c->count("--json") > 0 && (o->file.empty() || o->file == "-");
    if (chosen.json) o->file.clear();
    chosen.run = [o] { return bench(*o); };
  });
}

}  // namespace trocar::app
