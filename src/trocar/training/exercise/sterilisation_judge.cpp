#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include <trocar/numerics/portable.hpp>
#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/exercise/clip_places.hpp>
#include <trocar/training/exercise/hands.hpp>
#include <trocar/training/exercise/sterilisation_judge.hpp>

namespace trocar::training {
namespace {

constexpr double kEnough = 1e-9;  // [s] of rounding in sums of samples

Vec3d place_on(const sim::Model& model, const sim::State& state, int strand, double s) {
  const interactions::StrandBody& body = model.strand_bodies[size_t(strand)];
  return interactions::point_at(body, state.strands[size_t(strand)], interactions::place_at(body, s));
}

}  // namespace

SterilisationJudge::SterilisationJudge(const Exercise& exercise, const sim::Model& model, Scoreboard& board,
                                       Faults& faults)
    : m_exercise(exercise), m_goal(exercise.goal), m_board(board) {
  const Sterilisation& g = m_goal;
  const Finder find{model, faults};
  find.instrument(g.grasper, g.grasper_at, interactions::ToolKind::grasper, "a grasper");
  find.instrument(g.applier, g.applier_at, interactions::ToolKind::clip_applier, "a clip applier");
  find.instrument(g.scissors, g.scissors_at, interactions::ToolKind::scissors, "scissors");
  find.organ(g.uterus, g.uterus_at);
  m_organs.push_back(model.target_index(g.uterus));
  board.add_step(exercise.text(Task::survey));
  for (const Side& side : g.sides) {
    SideWatch w;
    w.tube = find.strand(side.tube, side.tube_at);
    find.organ(side.ovary, side.ovary_at);
    w.isthmus = find.landmark(w.tube, "isthmus", true, side.tube_at);
    w.ampulla = find.landmark(w.tube, "fimbria", false, side.tube_at);
    w.mesosalpinx = side.mesosalpinx.empty() ? -1 : find.fold(side.mesosalpinx, side.mesosalpinx_at);
    w.ovary_target = model.target_index(side.ovary);
    w.trace_target = model.target_index(side.tube + ".trace");
    m_organs.insert(m_organs.end(), {w.trace_target, w.ovary_target});
    if (w.tube >= 0) {
      w.following = Following(g, model, w.tube);
      w.lumen = LumenCheck(model, w.tube, g.clip_cover);
    }
    m_sides.push_back(std::move(w));
    for (int task = 1; task < kTasks; ++task) board.add_step(exercise.text(Task(task)), side.name, side.title);
  }
  for (const Named& n : g.forbidden) find.body(n);
  m_seen_for.resize(m_organs.size());
}

int SterilisationJudge::current() const {
  if (m_board.open(0)) return 0;
  const int sides = int(m_sides.size());
  for (int k = 0; k < sides; ++k)
    for (int task = 1; task < kTasks; ++task) {
      const int i = step_index((m_focus + k) % sides, Task(task));
      if (m_board.open(i)) return i;
    }
  return int(m_board.steps().size());
}

bool SterilisationJudge::occluded() const {
  return std::all_of(m_sides.begin(), m_sides.end(), [](const SideWatch& s) { return s.lumen.occluded(); });
}

void SterilisationJudge::tick(const sim::Model& model, const sim::State& state, const sim::StepReport& report) {
  for (; m_clips_judged < state.clip_count; ++m_clips_judged)
    judge_clip(model, state, state.clips[size_t(m_clips_judged)]);
  for (; m_cuts_judged < state.cut_count; ++m_cuts_judged) judge_cut(model, state, state.cuts[size_t(m_cuts_judged)]);
  if (report.event_count > 0)
    for (SideWatch& side : m_sides) side.lumen.update(model, state);
}

void SterilisationJudge::sample(const sim::Model& model, const sim::State& state, std::span<const Vec3d> tips,
                                double dt) {
  for (SideWatch& side : m_sides) measure_side(side, model, state, tips, dt);
  watch_survey(model, state, dt);
  for (size_t i = 0; i < m_sides.size(); ++i) {
    SideWatch& side = m_sides[i];
    if (side.following.done()) done(int(i), Task::identify);
    latch(int(i), Task::present, presented(side, model, state), m_exercise.hold_time, dt);
    latch(int(i), Task::check,
          side.lumen.stumps_closed() && stumps_in_view(model, state, side.trace_target, side.lumen.cut_element()),
          m_goal.check_time, dt);
    if (m_board.step(step_index(int(i), Task::present)).done && !side.severed)
      side.facts.best_straightness = std::max(side.facts.best_straightness, side.facts.straightness);
  }
}

void SterilisationJudge::measure_side(SideWatch& side, const sim::Model& model, const sim::State& state,
                                      std::span<const Vec3d> tips, double dt) {
  side.facts.straightness = straightness_of(model, state, side.tube, side.isthmus);
  side.following.update(model, state, tips, dt);
  for (size_t h = 0; h < tips.size(); ++h) {
    if (held_arc(model, state, h, side.tube) < 0 && !holds(side, model, state, h)) continue;
    m_focus = int(&side - m_sides.data());
    const double pull = norm(state.tools[h].pull);
    Range& range = side.facts.pull;
    range = side.facts.held ? Range{std::min(range.low, pull), std::max(range.high, pull)} : Range{pull, pull};
    side.facts.held = true;
  }
}

int SterilisationJudge::side_of(int tube) const {
  for (size_t i = 0; i < m_sides.size(); ++i)
    if (m_sides[i].tube == tube) return int(i);
  return -1;
}

int SterilisationJudge::side_of_fold(int membrane) const {
  for (size_t i = 0; i < m_sides.size(); ++i)
    if (membrane >= 0 && m_sides[i].mesosalpinx == membrane) return int(i);
  return -1;
}

const std::string& SterilisationJudge::side_of_hold(std::int32_t body) const {
  static const std::string none;
  const int side =
      body >= interactions::kMembraneBase ? side_of_fold(body - interactions::kMembraneBase) : side_of(body);
  return side < 0 ? none : m_goal.sides[size_t(side)].name;
}

bool SterilisationJudge::holds(const SideWatch& side, const sim::Model& model, const sim::State& state,
                               size_t hand) const {
  const interactions::ToolState& tool = state.tools[hand];
  if (tool.holds == 0) return false;
  if (side.mesosalpinx >= 0 && tool.hold[0].body == interactions::kMembraneBase + side.mesosalpinx) return true;
  const double s = held_arc(model, state, hand, side.tube);
  return s >= side.isthmus && s <= side.ampulla;
}

void SterilisationJudge::done(int side, Task task) {
  const int i = step_index(side, task);
  if (!m_board.open(i)) return;
  m_board.done(i);
  if (task != Task::survey) m_focus = side;
}

void SterilisationJudge::latch(int side, Task task, bool condition, double hold, double dt) {
  const int i = step_index(side, task);
  const bool open = m_board.open(i);
  m_board.latch(i, condition, hold, dt);
  if (open && !m_board.open(i)) m_focus = side;
}

void SterilisationJudge::make_error(const char* code, int side, Vec3d where, std::string detail) {
  m_board.make_error(code, side < 0 ? std::string() : m_goal.sides[size_t(side)].name, where, std::move(detail));
}

bool SterilisationJudge::presented(const SideWatch& side, const sim::Model& model, const sim::State& state) const {
  if (side.facts.straightness < m_goal.present_straightness) return false;
  for (size_t h = 0; h < hands(model); ++h) {
    if (model.tool(state, h).kind != interactions::ToolKind::grasper) continue;
    if (holds(side, model, state, h) && m_goal.present_pull.holds(norm(state.tools[h].pull))) return true;
  }
  return false;
}

void SterilisationJudge::watch_survey(const sim::Model& model, const sim::State& state, double dt) {
  const Sterilisation& g = m_goal;
  bool surveyed = true;
  for (size_t i = 0; i < m_organs.size(); ++i) {
    double& seen_for = m_seen_for[i];
    if (seen_for >= g.survey_time - kEnough) continue;
    const int target = m_organs[i];
    const bool organ = target >= 0 && model.targets[size_t(target)].kind == sim::VisibilityTarget::organ;
    const bool seen = target >= 0 && sim::visible_share(model, state, target) >= (organ ? g.organ_share : 0.5);
    seen_for = seen ? seen_for + dt : 0;
    surveyed = surveyed && seen_for >= g.survey_time - kEnough;
  }
  if (surveyed) done(0, Task::survey);
}

void SterilisationJudge::touch_side(SideWatch& side, Vec3d where) {
  const int i = int(&side - m_sides.data());
  m_focus = i;
  missed(0, Task::survey);
  if (!m_board.step(step_index(i, Task::identify)).done && !side.blamed) {
    side.blamed = true;
    make_error("A1.11", i, where);
  }
  missed(i, Task::identify);
}

void SterilisationJudge::judge_clip(const sim::Model& model, const sim::State& state, const interactions::Clip& clip) {
  const Sterilisation& g = m_goal;
  const Vec3d tip = tip_of(model, state, size_t(clip.tool));
  const int i = side_of(clip.strand);
  if (clip.dropped()) return make_error("E12", -1, tip);
  if (clip.strand < 0) return make_error("E11", -1, tip, named(model.vessels.list[size_t(clip.vessel - 1)].name));
  if (i < 0) return make_error("E11", -1, tip, named(model.strands[size_t(clip.strand)].name));
  SideWatch& side = m_sides[size_t(i)];
  const Vec3d where = place_on(model, state, clip.strand, clip.s);
  touch_side(side, where);
  const size_t before = m_board.errors().size();
  if (clip.tips_visible < 2) make_error("E4.2", i, where);
  if (clip.s > g.ampulla_from) make_error("A1.1", i, where);
  if (clip.s < g.cornu_to) make_error("A1.2", i, where);
  if (clip.cover < g.clip_cover) make_error("A1.3", i, where);
  if (clip.theta > g.clip_oblique)
    make_error("A1.5", i, where);
  else if (clip.theta > g.clip_angle)
    make_error("A1.4", i, where);
  if (clip.closing_time < g.clip_closing) make_error("A1.8", i, where);
  SideFacts& f = side.facts;
  if (f.clip_count == int(f.clips.size())) return;
  SideFacts::ClipFact& fact = f.clips[size_t(f.clip_count++)];
  fact = {clip.s, clip.theta, clip.cover, clip.closing_time, clip.tips_visible, false, false, m_board.now()};
  fact.counts = m_board.errors().size() == before && place_of_a_clip(g, clip.s);
  if (m_board.errors().size() == before) place_clip(side, f.clip_count - 1, clip.s, where);
  fact.good = m_board.errors().size() == before;
}

void SterilisationJudge::place_clip(SideWatch& side, int index, double s, Vec3d where) {
  // The two may come in either order: a pair decides, and a clip alone counts for the place that it fits.
  const Sterilisation& g = m_goal;
  const int i = int(&side - m_sides.data());
  const SideFacts& f = side.facts;
  const auto pair = [&](double inner, double outer) {
    if (!are_a_pair(g, inner, outer)) return false;
    done(i, Task::first_clip);
    done(i, Task::second_clip);
    side.facts.pair = {inner, outer};
    return true;
  };
  if (f.pair[0] >= 0 && f.pair[1] >= 0) return;  // one more does no harm
  bool others = false;
  for (int k = 0; k < index; ++k) {
    if (!f.clips[size_t(k)].counts) continue;
    others = true;
    if (pair(f.clips[size_t(k)].s, s) || pair(s, f.clips[size_t(k)].s)) return;
  }
  if (others || !f.clips[size_t(index)].counts) return make_error("A1.9", i, where);
  const bool inner = g.first_clip.holds(s);
  done(i, inner ? Task::first_clip : Task::second_clip);
  side.facts.pair[inner ? 0 : 1] = s;
}

void SterilisationJudge::judge_cut(const sim::Model& model, const sim::State& state, const interactions::Cut& cut) {
  const Sterilisation& g = m_goal;
  const Vec3d tip = tip_of(model, state, size_t(cut.tool));
  const int i = side_of(cut.strand);
  if (cut.strand < 0 && cut.solid < 0 && cut.membrane >= 0) return judge_snip(model, state, cut);
  if (i < 0) {
    const std::string& body = cut.strand >= 0 ? model.strands[size_t(cut.strand)].name : model.organ_name(cut.solid);
    return make_error("E11", -1, tip, named(body));
  }
  SideWatch& side = m_sides[size_t(i)];
  const Vec3d where = place_on(model, state, cut.strand, cut.s);
  touch_side(side, where);
  if (cut.tips_visible < 1) make_error("E4.2", i, where);
  bool below = false, above = false, near_clip = false;
  for (int k = 0; k < side.facts.clip_count; ++k) {
    const double s = side.facts.clips[size_t(k)].s;
    below = below || s < cut.s;
    above = above || s > cut.s;
    near_clip = near_clip || std::fabs(s - cut.s) < g.cut_margin;
  }
  // Where the fold is a body it says how deep it was cut; otherwise the blades' reach beyond the tube stands for it.
  const double depth = side.mesosalpinx >= 0 ? cut.fold : cut.beyond;
  const bool through = cut.fraction >= g.cut_fraction, between = below && above && !near_clip;
  if (!between) make_error("A1.6", i, where);
  if (depth > g.cut_depth) make_error("A1.7", i, where);
  if (!through) make_error("A1.10", i, where);
  SideFacts& f = side.facts;
  const bool good = through && between && depth <= g.cut_depth && !side.severed;
  if (f.cut_count < int(f.cuts.size()))
    f.cuts[size_t(f.cut_count++)] = {cut.s, cut.fraction, depth, good, m_board.now()};
  if (!through || side.severed) return;
  side.severed = true;
  if (good) done(i, Task::cut);
  for (const Task task : {Task::present, Task::first_clip, Task::second_clip, Task::cut}) missed(i, task);
}

void SterilisationJudge::judge_snip(const sim::Model& model, const sim::State& state, const interactions::Cut& cut) {
  // A fold alone: a nick of the mesosalpinx is nothing, a deep cut is; other folds are none of this exercise.
  const Vec3d tip = tip_of(model, state, size_t(cut.tool));
  const int i = side_of_fold(cut.membrane);
  if (i < 0) return make_error("E11", -1, tip, named(model.membranes[size_t(cut.membrane)].name));
  if (cut.tips_visible < 1) make_error("E4.2", i, tip);
  if (cut.fold > m_goal.cut_depth) make_error("A1.7", i, tip);
}

std::string SterilisationJudge::named(const std::string& body) const {
  for (const Named& n : m_goal.forbidden)
    if (n.name == body) return n.title;
  return body;
}

namespace {

using Json = nlohmann::ordered_json;

Json side_json(const Side& side, const SideFacts& f, const LumenCheck& lumen) {
  const double degrees = 180 / portable::pi;
  Json j{{"side", side.name}, {"tube", side.tube}, {"clips", Json::array()}, {"cuts", Json::array()}};
  for (int i = 0; i < f.clip_count; ++i) {
    const SideFacts::ClipFact& c = f.clips[size_t(i)];
    j["clips"].push_back({{"s_mm", c.s * 1000},
                          {"angle_deg", c.theta * degrees},
                          {"cover", c.cover},
                          {"closing_s", c.closing},
                          {"tips_visible", c.tips_visible},
                          {"good", c.good},
                          {"at_s", c.at}});
  }
  if (f.pair[0] >= 0 && f.pair[1] >= 0) j["clip_distance_mm"] = (f.pair[1] - f.pair[0]) * 1000;
  for (int i = 0; i < f.cut_count; ++i) {
    const SideFacts::Cut& c = f.cuts[size_t(i)];
    j["cuts"].push_back({{"s_mm", c.s * 1000},
                         {"fraction", c.fraction},
                         {"depth_mm", c.beyond * 1000},
                         {"good", c.good},
                         {"at_s", c.at}});
  }
  j["straightness"] = f.best_straightness;
  if (f.held) j["pull_N"] = {{"from", f.pull.low}, {"to", f.pull.high}};
  j["lumen"] = lumen.occluded() ? "occluded" : "open";
  j["stumps"] = !lumen.severed() ? "not cut" : lumen.stumps_closed() ? "closed" : "open";
  return j;
}

}  // namespace

void SterilisationJudge::tell(Json& result) const {
  result["tube_occluded"] = occluded();
  Json& sides = result["sides"] = Json::array();
  for (size_t i = 0; i < m_sides.size(); ++i)
    sides.push_back(side_json(m_goal.sides[i], m_sides[i].facts, m_sides[i].lumen));
}

}  // namespace trocar::training
