#include <algorithm>
#include <cstring>

#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/exercise/clip_places.hpp>
#include <trocar/training/exercise/hands.hpp>
#include <trocar/training/expert/surgeon.hpp>

namespace trocar::training {
namespace {

constexpr double kIdleDepth = 0.042;  // [m] an instrument that waits hangs under its trocar
constexpr double kTravel = 0.045;     // [m/s]

int landmark_of(const sim::StrandAnatomy& strand, const char* name) {
  for (size_t i = 0; i < strand.landmarks.size(); ++i)
    if (strand.landmarks[i].name == name) return int(i);
  return -1;
}

}  // namespace

const Surgeon::Row Surgeon::kRows[] = {
    {Phase::survey, "look around", &Surgeon::survey, 25, Phase::decide},
    {Phase::decide, "think", &Surgeon::decide, 1e9, Phase::finished},
    {Phase::put_down, "draw an instrument back", &Surgeon::put_down, 15, Phase::fetch},
    {Phase::fetch, "change an instrument", &Surgeon::fetch, 15, Phase::finished},
    {Phase::bring_in, "bring an instrument in", &Surgeon::bring_in, 15, Phase::decide},
    {Phase::identify, "follow the tube from its fimbriae", &Surgeon::identify, 30, Phase::decide},
    {Phase::reach_ampulla, "approach the ampulla", &Surgeon::reach_ampulla, 15, Phase::decide},
    {Phase::enter_ampulla, "take the ampulla between the jaws", &Surgeon::enter_ampulla, 8, Phase::let_go},
    {Phase::grasp, "grasp", &Surgeon::grasp, 4, Phase::let_go},
    {Phase::lift, "lift the tube", &Surgeon::lift, 15, Phase::reach_clip},
    {Phase::reach_clip, "bring the clip applier", &Surgeon::reach_clip, 15, Phase::leave_clip},
    {Phase::enter_clip, "take the isthmus between the legs", &Surgeon::enter_clip, 8, Phase::leave_clip},
    {Phase::inspect_clip, "look whether the legs enclose the tube", &Surgeon::inspect_clip, 8, Phase::leave_clip},
    {Phase::close_clip, "close the clip slowly", &Surgeon::close_clip, 8, Phase::open_clip},
    {Phase::open_clip, "open the applier", &Surgeon::open_clip, 4, Phase::leave_clip},
    {Phase::leave_clip, "draw the applier back", &Surgeon::leave_clip, 6, Phase::decide},
    {Phase::reach_cut, "bring the scissors", &Surgeon::reach_cut, 15, Phase::leave_cut},
    {Phase::enter_cut, "take the isthmus between the blades", &Surgeon::enter_cut, 8, Phase::leave_cut},
    {Phase::close_cut, "cut", &Surgeon::close_cut, 4, Phase::open_cut},
    {Phase::open_cut, "open the scissors", &Surgeon::open_cut, 4, Phase::leave_cut},
    {Phase::leave_cut, "draw the scissors back", &Surgeon::leave_cut, 6, Phase::decide},
    {Phase::check, "look at the stumps", &Surgeon::check, 20, Phase::decide},
    {Phase::lower, "lay the tube down", &Surgeon::lower, 8, Phase::let_go},
    {Phase::let_go, "let go", &Surgeon::let_go, 4, Phase::withdraw},
    {Phase::withdraw, "draw the grasper back", &Surgeon::withdraw, 6, Phase::decide},
    {Phase::blunder, "make a mistake", &Surgeon::blunder, 30, Phase::decide},
    {Phase::finished, "done", &Surgeon::finish, 1e9, Phase::finished},
};

const Surgeon::Row& Surgeon::row(Phase phase) { return kRows[size_t(phase)]; }

const char* Surgeon::doing() const { return row(m_phase).doing; }

Surgeon::Surgeon(const Exercise& exercise, const sim::Model& model, const Manner& manner)
    : m_exercise(exercise), m_manner(manner), m_arms(model, manner.tremor), m_camera(model) {
  const Sterilisation& g = exercise.goal;
  std::vector<core::Fault> faults;
  for (size_t h = 0; h < hands(model); ++h) {
    const std::string& name = model.hands[h].name;
    m_eyes[h] = {model.target_index(name + ".jaw_a"), model.target_index(name + ".jaw_b"),
                 model.target_index(name + ".shaft")};
    if (model.placed(h).name == g.applier) m_applier = int(h);
  }
  if (m_applier < 0) faults.push_back({g.applier_at, "expected a hand that begins with the clip applier, got none"});
  const auto hand = [&](const std::string& name, const core::Location& at, const std::string& instrument) {
    const int h = model.hand_index(name);
    if (h < 0)
      faults.push_back({at, "expected a trocar with a hand, got \"" + name + "\""});
    else if (model.hands[size_t(h)].find(instrument) < 0)
      faults.push_back(
          {at, "expected a trocar that the instrument \"" + instrument + "\" passes, got \"" + name + "\""});
    return h;
  };
  m_survey.push_back({model.target_index(g.uterus), g.organ_share, 0});
  for (const Side& s : g.sides) {
    SideWork w;
    w.tube = model.strand_index(s.tube);
    w.grasper = hand(s.grasper_hand, s.grasper_at, g.grasper);
    w.scissors = hand(s.scissors_hand, s.scissors_at, g.scissors);
    w.fimbria_target = model.target_index(s.tube + ".fimbria");
    w.trace_target = model.target_index(s.tube + ".trace");
    m_survey.push_back({w.trace_target, 0.5, 0});
    m_survey.push_back({model.target_index(s.ovary), g.organ_share, 0});
    if (w.tube < 0 || w.trace_target < 0) {
      faults.push_back({s.tube_at, "expected a tube with landmarks, got \"" + s.tube + "\""});
    } else {
      const sim::StrandAnatomy& strand = model.strands[size_t(w.tube)];
      const int isthmus = landmark_of(strand, "isthmus"), fimbria = landmark_of(strand, "fimbria");
      const double length = model.strand_bodies[size_t(w.tube)].length();
      w.ampulla_from = isthmus >= 0 ? strand.landmarks[size_t(isthmus)].to : 0.25 * length;
      w.ampulla_to = fimbria >= 0 ? strand.landmarks[size_t(fimbria)].from : 0.9 * length;
      w.following = Following(g, model, w.tube);
    }
    m_sides.push_back(std::move(w));
  }
  if (!faults.empty()) throw core::BadInput(faults);
}

Vec3d Surgeon::tube_point(double s) const {
  const interactions::StrandBody& tube = m_model->strand_bodies[size_t(m_strand)];
  return interactions::point_at(tube, m_state->strands[size_t(m_strand)], interactions::place_at(tube, s));
}

Vec3d Surgeon::tube_tangent(double s) const {
  const interactions::StrandBody& tube = m_model->strand_bodies[size_t(m_strand)];
  return interactions::tangent_at(tube, m_state->strands[size_t(m_strand)], interactions::place_at(tube, s));
}

double Surgeon::pull() const { return norm(tool_state(side().grasper).pull); }

bool Surgeon::holding() const {
  return held_arc(*m_model, *m_state, size_t(side().grasper), side().tube) > side().ampulla_from;
}

int Surgeon::cut_element() const {
  const std::vector<std::uint8_t>& alive = m_state->strands[size_t(side().tube)].alive;
  for (size_t e = 0; e < alive.size(); ++e)
    if (!alive[e]) return int(e);
  return -1;
}
bool Surgeon::severed() const { return cut_element() >= 0; }

bool Surgeon::sees_tip(int hand) const {
  const auto& eyes = m_eyes[size_t(hand)];
  return sim::visible(*m_model, *m_state, eyes[0]) || sim::visible(*m_model, *m_state, eyes[1]);
}
bool Surgeon::sees_jaws(int hand) const {
  const auto& eyes = m_eyes[size_t(hand)];
  return sim::visible(*m_model, *m_state, eyes[0]) && sim::visible(*m_model, *m_state, eyes[1]);
}

double Surgeon::slant(int hand, double s) const {
  return dot(normalised(tube_point(s) - m_arms[hand].port), tube_tangent(s));
}

double Surgeon::wanted_slant() const { return flawed("A1.4") ? 0.38 : flawed("A1.5") ? 0.58 : 0; }

double Surgeon::next_clip_at() const {
  const Sterilisation& g = m_exercise.goal;
  // A little nearer or farther after each failure: elsewhere the lower leg may be seen behind the tube.
  constexpr double kElsewhere[] = {0, 0.7, -0.7};  // of what the ranges leave
  const double shift = 0.5 * kElsewhere[m_failed_clips % 3];
  const double apart =
      0.5 * (g.clip_distance.low + g.clip_distance.high) + shift * (g.clip_distance.high - g.clip_distance.low);
  double only = -1;
  for (int i = 0; i < m_state->clip_count; ++i) {
    const interactions::Clip& c = m_state->clips[size_t(i)];
    if (c.strand != side().tube || !well_set(g, c) || !place_of_a_clip(g, c.s)) continue;
    if (only >= 0 && g.clip_distance.holds(std::fabs(c.s - only))) return -1;
    if (only < 0) only = c.s;
  }
  if (only < 0) return 0.5 * (g.first_clip.low + g.first_clip.high) + shift * (g.first_clip.high - g.first_clip.low);
  if (g.first_clip.holds(only)) return std::clamp(only + apart, g.second_clip.low, g.second_clip.high);
  return std::clamp(only - apart, g.first_clip.low, g.first_clip.high);
}

double Surgeon::cut_at() const {
  // Half way between the two clips nearest to each other at a fit distance.
  const Sterilisation& g = m_exercise.goal;
  for (int i = 0; i < m_state->clip_count; ++i)
    for (int j = i + 1; j < m_state->clip_count; ++j) {
      const interactions::Clip &a = m_state->clips[size_t(i)], &b = m_state->clips[size_t(j)];
      if (a.strand == side().tube && b.strand == side().tube && g.clip_distance.holds(std::fabs(a.s - b.s)))
        return 0.5 * (a.s + b.s);
    }
  return 0.5 * (g.first_clip.high + g.second_clip.low);
}

Vec3d Surgeon::sample_point(const sim::VisibilitySample& sample) const {
  const sim::VisibilityTarget& t = m_model->targets[size_t(sample.target)];
  const size_t i = size_t(t.index);
  if (t.kind == sim::VisibilityTarget::strand)
    return interactions::point_at(m_model->strand_bodies[i], m_state->strands[i], {sample.where, sample.w});
  return vec_cast<double>(m_model->skin(t.index).rest[size_t(sample.where)]);
}

Vec3d Surgeon::centre_of(int target) const {
  const sim::VisibilityTarget& t = m_model->targets[size_t(target)];
  Vec3d sum;
  for (int i = t.first; i < t.first + t.count; ++i) sum += sample_point(m_model->samples[size_t(i)]);
  return sum / std::max(1, t.count);
}

void Surgeon::want_all_of(int target) {
  const sim::VisibilityTarget& t = m_model->targets[size_t(target)];
  constexpr int kPoints = 5;
  for (int k = 0; k < kPoints; ++k)
    want(sample_point(m_model->samples[size_t(t.first + k * (t.count - 1) / (kPoints - 1))]));
}

Vec3d Surgeon::work_place() const { return tube_point(0.5 * (m_clip_place + cut_at())); }

void Surgeon::go(Phase next) {
  m_phase = next;
  m_in_phase = m_steady = 0;
}

bool Surgeon::aim(int hand, double s, double inside, double back, double speed) {
  const interactions::ToolModel& t = tool(hand);
  const Vec3d at = tube_point(s), axis = normalised(at - m_arms[hand].port);
  const bool there = m_arms.move(hand, at + (t.jaw_length - inside - back) * axis, speed);
  return m_arms.turn_across(hand, tube_tangent(s)) && there;
}

bool Surgeon::approach(int hand, double s, double inside, double speed) {
  constexpr double kBack = 0.022;  // [m] in front of the tissue
  constexpr double kUnseen = 3;    // [s] to wait for the camera
  want(m_arms[hand].tip);
  const bool deep = tool_state(hand).depth > kIdleDepth;
  if (deep && !sees_tip(hand) && m_in_phase < kUnseen) return false;
  if (!deep && !m_camera.settled() && m_in_phase < kUnseen) return false;
  return aim(hand, s, inside, kBack, speed);
}

void Surgeon::clear_the_way(int hand) {
  if (tool_state(hand).depth > kIdleDepth) m_arms.move_to_depth(hand, kIdleDepth, kTravel);
}

void Surgeon::keep_presented() {
  // Two things to hold at once: the isthmus across the applier's shaft (raising turns it), and a gentle pull on it
  // (drawing it outwards stretches it).
  if (!holding()) return;
  if (wanted_slant() > 0) return hold_askew();
  const Range& range = m_exercise.goal.present_pull;
  constexpr double kHighest = 0.040, kFarthest = 0.020, kPace = 0.010;  // [m] [m] [m/s]
  constexpr double kLevel = 0.03;                                       // [rad] of slope that is let be
  const double now = pull(), slope = slant(m_applier, m_phase >= Phase::reach_cut ? m_cut_place : m_clip_place);
  double rise = std::fabs(slope) < kLevel ? 0 : std::clamp(6 * slope, -1.0, 1.0);  // the outer end dips: up
  double out = 0;
  if (now < range.low + 0.15) (slope < -kLevel ? out : rise) = 0.6;
  if (now > 0.7 * range.high) {
    rise = std::min(rise, 0.0);
    out = -0.6;
  }
  if (now > 0.9 * range.high) rise = -1;
  m_lifted = std::clamp(m_lifted + rise * kPace * sim::kTick, 0.0, kHighest);
  m_drawn = std::clamp(m_drawn + out * kPace * sim::kTick, std::min(0.0, m_drawn), kFarthest);
  m_arms[side().grasper].tip = m_lift_from + m_lifted * m_lift_up + m_drawn * m_outwards;
}

void Surgeon::hold_askew() {
  // Pushed down instead of raised: the isthmus dips outwards, along the applier's shaft instead of across it.
  constexpr double kLowest = 0.045, kOut = 0.006, kPace = 0.010;  // [m] [m] [m/s]
  const double missing = wanted_slant() - slant(m_applier, m_clip_place);
  m_drawn = std::min(kOut, m_drawn + kPace * sim::kTick);
  m_lifted = std::clamp(m_lifted - std::clamp(10 * missing, -1.0, 1.0) * kPace * sim::kTick, -kLowest, 0.0);
  m_arms[side().grasper].tip = m_lift_from + Vec3d{0, 0, m_lifted} + m_drawn * m_outwards;
}

void Surgeon::show() {
  if (flawed("A1.11") && m_phase != Phase::survey) {  // has eyes for the isthmus only
    m_point_count = 0;
    want(tube_point(m_exercise.goal.first_clip.low));
    m_distance = 0.035;
  }
  if (m_point_count == 0) return;
  m_camera.show({m_points.data(), size_t(m_point_count)}, m_distance);
}

sim::Input Surgeon::next(const sim::Model& model, const sim::State& state) {
  m_model = &model;
  m_state = &state;
  m_in_phase += sim::kTick;
  m_on_side += sim::kTick;
  m_point_count = 0;
  m_strand = m_target_strand >= 0 ? m_target_strand : side().tube;
  m_distance = 0.06;
  m_arms.begin_tick();
  constexpr double kPatience = 240;  // [s] on one side
  if (!done() && m_on_side > kPatience) {
    m_gave_up = true;
    go(Phase::finished);
  }
  if (m_in_phase > row(m_phase).patience) go(row(m_phase).otherwise);
  (this->*row(m_phase).run)();
  show();
  sim::Input input = model.start;
  m_arms.fill(state.tick, input);
  m_camera.fill(input);
  m_model = nullptr;
  m_state = nullptr;
  return input;
}

}  // namespace trocar::training
