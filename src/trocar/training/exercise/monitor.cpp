#include <algorithm>
#include <string_view>

#include <trocar/interactions/instrument/lever.hpp>
#include <trocar/training/exercise/hands.hpp>
#include <trocar/training/exercise/monitor.hpp>

namespace trocar::training {
namespace {

constexpr int kSampleEvery = 20;                       // ticks between looks at steps and tips: 50 Hz
constexpr int kCollideEvery = 4;                       // ticks between looks at instruments against each other: 250 Hz
constexpr double kSample = kSampleEvery * sim::kTick;  // [s]
constexpr double kTrocarShare = 0.02;                  // of a tick in the mean of forces: over about 50 ms
constexpr double kMoving = 0.005;                      // [m/s] slower is not a motion

/// Bodies that bear little; the tubes of an exercise always do.
Tissues tissues_of(const Exercise& exercise, const sim::Model& model, Faults& faults) {
  Tissues tissues;
  const Finder find{model, faults};
  for (const Side& side : exercise.goal.sides) tissues.delicate.push_back(model.strand_index(side.tube));
  for (const Named& n : exercise.handling().delicate) tissues.delicate.push_back(find.body(n));
  for (const Named& n : exercise.handling().bowel) tissues.bowel.push_back(find.body(n));
  return tissues;
}

}  // namespace

Monitor::Monitor(const Exercise& exercise, const sim::Model& model, Mode mode)
    : m_exercise(std::make_unique<const Exercise>(exercise)),
      m_scoreboard(std::make_unique<Scoreboard>(*m_exercise, mode)),
      m_board(*m_scoreboard),
      m_sight(model) {
  Faults faults;
  if (m_exercise->kind == Exercise::Kind::sterilisation) {
    auto judge = std::make_unique<SterilisationJudge>(*m_exercise, model, m_board, faults);
    m_sterilisation = judge.get();
    m_judge = std::move(judge);
  } else {
    auto judge = std::make_unique<BleedingJudge>(*m_exercise, model, m_board, faults);
    m_bleeding = judge.get();
    m_judge = std::move(judge);
  }
  m_tissues = tissues_of(*m_exercise, model, faults);
  if (!faults.empty()) throw core::BadInput(faults);
  const sim::State start = sim::initial_state(model);
  for (size_t h = 0; h < hands(model); ++h) {
    m_tools.push_back({model.hands[h].name, 0, 0});
    m_tip[h] = tip_of(model, start, h);
  }
}

void Monitor::update(const sim::Model& model, const sim::State& state, const sim::StepReport& report) {
  if (finished()) return;  // what comes after the last step is judged no more
  m_board.at(state.tick);
  if (m_moved) m_seconds = double(state.tick - m_first_motion) * sim::kTick;
  watch_hands(model, state, report);
  m_judge->tick(model, state, report);
  if (state.tick % kSampleEvery != 0) return;
  measure(model, state);
  m_judge->sample(model, state, {m_tip.data(), m_tools.size()}, kSample);
}

void Monitor::measure(const sim::Model& model, const sim::State& state) {
  std::array<Vec3d, sim::kMaxTools> now{};
  for (size_t h = 0; h < m_tools.size(); ++h) {
    now[h] = tip_of(model, state, h);
    const double moved = length(now[h] - m_tip[h]);
    if (!m_moved && moved > kMoving * kSample) {
      m_moved = true;
      m_first_motion = state.tick;
    }
    m_tools[h].path += moved;
  }
  Mishaps mishaps;
  m_sight.update(m_exercise->handling(), model, state, m_tip, now, kSample, mishaps);
  for (int i = 0; i < mishaps.count; ++i)
    m_board.make_error(mishaps.list[size_t(i)].code, {}, mishaps.list[size_t(i)].where);
  m_tip = now;
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

void Monitor::watch_hands(const sim::Model& model, const sim::State& state, const sim::StepReport& report) {
  weigh_on_trocars(model, state);
  for (size_t h = 0; h < m_tools.size(); ++h)
    if (state.tools[h].holds > 0) m_held_side[h] = m_judge->side_of_hold(state.tools[h].hold[0].body);
  Mishaps mishaps;
  m_pull.update(m_exercise->handling(), m_tissues, model, state, mishaps);
  m_tear.update(model, state, report, mishaps);
  m_pinch.update(m_exercise->handling(), m_tissues, model, state, mishaps);
  if (state.tick % kCollideEvery == 0)
    m_collision.update(m_exercise->handling(), model, state, kCollideEvery * sim::kTick, mishaps);
  for (int i = 0; i < report.event_count; ++i) {
    const sim::Event& e = report.events[i];
    if (e.kind == sim::Event::slipped) mishaps.add({"E3", e.tool, tip_of(model, state, size_t(e.tool)), ""});
    if (e.kind == sim::Event::exchanged) m_sight.exchanged(e.tool);
  }
  for (int i = 0; i < mishaps.count; ++i) {
    const Mishap& m = mishaps.list[size_t(i)];
    const bool held = m.hand >= 0 && (state.tools[size_t(m.hand)].holds > 0 || m.code == std::string_view("E3"));
    m_board.make_error(m.code, held ? m_held_side[size_t(m.hand)] : std::string(), m.where, m.detail);
  }
}

}  // namespace trocar::training
