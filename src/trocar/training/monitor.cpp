#include <algorithm>

#include <nlohmann/json.hpp>

#include <trocar/numerics/portable.hpp>
#include <trocar/sim/visibility.hpp>
#include <trocar/training/monitor.hpp>
#include <trocar/vessels/lumen.hpp>

namespace trocar::training {
namespace {

constexpr int kSampleEvery = 20;                     // ticks between tip samples: 50 Hz
constexpr double kMoving = 0.005;                    // [m/s] slower is not a motion
constexpr double kOverForce = 0.1;                   // [s] an excursion that counts
constexpr double kTooNear = 0.010, kTooFar = 0.030;  // [m] from the uterus

enum Step { kPresent, kFirstClip, kSecondClip, kCut, kSteps };

int tool_index(const sim::Model& model, const std::string& name) {
  for (size_t t = 0; t < model.hands.size(); ++t)
    if (model.placed(t).name == name) return int(t);
  return -1;
}

Vec3d tip_of(const sim::Model& model, const sim::State& state, size_t tool) {
  return kinematics::forward(model.hands[tool].port, state.tools[tool].pose()).tip;
}

double norm(const double (&v)[3]) { return length(Vec3d{v[0], v[1], v[2]}); }

}  // namespace

Monitor::Monitor(const Exercise& exercise, const sim::Model& model) : m_exercise(exercise) {
  const Sterilisation& g = exercise.goal;
  std::vector<core::Fault> faults;
  std::vector<std::string> tubes, tools;
  for (const sim::StrandModel& strand : model.strands) tubes.push_back(strand.name);
  for (size_t h = 0; h < model.hands.size(); ++h) tools.push_back(model.placed(h).name);
  m_tube = model.strand_index(g.tube);
  if (m_tube < 0) faults.push_back({g.tube_at, scene::unknown_name("strand of the scene", g.tube, tubes)});
  const auto need = [&](const std::string& name, const core::Location& at, interactions::ToolKind kind,
                        const char* what) {
    const int tool = tool_index(model, name);
    if (tool < 0)
      faults.push_back({at, scene::unknown_name("tool of the scene", name, tools)});
    else if (model.placed(size_t(tool)).kind != kind)
      faults.push_back({at, std::string("expected ") + what + ", got \"" + name + "\", which is another kind of tool"});
  };
  need(g.grasper, g.grasper_at, interactions::ToolKind::grasper, "a grasper");
  need(g.applier, g.applier_at, interactions::ToolKind::clip_applier, "a clip applier");
  need(g.scissors, g.scissors_at, interactions::ToolKind::scissors, "scissors");
  if (!faults.empty()) throw core::BadInput(faults);
  m_grasper = tool_index(model, g.grasper);
  m_tube_arc = model.bodies[size_t(m_tube)].length();
  for (const sim::LandmarkModel& l : model.strands[size_t(m_tube)].landmarks)
    if (l.name == "isthmus") m_isthmus = l.to;
  m_steps = {{"Present the tube", "grasp the ampulla and lift it until the isthmus is straight, gently", false, 0},
             {"First clip", "on the isthmus, 12 to 20 mm from the uterus, straight across, close slowly", false, 0},
             {"Second clip", "6 to 12 mm farther out", false, 0},
             {"Cut", "between the clips, 2 mm clear of each", false, 0}};
  for (size_t t = 0; t < model.hands.size(); ++t) {
    m_tools.push_back({model.placed(t).name, 0, 0});
    const kinematics::FulcrumPose start = pose_of(model.start.tools[t]);
    m_last_tip.push_back(kinematics::forward(model.hands[t].port, start).tip);
  }
}

int Monitor::current() const {
  for (size_t i = 0; i < m_steps.size(); ++i)
    if (!m_steps[i].done) return int(i);
  return int(m_steps.size());
}

void Monitor::update(const sim::Model& model, const sim::State& state, const sim::StepReport& report) {
  m_now = state.tick;
  if (!finished() && m_moved) m_seconds = double(m_now - m_first_motion) * sim::kTick;
  if (state.tick % kSampleEvery == 0) measure(model, state);
  watch_errors(state, report);
  watch_steps(state);
  if (report.event_count > 0) check_lumen(model, state);
}

void Monitor::measure(const sim::Model& model, const sim::State& state) {
  for (size_t t = 0; t < m_tools.size(); ++t) {
    const Vec3d tip = tip_of(model, state, t);
    const double moved = length(tip - m_last_tip[t]);
    if (!m_moved && moved > kMoving * kSampleEvery * sim::kTick) {
      m_moved = true;
      m_first_motion = state.tick;
    }
    m_tools[t].path += moved;
    m_last_tip[t] = tip;
  }
  const interactions::StrandBody& tube = model.bodies[size_t(m_tube)];
  const tissue::StrandState& s = state.strands[size_t(m_tube)];
  double way = 0;
  int last = 0;
  for (int e = 0; e + 1 < tube.nodes() && tube.arc[size_t(e) + 1] <= m_isthmus + 1e-9; ++e) {
    if (!s.alive[size_t(e)]) break;
    way += length(s.x[size_t(e) + 1] - s.x[size_t(e)]);
    last = e + 1;
  }
  m_straightness = way > 0 ? length(s.x[size_t(last)] - s.x[0]) / way : 0;
}

void Monitor::complete(int step, bool condition, bool latched) {
  StepStatus& status = m_steps[size_t(step)];
  double& held = m_true_for[size_t(step)];
  held = condition ? held + sim::kTick : 0;
  if (status.done || held < (latched ? m_exercise.hold_time : 0.5 * sim::kTick)) return;
  status.done = true;
  status.at = double(m_now) * sim::kTick;
}

void Monitor::watch_steps(const sim::State& state) {
  const Sterilisation& g = m_exercise.goal;
  const interactions::ToolState& grasper = state.tools[size_t(m_grasper)];
  const bool holds_tube = grasper.holds > 0 && grasper.hold[0].body == m_tube;
  const bool beyond_isthmus = holds_tube && double(grasper.hold[0].element) * m_tube_arc >=
                                                m_isthmus * double(state.strands[size_t(m_tube)].alive.size());
  complete(kPresent,
           beyond_isthmus && g.present_pull.holds(norm(grasper.pull)) && m_straightness >= g.present_straightness,
           true);
  for (; m_clips_judged < state.clip_count; ++m_clips_judged) judge_clip(state.clips[size_t(m_clips_judged)]);
  for (; m_cuts_judged < state.cut_count; ++m_cuts_judged) judge_cut(state, state.cuts[size_t(m_cuts_judged)]);
  complete(kFirstClip, m_first_clip >= 0, false);
  complete(kSecondClip, m_second_clip >= 0, false);
}

void Monitor::judge_clip(const interactions::Clip& clip) {
  const Sterilisation& g = m_exercise.goal;
  if (clip.strand < 0) return make_error("E12");
  if (clip.strand != m_tube) return make_error("E11");
  if (clip.tips_visible < 2) make_error("E4");
  if (clip.cover < g.clip_cover) make_error("A1.cover");
  if (clip.theta > 2 * g.clip_angle)
    make_error("A1.oblique");
  else if (clip.theta > g.clip_angle)
    make_error("A1.angle");
  if (clip.s > kTooFar) make_error("A1.ampulla");
  if (clip.s < kTooNear) make_error("A1.cornu");
  const bool good = clip.cover >= g.clip_cover && clip.theta <= g.clip_angle && clip.tips_visible == 2 &&
                    clip.closing_time >= g.clip_closing;
  if (!good) return;
  if (m_first_clip < 0 && g.first_clip.holds(clip.s))
    m_first_clip = clip.s;
  else if (m_first_clip >= 0 && m_second_clip < 0 && g.second_clip.holds(clip.s) &&
           g.clip_distance.holds(clip.s - m_first_clip))
    m_second_clip = clip.s;
}

void Monitor::judge_cut(const sim::State& state, const interactions::Cut& cut) {
  const Sterilisation& g = m_exercise.goal;
  if (cut.strand != m_tube) return make_error("E11");
  if (cut.tips_visible < 1) make_error("E4");
  bool below = false, above = false, near_clip = false;
  for (int i = 0; i < state.clip_count; ++i) {
    const interactions::Clip& clip = state.clips[size_t(i)];
    if (clip.strand != m_tube) continue;
    below = below || clip.s < cut.s;
    above = above || clip.s > cut.s;
    near_clip = near_clip || std::fabs(clip.s - cut.s) < g.cut_margin;
  }
  if (!below || !above || near_clip) return make_error("A1.outside");
  complete(kCut,
           m_second_clip >= 0 && cut.s > m_first_clip && cut.s < m_second_clip && cut.fraction >= g.cut_fraction &&
               cut.beyond <= g.cut_beyond,
           false);
}

void Monitor::watch_errors(const sim::State& state, const sim::StepReport& report) {
  for (size_t t = 0; t < m_tools.size(); ++t)
    m_tools[t].max_pull = std::max(m_tools[t].max_pull, norm(state.tools[t].pull));
  const double pull = norm(state.tools[size_t(m_grasper)].pull);
  m_over_for = pull > m_exercise.goal.pull_limit ? m_over_for + sim::kTick : 0;
  if (m_over_for == 0) m_over_force = false;
  if (m_over_for >= kOverForce && !m_over_force) {
    m_over_force = true;
    make_error("E1");
  }
  for (int i = 0; i < report.event_count; ++i)
    if (report.events[i].kind == sim::Event::slipped) make_error("E3");
}

void Monitor::make_error(const std::string& code) {
  const Penalty* p = m_exercise.penalty(code);
  ErrorMade e;
  e.code = code;
  e.at = double(m_now) * sim::kTick;
  if (p) {
    e.meaning = p->meaning;
    e.points = p->points;
    e.fail = p->fail;
  }
  m_errors.push_back(e);
}

void Monitor::check_lumen(const sim::Model& model, const sim::State& state) {
  // A chain of segments between the strand's nodes; segment e is the element e.
  const int n = model.bodies[size_t(m_tube)].nodes();
  std::vector<vessels::LumenSegment> segments;
  std::vector<vessels::LumenClosure> closures;
  std::vector<std::int32_t> cuts;
  for (std::int32_t e = 0; e + 1 < n; ++e) {
    segments.push_back({e, e + 1});
    if (!state.strands[size_t(m_tube)].alive[size_t(e)]) cuts.push_back(e);
  }
  for (int i = 0; i < state.clip_count; ++i) {
    const interactions::Clip& clip = state.clips[size_t(i)];
    if (clip.strand == m_tube)
      closures.push_back({interactions::place_at(model.bodies[size_t(m_tube)], clip.s).element, float(clip.cover)});
  }
  vessels::LumenGraph graph;
  graph.nodes = n;
  graph.segments = segments;
  graph.closures = closures;
  graph.cuts = cuts;
  graph.closing_cover = float(m_exercise.goal.clip_cover);
  std::vector<std::int32_t> scratch(vessels::lumen_scratch_size(graph));
  m_occluded = !vessels::open_path(graph, 0, n - 1, scratch);
}

Score Monitor::score() const {
  Score s;
  int done = 0;
  for (const StepStatus& step : m_steps) done += step.done;
  s.quality = double(done) / double(m_steps.size());
  const double spare = m_exercise.longest_time - m_exercise.expert_time;
  s.time = finished() ? std::clamp((m_exercise.longest_time - m_seconds) / spare, 0.0, 1.0) : 0;
  for (const ErrorMade& e : m_errors) {
    s.penalties += e.points;
    s.failed = s.failed || e.fail;
  }
  // 60 Q + 25 T + 15 M; M (motion against a reference group) is left out until there is one, the rest renormalised.
  s.total = std::clamp((60 * s.quality + 25 * s.time) * 100 / 85 - s.penalties, 0.0, 100.0);
  s.passed = finished() && !s.failed && s.total >= m_exercise.pass_mark;
  return s;
}

std::string Monitor::result_json() const {
  const Score s = score();
  nlohmann::ordered_json j;
  j["exercise"] = m_exercise.name;
  j["finished"] = finished();
  j["passed"] = s.passed;
  j["score"] = {{"total", s.total},
                {"quality", s.quality},
                {"time", s.time},
                {"penalties", s.penalties},
                {"failed_by_error", s.failed},
                {"pass_mark", m_exercise.pass_mark},
                {"note", "motion component left out: no reference group yet"}};
  j["seconds"] = m_seconds;
  j["tube_occluded"] = m_occluded;
  j["steps"] = nlohmann::ordered_json::array();
  for (const StepStatus& step : m_steps) {
    nlohmann::ordered_json o{{"name", step.name}, {"done", step.done}};
    if (step.done) o["at_s"] = step.at;
    j["steps"].push_back(o);
  }
  j["errors"] = nlohmann::ordered_json::array();
  for (const ErrorMade& e : m_errors)
    j["errors"].push_back({{"code", e.code}, {"meaning", e.meaning}, {"points", e.points}, {"at_s", e.at}});
  j["tools"] = nlohmann::ordered_json::array();
  for (const ToolMetrics& t : m_tools)
    j["tools"].push_back({{"name", t.name}, {"path_m", t.path}, {"max_pull_N", t.max_pull}});
  return j.dump();
}

}  // namespace trocar::training
