#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/exercise/bleeding_judge.hpp>
#include <trocar/training/exercise/hands.hpp>

namespace trocar::training {
namespace {

constexpr double kMl = 1e-6;  // [m^3]

constexpr int kSpreadEvery = 25;  // samples between looks at how far tissue has died: twice a second

/// Of the vessel that bleeds, what carries it at that place: the only thing that current is for. As holds number it.
std::vector<std::int32_t> carriers(const sim::Model& model) {
  const sim::Bleeder& bleeder = model.vessels.bleeder;
  if (bleeder.vessel < 0) return {};
  const auto& points = model.vessels.list[size_t(bleeder.vessel)].path.points;
  const auto nearest = std::min_element(points.begin(), points.end(), [&](const auto& a, const auto& b) {
    return std::fabs(a.s - bleeder.s) < std::fabs(b.s - bleeder.s);
  });
  const interactions::VesselHold& hold = nearest->hold;
  switch (hold.kind) {
    case interactions::VesselHold::space:
      return {};
    case interactions::VesselHold::strand:
      return {hold.index};
    case interactions::VesselHold::membrane:
      return {interactions::kMembraneBase + hold.index};
    case interactions::VesselHold::organ:
    case interactions::VesselHold::cell:
      return {interactions::kSolidBase + hold.index};
  }
  return {};
}

std::vector<std::int32_t> bodies(const std::vector<Named>& named, const Finder& find) {
  std::vector<std::int32_t> found;
  for (const Named& n : named) found.push_back(find.body(n));
  return found;
}

double in_m3(std::int64_t picolitres) { return fluids::kM3PerPicolitre * double(picolitres); }

}  // namespace

BleedingJudge::BleedingJudge(const Exercise& exercise, const sim::Model& model, Scoreboard& board, Faults& faults)
    : m_exercise(exercise),
      m_goal(exercise.bleeding),
      m_board(board),
      m_energy(carriers(model), bodies(m_goal.bowel, {model, faults})) {
  const Finder find{model, faults};
  find.instrument(m_goal.applier, m_goal.applier_at, interactions::ToolKind::clip_applier, "a clip applier");
  const core::Location whole{exercise.file.string(), 0, 0};
  m_target = model.target_index("bleeder");
  if (m_target < 0) faults.push_back({whole, "expected a scene in which a vessel opens by itself, got none"});
  if (!model.wet.there) faults.push_back({whole, "expected a scene with fluids, got none"});
  for (int task = 0; task < kBleedingTasks; ++task) board.add_step(exercise.text(BleedingTask(task)));
}

int BleedingJudge::current() const {
  int i = 0;
  while (i < kBleedingTasks && !m_board.open(i)) ++i;
  return i;
}

const std::string& BleedingJudge::side_of_hold(std::int32_t) const {
  static const std::string none;
  return none;
}

void BleedingJudge::tick(const sim::Model& model, const sim::State& state, const sim::StepReport&) {
  for (; m_clips_judged < state.clip_count; ++m_clips_judged) judge_clip(model, state, m_clips_judged);
  for (; m_cuts_judged < state.cut_count; ++m_cuts_judged) {
    const interactions::Cut& cut = state.cuts[size_t(m_cuts_judged)];
    m_board.make_error("E11", {}, tip_of(model, state, size_t(cut.tool)), "cut");
  }
  Mishaps mishaps;
  m_energy.update(m_goal.energy, model, state, mishaps);
  tell_all(mishaps);
}

void BleedingJudge::tell_all(const Mishaps& mishaps) {
  for (int i = 0; i < mishaps.count; ++i)
    m_board.make_error(mishaps.list[size_t(i)].code, {}, mishaps.list[size_t(i)].where);
}

bool BleedingJudge::drowned(const sim::Model& model, const sim::State& state, Vec3d where) const {
  constexpr float kShallow = 0.001f;  // [m] wet, but one sees through it
  const fluids::PoolModel& pool = model.wet.model.pool;
  const fluids::PoolPoint p = locate(pool, where);
  if (!p.inside) return false;
  const float deep = depth_at(pool, state.fluids.pool, p.i, p.j);
  return deep > kShallow && floor_at(pool, state.pool_floor, p.i, p.j) + deep > p.height + kShallow;
}

void BleedingJudge::judge_clip(const sim::Model& model, const sim::State& state, int number) {
  const interactions::Clip& clip = state.clips[size_t(number)];
  const Vec3d where = tip_of(model, state, size_t(clip.tool));
  if (clip.dropped()) return m_board.make_error("E12", {}, where);
  if (clip.tips_visible < 1) m_board.make_error("E4.2", {}, where);  // the lower leg is behind what carries the artery
  if (drowned(model, state, where)) m_board.make_error("E10", {}, where, "clipped under blood");
  if (clip.closing_time < m_goal.clip_closing) m_board.make_error("A3.4", {}, where);
  const sim::Bleeder& bleeder = model.vessels.bleeder;
  const auto closed = std::span(state.vessel_clips).first(size_t(state.vessel_clip_count));
  const auto on_it = std::find_if(closed.begin(), closed.end(), [&](const interactions::VesselClip& c) {
    return c.clip == number && c.vessel == bleeder.vessel;
  });
  if (on_it == closed.end()) {
    ++m_facts.elsewhere;
    return m_board.make_error("A3.2", {}, where);
  }
  if (on_it->cover < m_goal.clip_cover) return m_board.make_error("A3.3", {}, where);
  if (on_it->s < bleeder.s) {
    ++m_facts.upstream;
    m_board.done(step(BleedingTask::clip));
    return;
  }
  // Where vessels meet again behind the place, it is fed from there, too; but the heart's side comes first.
  if (m_facts.upstream == 0) m_board.make_error("A3.1", {}, where);
  ++m_facts.downstream;
}

void BleedingJudge::measure(const sim::State& state) {
  m_facts.lost = in_m3(state.fluids.ledger.in[size_t(fluids::Source::kBled)].blood);
  m_facts.pool = in_m3(at(state.fluids.ledger, fluids::Place::kPool).total());
  double& second_ago = m_lost_before[size_t(m_sample) % m_lost_before.size()];
  m_facts.flow = m_facts.lost - second_ago;  // a second's, so a rate
  second_ago = m_facts.lost;
  ++m_sample;
  if (m_facts.began < 0 && m_facts.lost > 0) m_facts.began = m_board.now();
}

void BleedingJudge::watch_loss(Vec3d where) {
  const std::pair<double, const char*> bands[] = {
      {m_goal.lost_some, "E9.1"}, {m_goal.lost_much, "E9.2"}, {m_goal.lost_too_much, "E9"}};
  for (; m_band < 3 && m_facts.lost > bands[m_band].first; ++m_band)
    m_board.make_error(bands[m_band].second, {}, where);
  if (m_late || m_facts.began < 0 || !m_board.open(step(BleedingTask::stop))) return;
  if (m_board.now() - m_facts.began <= m_goal.control_within) return;
  m_late = true;
  m_board.make_error("E9.3", {}, where);
}

void BleedingJudge::watch_pool(Vec3d where) {
  const StepStatus& stop = m_board.step(step(BleedingTask::stop));
  if (m_left || !stop.done || !m_board.open(step(BleedingTask::clear))) return;
  if (m_board.now() - stop.at <= m_goal.clear_within) return;
  m_left = true;
  m_board.make_error("E10", {}, where, "left in the pool");
}

void BleedingJudge::sample(const sim::Model& model, const sim::State& state, std::span<const Vec3d>, double dt) {
  measure(state);
  const sim::VisibilityTarget& target = model.targets[size_t(m_target)];
  const Vec3d where = place_of(model, state, model.samples[size_t(target.first)]);
  watch_loss(where);
  if (m_sample % kSpreadEvery == 0) {
    Mishaps mishaps;
    m_energy.look_at_spread(model, state, mishaps);
    tell_all(mishaps);
  }
  if (m_facts.began < 0) return;
  const bool seen = sim::visible(model, state, m_target);
  const bool dry = m_facts.flow <= m_goal.stopped_flow;
  m_facts.stopped = !dry ? -1 : m_facts.stopped < 0 ? m_board.now() : m_facts.stopped;
  m_board.latch(step(BleedingTask::find), seen, m_goal.find_time, dt);
  // A vessel that has clotted or run empty is not controlled: the clip comes first.
  const auto done = [this](BleedingTask task) { return m_board.step(step(task)).done; };
  m_board.latch(step(BleedingTask::stop), dry && done(BleedingTask::clip), m_goal.stopped_time, dt);
  const bool stopped = done(BleedingTask::stop);
  m_board.latch(step(BleedingTask::clear), stopped && m_facts.pool <= m_goal.pool_left, m_exercise.hold_time, dt);
  m_board.latch(step(BleedingTask::check), stopped && dry && seen, m_goal.check_time, dt);
  watch_pool(where);
}

void BleedingJudge::tell(nlohmann::ordered_json& result) const {
  nlohmann::ordered_json& b = result["bleeding"];
  b["lost_mL"] = m_facts.lost / kMl;
  b["pool_mL"] = m_facts.pool / kMl;
  b["flow_mL_min"] = 60 * m_facts.flow / kMl;
  if (m_facts.began >= 0) b["began_s"] = m_facts.began;
  if (m_facts.stopped >= 0) b["stopped_s"] = m_facts.stopped;
  b["clips"] = {{"upstream", m_facts.upstream}, {"downstream", m_facts.downstream}, {"elsewhere", m_facts.elsewhere}};
}

}  // namespace trocar::training
