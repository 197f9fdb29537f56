// What blood, water, smoke and heat cost beside the tissue when all of it is on at once (tests/sim/everything.hpp):
// 5,000 drops, a pool of 128 x 128 cells that is wet nearly everywhere, 200 vessels of which one bleeds, a hook that
// coagulates. Processor time of single ticks, on one thread:
//
//   sim_bench --benchmark_filter=Everything --benchmark_counters_tabular=true
//
//   Everything/BesideTissue  all stages that the tissue alone would not have: mean, median, 99 % and worst tick; and
//                            of that vessels, heat, fluids. tick_us is the whole tick.
//   Everything/TissueAlone   the same scene and hands without vessels, fluids and energy
//   Everything/Fluids        the fluids' stage in its parts: drops on their way, what they meet, pool, smoke
//   Everything/Drops         the same with 1,000 to 50,000 drops
//
// A look at the processor's clock takes some tenths of a microsecond (clock_us), and there are ten in a tick.
#include <array>
#include <ctime>
#include <string_view>

#include <benchmark/benchmark.h>

#include <trocar/interactions/wetting/fluid_contact.hpp>

#include "everything.hpp"

using namespace trocar;

namespace {

constexpr int kSettle = 1500;  // ticks before anything is measured: the hands are where they work, drops lie and run
constexpr int kTicks = 4000;

double now_us() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * double(t.tv_sec) + 1e-3 * double(t.tv_nsec);
}

/// Microseconds of single ticks.
class Ticks {
 public:
  void add(double us) { m_us.push_back(us); }
  double mean() const {
    double sum = 0;
    for (const double us : m_us) sum += us;
    return sum / double(m_us.size());
  }
  /// @param share  of ticks that took no longer
  double quantile(double share) {
    std::sort(m_us.begin(), m_us.end());
    return m_us[std::min(m_us.size() - 1, std::size_t(share * double(m_us.size())))];
  }
  void tell(benchmark::State& state, const std::string& name) {
    state.counters[name + "_mean"] = mean();
    state.counters[name + "_p50"] = quantile(0.5);
    state.counters[name + "_p99"] = quantile(0.99);
    state.counters[name + "_max"] = quantile(1);
  }

 private:
  std::vector<double> m_us;
};

/// One of everything for each number of drops; they take seconds to compile.
const sim::Model& model_for(int drops) {
  static const sim::Model usual = scene::compile(everything::description(8192));
  static const sim::Model large = [] {
    sim::Model m = usual;
    m.wet.model.droplets.capacity = 65536;
    sim::seal(m);
    return m;
  }();
  return drops <= 6000 ? usual : large;
}

/// The scene at work, with its drops kept at their number.
struct Scene {
  const sim::Model& model;
  sim::State state;
  sim::Work work = sim::make_work(model);
  everything::Hands hands{model};
  everything::Rain rain;
  sim::Input input;

  explicit Scene(int drops) : model(model_for(drops)), state(everything::laden(model, drops)), rain(model, drops) {
    for (int t = 0; t < kSettle; ++t) {
      prepare();
      step(model, input, state, work);
    }
  }
  void prepare() {
    rain.top_up(state);
    input = hands.at(state.tick);
  }
};

enum Part { kTissue, kVessels, kHeat, kFluids, kParts };
Part part_of(std::string_view stage) {
  if (stage == "pose vessels" || stage == "apply pulse loads" || stage == "update blood flow") return kVessels;
  if (stage == "apply adhesion" || stage == "heat tissue") return kHeat;
  if (stage == "apply drop impacts" || stage == "move fluids") return kFluids;
  return kTissue;
}

/// One tick; the clock is looked at only where the part changes.
std::array<double, kParts> timed_step(Scene& s) {
  std::array<double, kParts> spent{};
  sim::StepReport report;
  sim::StepContext context{s.model, s.input, s.state, s.work, report};
  Part part = kTissue;
  double before = now_us();
  for (const sim::Stage& stage : sim::stages()) {
    if (const Part next = part_of(stage.name); next != part) {
      const double now = now_us();
      spent[part] += now - before;
      before = now, part = next;
    }
    stage.run(context);
  }
  spent[part] += now_us() - before;
  return spent;
}

void BesideTissue(benchmark::State& state) {
  Scene s(int(state.range(0)));
  Ticks beside, tick, part[kParts];
  double questions = 0;
  for (auto _ : state) {
    s.prepare();
    const std::array<double, kParts> spent = timed_step(s);
    const double own = spent[kVessels] + spent[kHeat] + spent[kFluids];
    for (int p = 0; p < kParts; ++p) part[p].add(spent[std::size_t(p)]);
    beside.add(own);
    tick.add(own + spent[kTissue]);
    state.SetIterationTime(1e-6 * own);
    questions += s.work.fluids.droplets.questions;
  }
  beside.tell(state, "us");
  tick.tell(state, "tick_us");
  part[kVessels].tell(state, "vessels_us");
  part[kHeat].tell(state, "heat_us");
  part[kFluids].tell(state, "fluids_us");
  state.counters["questions"] = questions / kTicks;
  const double from = now_us();
  for (int i = 0; i < 999; ++i) now_us();
  state.counters["clock_us"] = (now_us() - from) / 1000;
  if (!audit(s.model.wet.model, s.state.fluids)) state.SkipWithError("the account does not balance");
}

