#include <algorithm>
#include <string_view>

#include <trocar/interactions/lever.hpp>
#include <trocar/sim/visibility.hpp>
#include <trocar/training/clip_places.hpp>
#include <trocar/training/hands.hpp>
#include <trocar/training/monitor.hpp>

namespace trocar::training {
namespace {

constexpr int kSampleEvery = 20;                       // ticks between looks at steps and tips: 50 Hz
constexpr int kCollideEvery = 4;                       // ticks between looks at instruments against each other: 250 Hz
constexpr double kSample = kSampleEvery * sim::kTick;  // [s]
constexpr double kTrocarShare = 0.02;                  // of a tick in the mean of forces: over about 50 ms
constexpr double kMoving = 0.005;                      // [m/s] slower is not a motion
constexpr double kEnough = 1e-9;                       // [s] of rounding in sums of samples

using Faults = std::vector<core::Fault>;

template <class List>
std::vector<std::string> names_of(const List& list) {
  std::vector<std::string> names;
  for (const auto& item : list) names.push_back(item.name);
  return names;
}

template <class List>
int index_of(const List& list, const std::string& name) {
  for (size_t i = 0; i < list.size(); ++i)
    if (list[i].name == name) return int(i);
  return -1;
}

/// Finds what the exercise names in the scene; what is not there is a fault at its place in the exercise file.
struct Finder {
  const sim::Model& model;
  Faults& faults;

  int strand(const std::string& name, const core::Location& at) const {
    const int i = model.strand_index(name);
    if (i < 0) faults.push_back({at, scene::unknown_name("strand of the scene", name, names_of(model.strands))});
    return i;
  }
  std::vector<std::string> organ_names() const {
    std::vector<std::string> names;
    for (int i = 0; i < model.organs(); ++i) names.push_back(model.organ_name(i));
    return names;
  }
  int organ(const std::string& name, const core::Location& at) const {
    const int i = model.organ_index(name);
    if (i < 0) faults.push_back({at, scene::unknown_name("organ of the scene", name, organ_names())});
    return i;
  }
  /// As a hold names it; -1 for a fold that is drawn only.
  std::int32_t body(const Named& named) const {
    const int s = model.strand_index(named.name);
    if (s >= 0) return s;
    const int o = model.organ_index(named.name);
    if (o >= 0) return interactions::kSolidBase + o;
    const int fold = model.membrane_index(named.name);
    if (fold >= 0) return interactions::kMembraneBase + fold;
    if (index_of(model.sheets, named.name) < 0) {
      std::vector<std::string> known = names_of(model.strands);
      for (const std::string& n : organ_names()) known.push_back(n);
      faults.push_back({named.at, scene::unknown_name("body of the scene", named.name, known)});
    }
    return -1;
  }
  /// A membrane; -1 for a fold that is drawn only.
  int fold(const std::string& name, const core::Location& at) const {
    const int i = model.membrane_index(name);
    if (i < 0 && index_of(model.sheets, name) < 0) {
      std::vector<std::string> known = names_of(model.membranes);
      for (const std::string& n : names_of(model.sheets)) known.push_back(n);
      faults.push_back({at, scene::unknown_name("fold of the scene", name, known)});
    }
    return i;
  }
  void instrument(const std::string& name, const core::Location& at, interactions::ToolKind kind,
                  const char* what) const {
    std::vector<std::string> known;
    for (const sim::HandModel& hand : model.hands)
      for (const interactions::ToolModel& tool : hand.rack) {
        if (tool.name != name) {
          known.push_back(tool.name);
          continue;
        }
        if (tool.kind != kind)
          faults.push_back(
              {at, std::string("expected ") + what + ", got \"" + name + "\", which is another kind of tool"});
        return;
      }
    faults.push_back({at, scene::unknown_name("instrument of the scene", name, known)});
  }
  double landmark(int strand, const char* name, bool end, const core::Location& at) const {
    if (strand < 0) return 0;
    for (const sim::LandmarkModel& l : model.strands[size_t(strand)].landmarks)
      if (l.name == name) return end ? l.to : l.from;
    faults.push_back({at, std::string("expected a tube with the landmark \"") + name + "\", got none"});
    return 0;
  }
};

Vec3d place_on(const sim::Model& model, const sim::State& state, int strand, double s) {
  const interactions::StrandBody& body = model.bodies[size_t(strand)];
  return interactions::point_at(body, state.strands[size_t(strand)], interactions::place_at(body, s));
}

}  // namespace

Monitor::Monitor(const Exercise& exercise, const sim::Model& model, Mode mode)
    : m_exercise(exercise), m_mode(mode), m_sight(model) {
  const Sterilisation& g = exercise.goal;
  Faults faults;
  const Finder find{model, faults};
  find.instrument(g.grasper, g.grasper_at, interactions::ToolKind::grasper, "a grasper");
  find.instrument(g.applier, g.applier_at, interactions::ToolKind::clip_applier, "a clip applier");
  find.instrument(g.scissors, g.scissors_at, interactions::ToolKind::scissors, "scissors");
  find.organ(g.uterus, g.uterus_at);
  m_organs.push_back(model.target_index(g.uterus));
  const auto add_step = [&](const Side* side, Task task) {
    const TaskText& text = exercise.text(task);
    m_steps.push_back({side ? side->title + ": " + text.title : text.title, text.hint, text.name,
                       side ? side->name : std::string(), false, false, 0});
  };
  add_step(nullptr, Task::survey);
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
      m_tissues.delicate.push_back(w.tube);
      w.following = Following(g, model, w.tube);
      w.lumen = LumenCheck(model, w.tube, g.clip_cover);
    }
    m_sides.push_back(std::move(w));
    for (int task = 1; task < kTasks; ++task) add_step(&side, Task(task));
  }
  for (const Named& n : g.forbidden) find.body(n);
  for (const Named& n : g.delicate) m_tissues.delicate.push_back(find.body(n));
  for (const Named& n : g.bowel) m_tissues.bowel.push_back(find.body(n));
  if (!faults.empty()) throw core::BadInput(faults);
  m_true_for.resize(m_steps.size());
  m_seen_for.resize(m_organs.size());
  m_errors.reserve(256);
  m_held_side.fill(-1);
  const sim::State start = sim::initial_state(model);
  for (size_t h = 0; h < hands(model); ++h) {
    m_tools.push_back({model.hands[h].name, 0, 0});
    m_tip[h] = tip_of(model, start, h);
  }
}

