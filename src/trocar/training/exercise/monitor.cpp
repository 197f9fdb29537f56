#include <algorithm>
#include <limits>

#include <trocar/interactions/instrument/lever.hpp>
#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/exercise/monitor.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/observe/sampling.hpp>

namespace trocar::training {
namespace {

constexpr double kTrocarShare = 0.02;  // of a tick in the mean of forces: over about 50 ms
constexpr double kMoving = 0.005;      // [m/s] slower is not a motion

}  // namespace

Monitor::Monitor(const Exercise& exercise, const sim::Model& model, Mode mode, std::uint64_t seed)
    : m_exercise(std::make_unique<const Exercise>(exercise)), m_board(std::make_unique<Scoreboard>(*m_exercise, mode)) {
  Faults faults;
  m_rules = std::make_unique<Rules>(*m_exercise, &model, seed, *m_board, faults);
  if (!faults.empty()) throw core::BadInput(faults);
  m_anatomy = model.anatomy, m_anatomy_title = model.anatomy_title;
  const sim::State start = sim::initial_state(model);
  m_lens = sim::scope_of(model, start).eye;
  for (size_t h = 0; h < hands(model); ++h) {
    m_tools.push_back({model.hands[h].name, 0, 0});
    m_tip[h] = tip_of(model, start, h);
  }
}

void Monitor::update(const sim::Model& model, const sim::State& state, const sim::StepReport& report) {
  if (finished()) return;  // what comes after the last step is judged no more
  m_board->at(state.tick);
  if (m_moved) m_seconds = double(state.tick - m_first_motion) * sim::kTick;
  weigh_on_trocars(model, state);
  const Snapshot snapshot{model, state};
  m_rules->tick(snapshot, report);
  if (state.tick % kSampleEvery != 0) return;
  measure(model, state);
  watch_target(snapshot);
  m_rules->sample(snapshot, kSample);
}

void Monitor::watch_target(const Snapshot& snapshot) {
  const int step = current();
  if (!m_tools.empty() || !m_moved || step < 0 || size_t(step) >= m_rules->steps().size()) return;
  const Condition& when = m_rules->steps()[size_t(step)].when;
  ++m_watched;
  if (when.there() && when.holds(snapshot) == TriState::yes) ++m_on_target;
}

double Monitor::on_target_share() const {
  return m_watched > 0 ? double(m_on_target) / double(m_watched) : std::numeric_limits<double>::quiet_NaN();
}

void Monitor::measure(const sim::Model& model, const sim::State& state) {
  bool moving = false;
  for (size_t h = 0; h < m_tools.size(); ++h) {
    const Vec3d now = tip_of(model, state, h);
    const double moved = length(now - m_tip[h]);
    moving = moving || moved > kMoving * kSample;
    m_tools[h].path += moved;
    m_tip[h] = now;
  }
  if (m_tools.empty()) {  // nothing is controlled but the endoscope
    const Vec3d now = sim::scope_of(model, state).eye;
    moving = length(now - m_lens) > kMoving * kSample;
    m_lens = now;
  }
  if (m_moved || !moving) return;
  m_moved = true;
  m_first_motion = state.tick;
}

void Monitor::weigh_on_trocars(const sim::Model& model, const sim::State& state) {
  for (size_t h = 0; h < m_tools.size(); ++h) {
    const interactions::TrocarLoad load =
        interactions::load_at_trocar(model.tool(state, h), state.tools[h], state.touches[h]);
    m_tools[h].max_pull = std::max(m_tools[h].max_pull, norm(state.tools[h].pull));
    TrocarMean& mean = m_trocar[h];
    mean.on_wall += kTrocarShare * (length(load.on_wall) - mean.on_wall);
    mean.by_hand += kTrocarShare * (length(load.by_hand) - mean.by_hand);
    m_tools[h].max_on_wall = std::max(m_tools[h].max_on_wall, mean.on_wall);
    m_tools[h].max_by_hand = std::max(m_tools[h].max_by_hand, mean.by_hand);
  }
}

}  // namespace trocar::training
