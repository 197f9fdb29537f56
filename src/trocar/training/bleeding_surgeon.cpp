#include <algorithm>
#include <cmath>

#include <trocar/sim/visibility.hpp>
#include <trocar/training/bleeding_surgeon.hpp>
#include <trocar/training/hands.hpp>

namespace trocar::training {
namespace {

constexpr double kTravel = 0.045, kCareful = 0.018, kTrack = 0.004;  // [m/s] through the open, at tissue, following it
constexpr double kBeside = 0.008;                                    // [m] of a clip from the place
constexpr double kBack = 0.022;                                      // [m] in front of the tissue
constexpr double kAway = 0.060;                                      // [m] depth of an applier that is drawn back
constexpr double kHalf = 0.42;                                       // handle of a half closed applier
constexpr int kMostTries = 6;

constexpr const char* kDoing[] = {"wait",
                                  "look where it bleeds",
                                  "bring the clip applier",
                                  "take the artery between the legs",
                                  "look whether the legs enclose it",
                                  "close the clip slowly",
                                  "open the applier",
                                  "draw the applier back",
                                  "look whether it stays dry",
                                  "done"};

}  // namespace

BleedingSurgeon::BleedingSurgeon(const Exercise& exercise, const sim::Model& model, const Manner& manner)
    : m_goal(exercise.bleeding), m_manner(manner), m_arms(model, manner.tremor), m_camera(model) {
  std::vector<core::Fault> faults;
  for (size_t h = 0; h < hands(model); ++h)
    if (model.placed(h).name == m_goal.applier) m_applier = int(h);
  if (m_applier < 0)
    faults.push_back({m_goal.applier_at, "expected a hand that begins with the clip applier, got none"});
  const int target = model.target_index("bleeder");
  if (target < 0 || model.targets[size_t(target)].kind != sim::VisibilityTarget::strand)
    faults.push_back(
        {{exercise.file.string(), 0, 0}, "expected a scene in which an artery on a strand opens by itself"});
  if (!faults.empty()) throw core::BadInput(faults);
  const std::string& name = model.hands[size_t(m_applier)].name;
  m_jaws[0] = model.target_index(name + ".jaw_a");
  m_jaws[1] = model.target_index(name + ".jaw_b");
  const sim::VisibilityTarget& t = model.targets[size_t(target)];
  const sim::VisibilitySample& sample = model.samples[size_t(t.first)];
  m_strand = t.index;
  const interactions::StrandBody& body = model.bodies[size_t(m_strand)];
  m_hole = arc_at(body, {sample.where, sample.w});
  // Arteries are written from the heart on: where the line comes from, on the same strand, is its side.
  const sim::Bleeder& b = model.vessels.bleeder;
  for (const interactions::VesselPoint& p : model.vessels.list[size_t(b.vessel)].path.points) {
    if (p.hold.kind != interactions::VesselHold::strand || p.hold.index != m_strand || p.s >= b.s) continue;
    m_heart = arc_at(body, {p.hold.element, p.hold.w}) < m_hole ? -1 : 1;
  }
}

const char* BleedingSurgeon::doing() const { return kDoing[size_t(m_phase)]; }

void BleedingSurgeon::go(Phase next) {
  m_phase = next;
  m_in_phase = m_steady = 0;
}

Vec3d BleedingSurgeon::point(double s) const {
  const interactions::StrandBody& body = m_model->bodies[size_t(m_strand)];
  return interactions::point_at(body, m_state->strands[size_t(m_strand)], interactions::place_at(body, s));
}
Vec3d BleedingSurgeon::tangent(double s) const {
  const interactions::StrandBody& body = m_model->bodies[size_t(m_strand)];
  return interactions::tangent_at(body, m_state->strands[size_t(m_strand)], interactions::place_at(body, s));
}
Vec3d BleedingSurgeon::place() const { return point(m_hole); }

double BleedingSurgeon::clip_at() const {
  const double length = m_model->bodies[size_t(m_strand)].length();
  const double farther = kBeside + 0.0015 * double(m_tries % 3);
  return std::clamp(m_hole + (m_upstream ? m_heart : -m_heart) * farther, 0.004, length - 0.004);
}

bool BleedingSurgeon::has_clip(bool upstream) const {
  const sim::Bleeder& b = m_model->vessels.bleeder;
  for (int i = 0; i < m_state->vessel_clip_count; ++i) {
    const interactions::VesselClip& c = m_state->vessel_clips[size_t(i)];
    if (c.vessel == b.vessel && (c.s < b.s) == upstream && c.cover >= m_goal.clip_cover) return true;
  }
  return false;
}

bool BleedingSurgeon::choose_side() {
  if (flawed("A3.1")) {
    m_upstream = false;
    return !has_clip(false);
  }
  m_upstream = !has_clip(true);
  return m_upstream || !has_clip(false);
}

double BleedingSurgeon::inside() const {
  const interactions::ToolModel& t = m_model->tool(*m_state, size_t(m_applier));
  const interactions::StrandBody& body = m_model->bodies[size_t(m_strand)];
  const double radius = body.model.radius[size_t(interactions::place_at(body, clip_at()).element)];
  return t.jaw_length - t.clip_length + radius + 0.001;
}

bool BleedingSurgeon::aim(double back, double speed) {
  const interactions::ToolModel& t = m_model->tool(*m_state, size_t(m_applier));
  const Vec3d at = point(clip_at()), axis = normalised(at - m_arms[m_applier].port);
  const bool there = m_arms.move(m_applier, at + (t.jaw_length - inside() - back) * axis, speed);
  return m_arms.turn_across(m_applier, tangent(clip_at())) && there;
}

void BleedingSurgeon::watch() {
  // Between the two ovaries' ligaments, until blood shows somewhere.
  if (m_state->opening_count > 0 && m_in_phase > 1) go(Phase::find);
}

void BleedingSurgeon::find() {
  want(place());
  m_steady += m_camera.settled() ? sim::kTick : 0;
  if (m_steady < m_goal.find_time + 0.3) return;
  go(choose_side() ? Phase::reach : Phase::check);
}

void BleedingSurgeon::reach() {
  want(place());
  want(point(clip_at()));
  if (m_in_phase > 0.5) want(m_arms[m_applier].tip);
  m_clips_before = m_state->clip_count;
  if (m_arms.grip(m_applier, 0, 0.5) && aim(kBack, kTravel)) go(Phase::enter);
  if (m_in_phase > 15) go(Phase::leave);
}

void BleedingSurgeon::enter() {
  want(place());
  want(m_arms[m_applier].tip);
  if (aim(0, kCareful)) go(Phase::inspect);
  if (m_in_phase > 8) go(Phase::leave);
}

void BleedingSurgeon::inspect() {
  want(point(clip_at()));
  want(m_arms[m_applier].tip);
  m_distance = 0.052 + 0.008 * double(int(m_in_phase / 1.5) % 4);
  aim(0, kTrack);
  if (!m_arms.grip(m_applier, kHalf, 1.6)) return;
  const bool seen = sim::visible(*m_model, *m_state, m_jaws[0]) && sim::visible(*m_model, *m_state, m_jaws[1]);
  m_steady = seen ? m_steady + sim::kTick : 0;
  if (m_steady > 0.15) go(Phase::close);
  if (m_in_phase > 8) go(Phase::leave);
}

void BleedingSurgeon::close() {
  want(point(clip_at()));
  want(m_arms[m_applier].tip);
  aim(0, kTrack);
  if (m_arms.grip(m_applier, 1, 2.6 * m_goal.clip_closing) && m_state->clip_count > m_clips_before) go(Phase::open);
  if (m_in_phase > 8) go(Phase::open);
}

void BleedingSurgeon::open() {
  want(place());
  if (m_arms.grip(m_applier, 0, 0.5)) go(Phase::leave);
}

void BleedingSurgeon::leave() {
  want(place());
  want(m_arms[m_applier].tip);
  m_arms.grip(m_applier, 0, 0.5);
  const Vec3d out = normalised(m_arms[m_applier].port - m_arms[m_applier].tip);
  m_arms.move(m_applier, m_arms[m_applier].tip + 0.01 * out, kCareful);
  if (m_in_phase < 1.5) return;
  m_tries = m_state->clip_count > m_clips_before ? 0 : m_tries + 1;
  m_gave_up = m_tries >= kMostTries;
  if (m_gave_up) return go(Phase::finished);
  go(choose_side() ? Phase::reach : Phase::check);
}

void BleedingSurgeon::check() {
  want(place());
  m_distance = 0.05 + 0.01 * double(int(m_in_phase / 4) % 4);
  m_arms.move_to_depth(m_applier, kAway, kTravel);
  if (m_in_phase > m_goal.stopped_time + m_goal.check_time + 6) go(Phase::finished);
}

sim::Input BleedingSurgeon::next(const sim::Model& model, const sim::State& state) {
  m_model = &model;
  m_state = &state;
  m_in_phase += sim::kTick;
  m_point_count = 0;
  m_distance = 0.06;
  m_arms.begin_tick();
  static constexpr void (BleedingSurgeon::*kRun[])() = {
      &BleedingSurgeon::watch, &BleedingSurgeon::find,    &BleedingSurgeon::reach,
      &BleedingSurgeon::enter, &BleedingSurgeon::inspect, &BleedingSurgeon::close,
      &BleedingSurgeon::open,  &BleedingSurgeon::leave,   &BleedingSurgeon::check};
  if (!done()) (this->*kRun[size_t(m_phase)])();
  if (m_point_count > 0) m_camera.show({m_points.data(), size_t(m_point_count)}, m_distance);
  sim::Input input = model.start;
  m_arms.fill(state.tick, input);
  m_camera.fill(input);
  m_model = nullptr;
  m_state = nullptr;
  return input;
}

}  // namespace trocar::training
