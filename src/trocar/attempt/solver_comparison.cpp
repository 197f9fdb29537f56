#include <algorithm>
#include <cmath>
#include <limits>

#include <trocar/attempt/interrupt.hpp>
#include <trocar/attempt/progress.hpp>
#include <trocar/attempt/solver_comparison.hpp>
#include <trocar/core/tick.hpp>

namespace trocar::attempt {
namespace {

constexpr double kLeastForce = 0.005;  // [N] below it there are no shares
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double force_on_tools(const sim::State& s) {
  double sum = 0;
  for (const interactions::ToolState& t : s.tools)
    sum +=
        length(Vec3d{t.contact_force[0] + t.pull[0], t.contact_force[1] + t.pull[1], t.contact_force[2] + t.pull[2]});
  return sum;
}

double apart(Vec3f a, Vec3f b) { return length(vec_cast<double>(a) - vec_cast<double>(b)); }

}  // namespace

double SolverSample::share(double distance) const { return moved < kLeastIndentation ? kNone : distance / moved; }
double SolverSample::force_share() const {
  return dynamic_force < kLeastForce ? kNone : static_force / dynamic_force - 1;
}

SolverComparison::SolverComparison(const sim::Model& dynamic, const sim::Model& at_once, int organ)
    : m_dynamic(dynamic, organ), m_static(at_once, organ), m_begin(m_dynamic.at(sim::initial_state(dynamic))) {}

void SolverComparison::after_tick(const sim::State& dynamic, const sim::State& at_once, bool settled) {
  m_forces[0] += force_on_tools(dynamic);
  m_forces[1] += force_on_tools(at_once);
  ++m_ticks;
  if (dynamic.tick % kSampleTicks == 0) sample(dynamic, at_once, settled);
}

void SolverComparison::sample(const sim::State& dynamic, const sim::State& at_once, bool settled) {
  const std::vector<Vec3f>&a = m_dynamic.at(dynamic), &b = m_static.at(at_once);
  SolverSample s;
  s.seconds = double(dynamic.tick) * sim::kTick;
  s.settled = settled;
  double squares = 0;
  int vertices = 0;
  for (std::size_t v = 0; v < m_begin.size(); ++v) {
    if (!m_dynamic.skin().at_surface(int(v))) continue;
    const double off = apart(a[v], b[v]);
    squares += off * off;
    ++vertices;
    s.moved = std::max(s.moved, apart(a[v], m_begin[v]));
    if (off <= s.largest) continue;
    s.largest = off;
    s.vertex = int(v);
  }
  s.rms = std::sqrt(squares / std::max(1, vertices));
  s.dynamic_force = m_forces[0] / m_ticks;
  s.static_force = m_forces[1] / m_ticks;
  m_forces[0] = m_forces[1] = 0;
  m_ticks = 0;
  m_samples.push_back(s);
  if (s.largest <= m_worst) return;
  m_worst = s.largest;
  m_dynamic_then = dynamic;
  m_static_then = at_once;
}

SolverSummary SolverComparison::summary() const {
  SolverSummary sum;
  if (m_samples.empty()) return sum;
  const SolverSample* held = nullptr;
  double squares = 0;
  for (const SolverSample& s : m_samples) {
    if (s.largest > sum.worst.largest) sum.worst = s;
    if (s.settled) held = &s;
    sum.deepest = std::max(sum.deepest, s.moved);
    squares += s.rms * s.rms;
  }
  const auto deepest = std::max_element(m_samples.begin(), m_samples.end(),
                                        [](const auto& a, const auto& b) { return a.moved < b.moved; });
  sum.held = held ? *held : *deepest;
  sum.largest = sum.worst.largest;
  sum.rms = std::sqrt(squares / double(m_samples.size()));
  return sum;
}

SolverPair load_pair(const std::string& exercise, std::uint64_t seed, const std::string& organ) {
  const auto with = [&](scene::Solver solver) {
    return load_adapted(exercise, seed, [&](scene::Description& d) { set_solver(d, organ, solver); });
  };
  SolverPair pair{with(scene::Solver::dynamic_network), with(scene::Solver::elastostatic), -1};
  pair.organ = pair.dynamic->model.organ_index(organ);
  return pair;
}

SolverComparison compare_solvers(const SolverPair& pair, InputSource& source, double seconds,
                                 const std::function<bool()>& settled) {
  const sim::Model& dynamic = pair.dynamic->model;
  core::ThreadPool pool(core::default_thread_count());
  sim::State state = sim::initial_state(dynamic);
  sim::Work work = sim::make_work(dynamic, &pool);
  SolverBeside beside(pair.at_once->model, pair.organ);
  SolverComparison comparison(dynamic, beside.model(), pair.organ);
  const std::uint64_t limit =
      seconds > 0 ? std::uint64_t(seconds * double(core::kTicksPerSecond) + 0.5) : ~std::uint64_t(0);
  Progress progress(0, seconds > 0 ? limit : 0);
  sim::Input input = dynamic.start;
  catch_interrupts();
  while (!interrupted() && state.tick < limit && source.next(state, input)) {
    source.after(state, sim::step(dynamic, input, state, work));
    beside.advance(input);
    comparison.after_tick(state, beside.state(), settled && settled());
    progress.at(state.tick);
  }
  return comparison;
}

}  // namespace trocar::attempt
