// What the scripted surgeon does in each phase; the table in surgeon.cpp names them.
#include <algorithm>

#include <trocar/interactions/verbs/clip.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/exercise/hands.hpp>
#include <trocar/training/expert/surgeon.hpp>

namespace trocar::training {
namespace {

constexpr double kTravel = 0.045, kCareful = 0.018, kTrack = 0.004;  // [m/s] through the open, at tissue, following it
constexpr double kIdleDepth = 0.042;                                 // [m] an instrument that waits
constexpr double kInDepth = 0.085;                                   // [m] one that was brought in
constexpr double kHalf = 0.42;                                       // handle of a half closed applier
constexpr int kSampleEvery = 20;                                     // ticks between looks along the tube

}  // namespace

void Surgeon::survey() {
  constexpr double kGlance = 1.4;  // [s] at the picture as it is
  const LookedFor* missing = nullptr;
  for (LookedFor& l : m_survey) {
    if (l.seen_for >= m_exercise.goal.survey_time + 0.1) continue;
    const bool seen = l.target >= 0 && sim::visible_share(*m_model, *m_state, l.target) >= l.share;
    l.seen_for = seen ? l.seen_for + sim::kTick : 0;
    if (!missing) missing = &l;
  }
  if (flawed("A1.11")) {  // a glance to the other side, and straight to work
    want(other_side());
    return m_in_phase > 2.5 ? go(Phase::decide) : void();
  }
  if (!missing) return go(Phase::decide);
  if (m_in_phase < kGlance || missing->target < 0) return;
  want_all_of(missing->target);
  m_distance = 0.07;
  // What instruments hide shows when they are drawn back.
  if (m_in_phase > kGlance + 2.5)
    for (int h = 0; h < m_arms.count(); ++h) clear_the_way(h);
}

void Surgeon::decide() {
  const Sterilisation& g = m_exercise.goal;
  SideWork& w = side();
  m_target_strand = -1;
  const std::pair<int, const std::string*> needs[] = {{w.grasper, &g.grasper}, {w.scissors, &g.scissors}};
  for (const auto& [hand, instrument] : needs) {
    const int number = m_model->hands[size_t(hand)].find(*instrument);
    if (m_arms[hand].instrument == number) continue;
    m_fetching = hand;
    m_wanted = number;
    return go(Phase::put_down);
  }
  if (severed()) {
    if (!w.looked_at_stumps) return go(Phase::check);
    if (tool_state(w.grasper).holds > 0) return go(Phase::lower);
    if (m_side + 1 == int(m_sides.size())) return go(Phase::finished);
    ++m_side;
    m_on_side = 0;
    m_attempts = 0;
    return;
  }
  if (!w.following.done() && !flawed("A1.11")) return go(Phase::identify);
  for (const char* code : {"E2", "E4.1", "E12"})
    if (flawed(code)) {
      m_stage = 0;
      return go(Phase::blunder);
    }
  if (!holding()) return go(tool_state(w.grasper).holds > 0 ? Phase::let_go : Phase::reach_ampulla);
  if (flawed("E5")) {
    m_stage = 0;
    return go(Phase::blunder);
  }
  if (next_clip_at() < 0) return go(Phase::reach_cut);
  m_failed_clips += m_state->clip_count == m_clips_before;
  if (m_state->clip_count == m_clips_before && ++m_clip_tries > 2) {  // it does not come right here: take it elsewhere
    m_clip_tries = 0;
    return go(Phase::lower);
  }
  go(Phase::reach_clip);
}

void Surgeon::put_down() {
  if (tool_state(m_fetching).holds > 0 || m_arms[m_fetching].handle > 0) {
    m_arms.grip(m_fetching, 0, 0.4);
    return;
  }
  if (m_arms.move_to_depth(m_fetching, kIdleDepth, 2 * kTravel)) go(Phase::fetch);
}

void Surgeon::fetch() {
  Arms::Arm& arm = m_arms[m_fetching];
  arm.instrument = m_wanted;
  const Vec3d inwards = normalised(tube_point(side().ampulla_from) - arm.port);
  arm.tip = arm.port + kIdleDepth * inwards;
  if (!flawed("E13")) {
    want(arm.port + 0.055 * inwards);
    want(arm.port + kInDepth * inwards);
  } else {
    want(tube_point(0));
  }
  if (tool_state(m_fetching).instrument == m_wanted && m_camera.settled() && m_in_phase > 0.6) go(Phase::bring_in);
}

void Surgeon::bring_in() {
  const Arms::Arm& arm = m_arms[m_fetching];
  const Vec3d inwards = normalised(tube_point(side().ampulla_from) - arm.port);
  if (!flawed("E13")) {
    want(arm.tip);
    want(arm.tip + 0.02 * inwards);
  } else {
    want(tube_point(0));
  }
  if (!m_arms.move_to_depth(m_fetching, kInDepth, 0.035)) return;
  m_blundered = m_blundered || flawed("E13");
  go(Phase::decide);
}

void Surgeon::identify() {
  constexpr double kByHand = 9;  // [s] after which the instrument helps the eye
  SideWork& w = side();
  std::array<Vec3d, sim::kMaxTools> tips{};
  for (int h = 0; h < m_arms.count(); ++h) tips[size_t(h)] = tip_of(*m_model, *m_state, size_t(h));
  if (m_state->tick % kSampleEvery == 0)
    w.following.update(*m_model, *m_state, {tips.data(), size_t(m_arms.count())}, kSampleEvery * sim::kTick);
  if (w.following.done()) return go(Phase::decide);
  const Vec3d front = w.following.begun() ? tube_point(w.following.reached()) : centre_of(w.fimbria_target);
  want(front);
  if (w.following.begun()) want(tube_point(std::max(0.0, w.following.reached() - 0.015)));
  if (m_in_phase > 0.4 * kByHand) {
    clear_the_way(w.scissors);
    clear_the_way(m_applier);
  }
  if (m_in_phase < kByHand) return;
  m_arms.grip(w.grasper, 1, 0.6);
  want(m_arms[w.grasper].tip);
  if (sees_tip(w.grasper) || m_in_phase < kByHand + 1)
    m_arms.move(w.grasper, front + Vec3d{0, 0, 0.0075}, 0.6 * kTravel);
}

void Surgeon::reach_ampulla() {
  const SideWork& w = side();
  const double span = w.ampulla_to - w.ampulla_from;
  constexpr double kPlaces[] = {0.42, 0.54, 0.34, 0.62};  // of the ampulla: another one after each failure
  m_grasp_at = w.ampulla_from + span * (flawed("A1.11") ? 0.1 : kPlaces[m_attempts % 4]);
  want(tube_point(m_grasp_at));
  clear_the_way(m_applier);
  clear_the_way(w.scissors);
  const bool open = m_arms.grip(w.grasper, 0, 0.5);
  if (approach(w.grasper, m_grasp_at, 0.6 * tool(w.grasper).jaw_length, kTravel) && open) {
    ++m_attempts;
    go(Phase::enter_ampulla);
  }
}

void Surgeon::enter_ampulla() {
  want(tube_point(m_grasp_at));
  want(m_arms[side().grasper].tip);
  if (aim(side().grasper, m_grasp_at, 0.6 * tool(side().grasper).jaw_length, 0, kCareful)) go(Phase::grasp);
}

void Surgeon::grasp() {
  constexpr double kFirm = 0.95;
  const int hand = side().grasper;
  want(tube_point(m_grasp_at));
  if (flawed("E3") && tool_state(hand).holds > 0 && (m_steady > 0 || tool_state(hand).pinch > 0.1)) {
    // Hardly closed, and drawn back at once: the tube slides out over the jaws' ends.
    if (m_steady == 0) m_lift_from = m_arms[hand].tip;
    m_steady += sim::kTick;
    m_arms.move(hand, m_lift_from + 0.035 * normalised(m_arms[hand].port - m_lift_from), kCareful);
    return;
  }
  if (flawed("E3") && m_steady > 0) {
    m_blundered = true;
    return go(Phase::let_go);
  }
  if (!m_arms.grip(hand, kFirm, 0.8) || m_in_phase < 1.2) return;
  if (!holding()) return go(Phase::let_go);
  m_lift_from = m_arms[hand].tip;
  m_lifted = m_drawn = 0;
  const Vec3d out = tube_point(m_grasp_at) - tube_point(m_exercise.goal.first_clip.low);
  m_outwards = normalised(Vec3d{out.x, out.y, 0});
  m_lift_up = normalised(Vec3d{tube_point(m_grasp_at).x > 0 ? 0.35 : -0.35, 0.10, 1.0});
  go(Phase::lift);
}

void Surgeon::lift() {
  const Sterilisation& g = m_exercise.goal;
  const SideWork& w = side();
  want(tube_point(m_grasp_at));
  const double next = next_clip_at();
  m_clip_place = next >= 0 ? next : cut_at();
  want(tube_point(m_clip_place));
  if (!holding()) return go(Phase::let_go);
  if (flawed("E1")) {
    Arms::Arm& arm = m_arms[w.grasper];
    const bool hard = pull() > g.pull_limit + 0.2;
    m_steady += hard ? sim::kTick : 0;
    if (!hard) m_lifted += kCareful * sim::kTick;
    arm.tip = m_lift_from + m_lifted * m_lift_up;
    m_blundered = m_steady > 2 * g.pull_excursion;
    return;
  }
  if (flawed("E1.2")) {
    m_lifted += kCareful * sim::kTick;
    m_arms[w.grasper].tip = m_lift_from + m_lifted * m_lift_up;
    const std::vector<std::uint8_t>& alive = m_state->strands[size_t(w.tube)].alive;
    m_blundered = std::find(alive.begin(), alive.end(), 0) != alive.end();
    return;
  }
  keep_presented();
  if (wanted_slant() > 0) {  // pushed down, the jaws leave the picture first
    want(m_arms[w.grasper].tip);
    return slant(m_applier, m_clip_place) > wanted_slant() - 0.02 ? go(Phase::decide) : void();
  }
  const bool good = std::fabs(slant(m_applier, m_clip_place)) < 0.13 && pull() > g.present_pull.low + 0.08 &&
                    pull() < 0.9 * g.present_pull.high &&
                    straightness_of(*m_model, *m_state, w.tube, w.ampulla_from) > g.present_straightness + 0.002;
  m_steady = good ? m_steady + sim::kTick : 0;
  if (m_steady > 2 * m_exercise.hold_time) go(Phase::decide);
}

Vec3d Surgeon::other_side() const {
  const Vec3d cornu = tube_point(0);
  return {-3 * cornu.x, cornu.y, cornu.z};
}

double Surgeon::clip_inside() const {
  // The tube next to the clip's bend, so that both legs' tips come into view beyond it; nearer while they do not.
  const interactions::ToolModel& t = tool(m_applier);
  const interactions::StrandBody& tube = m_model->strand_bodies[size_t(m_strand)];
  const double radius = tube.model.radius[size_t(interactions::place_at(tube, m_clip_place).element)];
  if (flawed("A1.3")) return t.jaw_length - 0.3 * radius;
  return t.jaw_length - t.clip_length + radius + m_spare;
}

double Surgeon::cut_inside() const {
  const interactions::ToolModel& t = tool(side().scissors);
  if (flawed("A1.7")) return t.jaw_length - m_exercise.goal.cut_depth - 0.0065;
  if (flawed("A1.10")) return t.jaw_length;
  return 0.82 * t.jaw_length;  // near the blades' ends: spare the fold behind the tube
}

bool Surgeon::clip_fits() const {
  const Sterilisation& g = m_exercise.goal;
  const interactions::ToolModel& t = tool(m_applier);
  const interactions::ToolShape shape =
      interactions::shape_of(t, tool_state(m_applier).pose(), tool_state(m_applier).aperture);
  const interactions::StrandBody& tube = m_model->strand_bodies[size_t(m_strand)];
  const interactions::StrandPlace place = interactions::place_at(tube, m_clip_place);
  const Vec3d local = interactions::to_jaw(shape, tube_point(m_clip_place));
  const double radius = tube.model.radius[size_t(place.element)];
  const double cover = interactions::leg_cover(local.z - (t.jaw_length - t.clip_length), radius, t.clip_length);
  const double square = std::fabs(dot(shape.frame.normal(), tube_tangent(m_clip_place)));
  const bool enclosed = flawed("A1.3") || (cover >= g.clip_cover + 0.01 && std::fabs(local.x) < shape.half_gap);
  const double askew = portable::acos(std::min(1.0, square));
  bool across = askew < g.clip_angle - 0.035;
  if (flawed("A1.4")) across = askew > g.clip_angle + 0.05 && askew < g.clip_oblique - 0.05;
  if (flawed("A1.5")) across = askew > g.clip_oblique + 0.05;
  // Whoever takes the wrong structure, or this one so askew, does not look for the lower leg behind it.
  const bool careless = flawed("E11") || flawed("A1.5");
  const bool seen = careless || sees_jaws(m_applier) != flawed("E4.2");
  return enclosed && across && seen;
}

void Surgeon::reach_clip() {
  const Sterilisation& g = m_exercise.goal;
  if (!holding()) return go(Phase::let_go);
  const double next = next_clip_at();
  if (next < 0) return go(Phase::decide);
  m_clip_place = next;
  if (flawed("A1.1")) m_clip_place = g.ampulla_from + 0.0015;
  if (flawed("A1.2")) m_clip_place = g.cornu_to - 0.003;
  if (flawed("A1.9")) m_clip_place = g.first_clip.high - 0.001;
  if (flawed("E11")) {
    m_target_strand = m_model->strand_index(g.forbidden.front().name);
    m_clip_place = 0.5 * m_model->strand_bodies[size_t(m_target_strand)].length();
  }
  m_clips_before = m_state->clip_count;
  keep_presented();
  clear_the_way(side().scissors);
  want(tube_point(m_clip_place));
  m_spare = 0.001;
  m_unseen = 0;
  const bool open = m_arms.grip(m_applier, 0, 0.5);
  if (approach(m_applier, m_clip_place, clip_inside(), kTravel) && open) go(Phase::enter_clip);
}

void Surgeon::enter_clip() {
  if (!holding()) return go(Phase::leave_clip);
  keep_across();
  want(tube_point(m_clip_place));
  want(m_arms[m_applier].tip);
  if (aim(m_applier, m_clip_place, clip_inside(), 0, kCareful)) go(Phase::inspect_clip);
}

void Surgeon::look_at_clip() {
  const Vec3d at = tube_point(m_clip_place);
  if (flawed("E4.2")) return want(other_side());
  // From the midline, if the legs' tips stay hidden: then they are seen past the tube, beside the picture's middle.
  constexpr double kPatience = 3, kAside = 0.03;  // [s] [m]
  want(m_unseen > kPatience ? at - Vec3d{at.x > 0 ? kAside : -kAside, 0, 0} : at);
}

void Surgeon::inspect_clip() {
  if (!holding()) return go(Phase::leave_clip);
  keep_across();
  look_at_clip();
  // Where a jaw's tip is hidden, another distance or side may show it, and a tube deeper between the legs.
  m_unseen += sees_jaws(m_applier) ? 0 : sim::kTick;
  m_distance = m_seen_from = 0.052 + 0.008 * double(int(m_in_phase / 1.5) % 4);
  if (m_in_phase > 0.5 && !sees_jaws(m_applier)) m_spare = std::max(0.0007, m_spare - 0.0003 * sim::kTick);
  aim(m_applier, m_clip_place, clip_inside(), 0, kTrack);
  // Half closed, the legs' tips show beyond the tube; a little further, if not.
  const double wanted = kHalf + (m_in_phase > 2 && !sees_jaws(m_applier) ? std::min(0.24, 0.06 * (m_in_phase - 2)) : 0);
  if (!m_arms.grip(m_applier, std::max(wanted, m_arms[m_applier].handle), 1.6)) return;
  m_steady = clip_fits() ? m_steady + sim::kTick : 0;
  if (m_steady < 0.15) return;
  m_clip_tries = m_failed_clips = 0;
  go(Phase::close_clip);
}

void Surgeon::close_clip() {
  look_at_clip();
  m_distance = m_seen_from;
  aim(m_applier, m_clip_place, clip_inside(), 0, kTrack);
  const double whole = flawed("A1.8") ? 0.6 : 2.6;  // [share of the closing time] from open to closed
  if (!m_arms.grip(m_applier, 1, whole * m_exercise.goal.clip_closing) || m_state->clip_count == m_clips_before) return;
  for (const char* code : {"E4.2", "E11", "A1.1", "A1.2", "A1.3", "A1.4", "A1.5", "A1.8", "A1.11"})
    m_blundered = m_blundered || flawed(code);
  if (flawed("A1.9") && m_state->clip_count > 1) m_blundered = true;
  go(Phase::open_clip);
}

void Surgeon::open_clip() {
  want(tube_point(m_clip_place));
  if (m_arms.grip(m_applier, 0, 0.5)) go(Phase::leave_clip);
}

void Surgeon::leave_clip() {
  want(tube_point(m_clip_place));
  want(m_arms[m_applier].tip);
  m_arms.grip(m_applier, 0, 0.5);
  if (aim(m_applier, m_clip_place, clip_inside(), 0.022, kCareful)) go(Phase::decide);
}

double Surgeon::outermost_clip() const {
  double s = 0;
  for (int i = 0; i < m_state->clip_count; ++i)
    if (m_state->clips[size_t(i)].strand == side().tube) s = std::max(s, m_state->clips[size_t(i)].s);
  return s;
}

void Surgeon::keep_across() {
  // Whoever clips askew, or something else, does not mind how the tube lies.
  if (!flawed("A1.4") && !flawed("A1.5") && !flawed("E11")) keep_presented();
}

void Surgeon::reach_cut() {
  if (!holding()) return go(Phase::let_go);
  m_cut_place = flawed("A1.6") ? outermost_clip() + 0.003 : cut_at();
  keep_presented();
  clear_the_way(m_applier);
  want(tube_point(m_cut_place));
  const int hand = side().scissors;
  const bool open = m_arms.grip(hand, 0, 0.5);
  if (approach(hand, m_cut_place, cut_inside(), kTravel) && open) go(Phase::enter_cut);
}

void Surgeon::enter_cut() {
  clear_the_way(m_applier);
  want(tube_point(m_cut_place));
  want(m_arms[side().scissors].tip);
  const bool there = aim(side().scissors, m_cut_place, cut_inside(), 0, m_in_phase < 3 ? kCareful : kTrack);
  m_steady = there && sees_tip(side().scissors) ? m_steady + sim::kTick : 0;
  if (m_steady > 0.1) go(Phase::close_cut);
}

void Surgeon::close_cut() {
  want(tube_point(m_cut_place));
  aim(side().scissors, m_cut_place, cut_inside(), 0, kTrack);
  if (!m_arms.grip(side().scissors, 1, 0.6)) return;
  for (const char* code : {"A1.6", "A1.7", "A1.10"}) m_blundered = m_blundered || flawed(code);
  go(Phase::open_cut);
}

void Surgeon::open_cut() {
  want(tube_point(m_cut_place));
  if (m_arms.grip(side().scissors, 0, 0.5)) go(Phase::leave_cut);
}

void Surgeon::leave_cut() {
  want(tube_point(m_cut_place));
  want(m_arms[side().scissors].tip);
  const int hand = side().scissors;
  m_arms.grip(hand, 0, 0.5);
  if (m_in_phase < 1.5 * sim::kTick) m_left_from = m_arms[hand].tip;
  if (length(m_arms[hand].tip - m_left_from) > 0.02 || m_in_phase > 3) return go(Phase::decide);
  const Vec3d back = normalised(m_arms[hand].port - m_arms[hand].tip);
  m_arms.move(hand, m_arms[hand].tip + 0.01 * back, kCareful);
}

void Surgeon::check() {
  SideWork& w = side();
  clear_the_way(w.scissors);
  clear_the_way(m_applier);
  const int cut = cut_element();
  const interactions::StrandBody& tube = m_model->strand_bodies[size_t(w.tube)];
  want(tube_point(std::max(0.0, tube.arc[size_t(cut)] - 0.003)));
  want(tube_point(tube.arc[size_t(cut) + 1] + 0.003));
  m_distance = 0.05 + 0.01 * double(int(m_in_phase / 4) % 4);
  const bool seen = stumps_in_view(*m_model, *m_state, w.trace_target, cut);
  m_steady = seen ? m_steady + sim::kTick : 0;
  if (m_steady < m_exercise.goal.check_time + 0.2) return;
  w.looked_at_stumps = true;
  go(Phase::decide);
}

void Surgeon::lower() {
  want(m_arms[side().grasper].tip);
  if (m_arms.move(side().grasper, m_lift_from, kCareful)) go(Phase::let_go);
}

void Surgeon::let_go() {
  want(m_arms[side().grasper].tip);
  if (m_arms.grip(side().grasper, 0, 0.4)) go(Phase::withdraw);
}

void Surgeon::withdraw() {
  const int hand = side().grasper;
  want(m_arms[hand].tip);
  if (m_arms.move_to_depth(hand, kInDepth, kCareful)) go(Phase::decide);
}

double Surgeon::from_strands(Vec3d at) const {
  double least = 1e9;
  for (const tissue::StrandState& strand : m_state->strands)
    for (const Vec3d& x : strand.x) least = std::min(least, length(x - at));
  return least;
}

void Surgeon::pinch_bowel() {
  // The grasper takes a fold of the bowel where it lies nearest, with all strength.
  const int hand = side().grasper;
  const interactions::ToolModel& t = tool(hand);
  const Vec3d port = m_arms[hand].port;
  constexpr double kClear = 0.02;  // [m]
  if (m_stage == 0) {
    // Where it is seen and no cord lies near, between two neighbouring points of its skin, the jaws' width along them.
    const sim::VisibilityTarget& seen =
        m_model->targets[size_t(m_model->target_index(m_exercise.goal.bowel.front().name))];
    double least = 1e9;
    int vertex = -1;
    for (int i = seen.first; i < seen.first + seen.count; ++i) {
      const Vec3d at = sample_point(m_model->samples[size_t(i)]);
      const double cost = length(at - port) - 4 * std::min(from_strands(at), kClear);
      if (!m_state->seen[size_t(i)] || cost >= least) continue;
      least = cost;
      vertex = m_model->samples[size_t(i)].where;
    }
    want(centre_of(int(&seen - m_model->targets.data())));
    if (vertex < 0 || m_in_phase < 2) return;
    const tissue::Skin& skin = m_model->skin(seen.index);
    const Vec3d at = vec_cast<double>(skin.rest[size_t(vertex)]);
    double nearest = 1e9;
    for (int k = skin.face_first[size_t(vertex)]; k < skin.face_first[size_t(vertex) + 1]; ++k)
      for (const int other : skin.triangles[size_t(skin.face[size_t(k)])]) {
        const Vec3d along = vec_cast<double>(skin.rest[size_t(other)]) - at;
        if (other == vertex || length(along) >= nearest) continue;
        nearest = length(along);
        m_bowel_along = along;
      }
    m_bowel_at = at + 0.5 * m_bowel_along;
    m_stage = 1;
  }
  const Vec3d axis = normalised(m_bowel_at - port);
  want(m_bowel_at);
  want(m_arms[hand].tip);
  const bool turned = m_arms.turn_across(hand, m_bowel_along);
  const double deep = 0.4 * t.jaw_length + 0.003 * m_attempts;  // deeper when it did not come at once
  if (m_stage == 1 && m_arms.move(hand, port + kInDepth * axis, kTravel)) m_stage = 2;
  if (m_stage == 2 && m_arms.move(hand, m_bowel_at - 0.015 * axis, kTravel) && turned) m_stage = 3;
  if (m_stage == 3 && m_arms.move(hand, m_bowel_at + deep * axis, kCareful)) m_stage = 4;
  if (m_stage == 4 && m_arms.grip(hand, 1, 1.0)) m_stage = tool_state(hand).holds > 0 ? 6 : 5;
  if (m_stage == 5 && m_arms.grip(hand, 0, 0.5)) {
    ++m_attempts;
    m_stage = 3;
  }
  if (m_stage == 6 && m_arms.grip(hand, 0, 1.0)) m_stage = 7;
  if (m_stage == 7 && m_arms.move(hand, m_bowel_at - 0.02 * axis, kCareful)) m_blundered = true;
}

void Surgeon::blunder() {
  const SideWork& w = side();
  if (flawed("E12")) {  // the applier closes on nothing
    want(m_arms[m_applier].tip);
    if (m_stage == 0 && m_arms.grip(m_applier, 1, 3)) m_stage = 1;
    if (m_stage == 1 && m_arms.grip(m_applier, 0, 0.5)) m_blundered = true;
  } else if (flawed("E4.1")) {  // the scissors wander off, the camera stays
    const Vec3d away{m_arms[w.scissors].port.x * 0.9, -0.150, -0.070};
    want(tube_point(w.ampulla_from));
    if (m_arms.move(w.scissors, away, 0.03)) m_blundered = true;
  } else if (flawed("E5")) {  // the scissors strike the grasper
    const interactions::ToolShape shape = interactions::shape_of(tool(w.grasper), tool_state(w.grasper).pose(), 0);
    const Vec3d there = shape.pivot - 0.02 * shape.frame.axis();
    want(there);
    want(m_arms[w.scissors].tip);
    m_steady += sim::kTick;
    if (!m_arms.grip(w.scissors, 1, 1) || m_steady < 1.5) return;  // closed, and the camera first
    const Vec3d way = there - m_arms[w.scissors].tip;
    m_arms.move(w.scissors, there + 0.02 * normalised(way), 0.06);
    m_blundered = length(way) < 0.002;
  } else if (flawed("E2")) {
    pinch_bowel();
  }
  if (m_blundered) go(Phase::decide);
}

}  // namespace trocar::training