bool Monitor::finished() const {
  return std::all_of(m_steps.begin(), m_steps.end(), [](const StepStatus& s) { return s.done || s.missed; });
}

int Monitor::current() const {
  const auto open = [this](int i) { return !m_steps[size_t(i)].done && !m_steps[size_t(i)].missed; };
  if (open(0)) return 0;
  const int sides = int(m_sides.size());
  for (int k = 0; k < sides; ++k)
    for (int task = 1; task < kTasks; ++task) {
      const int i = step_index((m_focus + k) % sides, Task(task));
      if (open(i)) return i;
    }
  return int(m_steps.size());
}

bool Monitor::occluded() const {
  return std::all_of(m_sides.begin(), m_sides.end(), [](const SideWatch& s) { return s.lumen.occluded(); });
}

void Monitor::update(const sim::Model& model, const sim::State& state, const sim::StepReport& report) {
  if (finished()) return;  // what comes after the last step is judged no more
  m_now = state.tick;
  if (m_moved) m_seconds = double(m_now - m_first_motion) * sim::kTick;
  watch_errors(model, state, report);
  for (; m_clips_judged < state.clip_count; ++m_clips_judged)
    judge_clip(model, state, state.clips[size_t(m_clips_judged)]);
  for (; m_cuts_judged < state.cut_count; ++m_cuts_judged) judge_cut(model, state, state.cuts[size_t(m_cuts_judged)]);
  if (report.event_count > 0)
    for (SideWatch& side : m_sides) side.lumen.update(model, state);
  if (state.tick % kSampleEvery != 0) return;
  measure(model, state);
  watch_steps(model, state);
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
  m_sight.update(m_exercise.goal, model, state, m_tip, now, kSample, mishaps);
  for (int i = 0; i < mishaps.count; ++i) make_error(mishaps.list[size_t(i)].code, -1, mishaps.list[size_t(i)].where);
  m_tip = now;
  for (SideWatch& side : m_sides) measure_side(side, model, state);
}

void Monitor::measure_side(SideWatch& side, const sim::Model& model, const sim::State& state) {
  side.facts.straightness = straightness_of(model, state, side.tube, side.isthmus);
  side.following.update(model, state, {m_tip.data(), m_tools.size()}, kSample);
  for (size_t h = 0; h < m_tools.size(); ++h) {
    if (held_arc(model, state, h, side.tube) < 0 && !holds(side, model, state, h)) continue;
    m_focus = int(&side - m_sides.data());
    const double pull = norm(state.tools[h].pull);
    Range& range = side.facts.pull;
    range = side.facts.held ? Range{std::min(range.low, pull), std::max(range.high, pull)} : Range{pull, pull};
    side.facts.held = true;
  }
}

int Monitor::side_of(int tube) const {
  for (size_t i = 0; i < m_sides.size(); ++i)
    if (m_sides[i].tube == tube) return int(i);
  return -1;
}

int Monitor::side_of_fold(int membrane) const {
  for (size_t i = 0; i < m_sides.size(); ++i)
    if (membrane >= 0 && m_sides[i].mesosalpinx == membrane) return int(i);
  return -1;
}