void TissueAlone(benchmark::State& state) {
  static const sim::Model model = scene::compile(everything::tissue_alone());
  const everything::Hands hands(model);
  sim::State s = sim::initial_state(model);
  sim::Work work = sim::make_work(model);
  while (s.tick < kSettle) step(model, hands.at(s.tick), s, work);
  Ticks tick;
  for (auto _ : state) {
    const sim::Input input = hands.at(s.tick);
    const double from = now_us();
    step(model, input, s, work);
    const double spent = now_us() - from;
    tick.add(spent);
    state.SetIterationTime(1e-6 * spent);
  }
  tick.tell(state, "tick_us");
}

/// The fluids' stage as sim/stages/wetting.cpp has it, but for valves.
struct FluidsTick {
  double plan = 0, answer = 0, resolve = 0, pool = 0, smoke = 0;

  explicit FluidsTick(Scene& s) {
    const fluids::FluidsModel& m = s.model.wet.model;
    fluids::FluidsState& state = s.state.fluids;
    fluids::FluidsWork& work = s.work.fluids;
    const interactions::WetGround ground{{s.model, s.state, &s.work}, s.model.wet.film, s.model.wet.grids};
    const std::span<const fluids::Capsule> tools(s.work.wet_tools.data(), 4);
    fluids::Below below{m.pool, s.model.wet.floor, state.pool, state.ledger};
    double at = now_us();
    const auto lap = [&at] {
      const double now = now_us(), spent = now - at;
      at = now;
      return spent;
    };
    fluids::plan(m.droplets, s.work.wounds, state.droplets, work.droplets, below);
    plan = lap();
    answer_drops(ground, normalised(s.model.gravity), state.droplets, work.droplets, s.work.wet);
    answer = lap();
    fluids::resolve(m.droplets, tools, state.droplets, work.droplets, below);
    resolve = lap();
    fluids::advance(m.pool, {.floor = s.model.wet.floor, .capsules = tools, .drains = {}}, state.pool, work.pool,
                    state.ledger);
    pool = lap();
    fluids::advance(m.smoke, {.coagulating = true}, state.smoke, work.smoke);
    smoke = lap();
  }
  double drops() const { return plan + answer + resolve; }
};

/// All stages of a tick, the fluids' one in parts.
FluidsTick step_in_parts(Scene& s) {
  sim::StepReport report;
  sim::StepContext context{s.model, s.input, s.state, s.work, report};
  for (const sim::Stage& stage : sim::stages()) {
    if (std::string_view(stage.name) == "move fluids") break;
    stage.run(context);
  }
  const FluidsTick spent(s);
  ++s.state.tick;
  return spent;
}

void Fluids(benchmark::State& state) {
  Scene s(int(state.range(0)));
  Ticks plan, answer, resolve, pool, smoke;
  for (auto _ : state) {
    s.prepare();
    const FluidsTick spent = step_in_parts(s);
    plan.add(spent.plan), answer.add(spent.answer), resolve.add(spent.resolve);
    pool.add(spent.pool), smoke.add(spent.smoke);
    state.SetIterationTime(1e-6 * (spent.drops() + spent.pool + spent.smoke));
  }
  plan.tell(state, "plan_us");
  answer.tell(state, "answer_us");
  resolve.tell(state, "resolve_us");
  pool.tell(state, "pool_us");
  smoke.tell(state, "smoke_us");
}

void Drops(benchmark::State& state) {
  Scene s(int(state.range(0)));
  Ticks drops;
  double count = 0, flying = 0;
  for (auto _ : state) {
    s.prepare();
    count += s.state.fluids.droplets.count;
    const FluidsTick spent = step_in_parts(s);
    drops.add(spent.drops());
    state.SetIterationTime(1e-6 * spent.drops());
  }
  const fluids::DropletState& d = s.state.fluids.droplets;
  for (int i = 0; i < d.count; ++i) flying += d.body[std::size_t(i)] < 0;
  state.counters["drops"] = count / double(state.iterations());
  state.counters["flying"] = flying / d.count;
  state.counters["ns_per_drop"] = 1e3 * drops.mean() * double(state.iterations()) / count;
  drops.tell(state, "us");
  if (!audit(s.model.wet.model, s.state.fluids)) state.SkipWithError("the account does not balance");
}

BENCHMARK(BesideTissue)
    ->Name("Everything/BesideTissue")
    ->Arg(5000)
    ->UseManualTime()
    ->Iterations(kTicks)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(TissueAlone)
    ->Name("Everything/TissueAlone")
    ->UseManualTime()
    ->Iterations(kTicks)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(Fluids)
    ->Name("Everything/Fluids")
    ->Arg(5000)
    ->UseManualTime()
    ->Iterations(kTicks)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(Drops)
    ->Name("Everything/Drops")
    ->Arg(1000)
    ->Arg(2000)
    ->Arg(5000)
    ->Arg(10000)
    ->Arg(20000)
    ->Arg(50000)
    ->UseManualTime()
    ->Iterations(1000)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