int Monitor::side_of_hold(std::int32_t body) const {
  return body >= interactions::kMembraneBase ? side_of_fold(body - interactions::kMembraneBase) : side_of(body);
}

bool Monitor::holds(const SideWatch& side, const sim::Model& model, const sim::State& state, size_t hand) const {
  const interactions::ToolState& tool = state.tools[hand];
  if (tool.holds == 0) return false;
  if (side.mesosalpinx >= 0 && tool.hold[0].body == interactions::kMembraneBase + side.mesosalpinx) return true;
  const double s = held_arc(model, state, hand, side.tube);
  return s >= side.isthmus && s <= side.ampulla;
}

void Monitor::done(int side, Task task) {
  StepStatus& s = step(side, task);
  if (s.done || s.missed) return;
  s.done = true;
  s.at = double(m_now) * sim::kTick;
  if (task != Task::survey) m_focus = side;
}

void Monitor::missed(int side, Task task) {
  StepStatus& s = step(side, task);
  if (s.done || s.missed) return;
  s.missed = true;
  s.at = double(m_now) * sim::kTick;
}

void Monitor::latch(int side, Task task, bool condition, double hold) {
  double& held = m_true_for[size_t(step_index(side, task))];
  held = condition ? held + kSample : 0;
  if (condition && held >= hold - kEnough) done(side, task);
}

bool Monitor::presented(const SideWatch& side, const sim::Model& model, const sim::State& state) const {
  const Sterilisation& g = m_exercise.goal;
  if (side.facts.straightness < g.present_straightness) return false;
  for (size_t h = 0; h < m_tools.size(); ++h) {
    if (model.tool(state, h).kind != interactions::ToolKind::grasper) continue;
    if (holds(side, model, state, h) && g.present_pull.holds(norm(state.tools[h].pull))) return true;
  }
  return false;
}

void Monitor::watch_steps(const sim::Model& model, const sim::State& state) {
  const Sterilisation& g = m_exercise.goal;
  bool surveyed = true;
  for (size_t i = 0; i < m_organs.size(); ++i) {
    double& seen_for = m_seen_for[i];
    if (seen_for >= g.survey_time - kEnough) continue;
    const int target = m_organs[i];
    const bool organ = target >= 0 && model.targets[size_t(target)].kind == sim::VisibilityTarget::organ;
    const bool seen = target >= 0 && sim::visible_share(model, state, target) >= (organ ? g.organ_share : 0.5);
    seen_for = seen ? seen_for + kSample : 0;
    surveyed = surveyed && seen_for >= g.survey_time - kEnough;
  }
  if (surveyed) done(0, Task::survey);
  for (size_t i = 0; i < m_sides.size(); ++i) {
    const SideWatch& side = m_sides[i];
    if (side.following.done()) done(int(i), Task::identify);
    latch(int(i), Task::present, presented(side, model, state), m_exercise.hold_time);
    latch(int(i), Task::check,
          side.lumen.stumps_closed() && stumps_in_view(model, state, side.trace_target, side.lumen.cut_element()),
          g.check_time);
    if (step(int(i), Task::present).done && !side.severed)
      m_sides[i].facts.best_straightness = std::max(side.facts.best_straightness, side.facts.straightness);
  }
}

void Monitor::touch_side(SideWatch& side, Vec3d where) {
  const int i = int(&side - m_sides.data());
  m_focus = i;
  missed(0, Task::survey);
  if (!step(i, Task::identify).done && !side.blamed) {
    side.blamed = true;
    make_error("A1.11", i, where);
  }
  missed(i, Task::identify);
}

void Monitor::judge_clip(const sim::Model& model, const sim::State& state, const interactions::Clip& clip) {
  const Sterilisation& g = m_exercise.goal;
  const Vec3d tip = tip_of(model, state, size_t(clip.tool));
  const int i = side_of(clip.strand);
  if (clip.dropped()) return make_error("E12", -1, tip);
  if (clip.strand < 0) return make_error("E11", -1, tip, named(model.vessels.list[size_t(clip.vessel - 1)].name));
  if (i < 0) return make_error("E11", -1, tip, named(model.strands[size_t(clip.strand)].name));
  SideWatch& side = m_sides[size_t(i)];
  const Vec3d where = place_on(model, state, clip.strand, clip.s);
  touch_side(side, where);
  const size_t before = m_errors.size();
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
  SideFacts::Clip& fact = f.clips[size_t(f.clip_count++)];
  fact = {
      clip.s, clip.theta, clip.cover, clip.closing_time, clip.tips_visible, false, false, double(m_now) * sim::kTick};
  fact.counts = m_errors.size() == before && place_of_a_clip(g, clip.s);
  if (m_errors.size() == before) place_clip(side, f.clip_count - 1, clip.s, where);
  fact.good = m_errors.size() == before;
}

void Monitor::place_clip(SideWatch& side, int index, double s, Vec3d where) {
  // The two may come in either order: a pair decides, and a clip alone counts for the place that it fits.
  const Sterilisation& g = m_exercise.goal;
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

void Monitor::judge_cut(const sim::Model& model, const sim::State& state, const interactions::Cut& cut) {
  const Sterilisation& g = m_exercise.goal;
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
    f.cuts[size_t(f.cut_count++)] = {cut.s, cut.fraction, depth, good, double(m_now) * sim::kTick};
  if (!through || side.severed) return;
  side.severed = true;
  if (good) done(i, Task::cut);
  for (const Task task : {Task::present, Task::first_clip, Task::second_clip, Task::cut}) missed(i, task);
}

void Monitor::judge_snip(const sim::Model& model, const sim::State& state, const interactions::Cut& cut) {
  // A fold alone: a nick of the mesosalpinx is nothing, a deep cut is; other folds are none of this exercise.
  const Vec3d tip = tip_of(model, state, size_t(cut.tool));
  const int i = side_of_fold(cut.membrane);
  if (i < 0) return make_error("E11", -1, tip, named(model.membranes[size_t(cut.membrane)].name));
  if (cut.tips_visible < 1) make_error("E4.2", i, tip);
  if (cut.fold > m_exercise.goal.cut_depth) make_error("A1.7", i, tip);
}

void Monitor::watch_errors(const sim::Model& model, const sim::State& state, const sim::StepReport& report) {
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
  for (size_t h = 0; h < m_tools.size(); ++h)
    if (state.tools[h].holds > 0) m_held_side[h] = side_of_hold(state.tools[h].hold[0].body);
  Mishaps mishaps;
  m_pull.update(m_exercise.goal, m_tissues, model, state, mishaps);
  m_tear.update(model, state, report, mishaps);
  m_pinch.update(m_exercise.goal, m_tissues, model, state, mishaps);
  if (state.tick % kCollideEvery == 0)
    m_collision.update(m_exercise.goal, model, state, kCollideEvery * sim::kTick, mishaps);
  for (int i = 0; i < report.event_count; ++i) {
    const sim::Event& e = report.events[i];
    if (e.kind == sim::Event::slipped) mishaps.add({"E3", e.tool, tip_of(model, state, size_t(e.tool)), ""});
    if (e.kind == sim::Event::exchanged) m_sight.exchanged(e.tool);
  }
  for (int i = 0; i < mishaps.count; ++i) {
    const Mishap& m = mishaps.list[size_t(i)];
    const bool held = m.hand >= 0 && (state.tools[size_t(m.hand)].holds > 0 || m.code == std::string_view("E3"));
    make_error(m.code, held ? m_held_side[size_t(m.hand)] : -1, m.where, m.detail);
  }
}

void Monitor::make_error(const char* code, int side, Vec3d where, std::string detail) {
  ErrorMade e;
  e.code = code;
  e.detail = std::move(detail);
  if (side >= 0) e.side = m_exercise.goal.sides[size_t(side)].name;
  e.at = double(m_now) * sim::kTick;
  e.where = where;
  if (const Penalty* p = m_exercise.penalty(e.code)) {
    e.name = p->name;
    e.meaning = p->meaning;
    e.hint = p->hint;
    e.points = p->points;
    e.fail = p->fail;
  }
  m_errors.push_back(e);
}

std::string Monitor::named(const std::string& body) const {
  for (const Named& n : m_exercise.goal.forbidden)
    if (n.name == body) return n.title;
  return body;
}

Score Monitor::score() const {
  Score s;
  double reached = 0, whole = 0;
  for (size_t i = 0; i < m_steps.size(); ++i) {
    const int task = i == 0 ? 0 : 1 + int(i - 1) % (kTasks - 1);
    const double weight = m_exercise.tasks[size_t(task)].weight;
    whole += weight;
    reached += m_steps[i].done ? weight : 0;
  }
  s.quality = whole > 0 ? reached / whole : 0;
  const double spare = m_exercise.longest_time - m_exercise.expert_time;
  s.time = finished() ? std::clamp((m_exercise.longest_time - m_seconds) / spare, 0.0, 1.0) : 0;
  for (const ErrorMade& e : m_errors) {
    s.penalties += e.points;
    s.failed = s.failed || e.fail;
  }
  // Motion against a reference group is left out until there is one, and the rest renormalised.
  const double shares = m_exercise.quality_share + m_exercise.time_share;
  const double earned = m_exercise.quality_share * s.quality + m_exercise.time_share * s.time;
  s.total = std::clamp(100 * earned / shares - s.penalties, 0.0, 100.0);
  s.scored = m_mode == Mode::assessed;
  s.passed = s.scored && finished() && !s.failed && s.total >= m_exercise.pass_mark;
  return s;
}

}  // namespace trocar::training
