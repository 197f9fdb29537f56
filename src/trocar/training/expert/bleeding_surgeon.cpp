#include <algorithm>
#include <cmath>

#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/exercise/hands.hpp>
#include <trocar/training/expert/bleeding_surgeon.hpp>

namespace trocar::training {
namespace {

constexpr double kTravel = 0.045, kCareful = 0.018, kTrack = 0.004;  // [m/s] through the open, at tissue, following it
constexpr double kBeside = 0.006;                                    // [m] of a clip from the place
constexpr double kBack = 0.022;                                      // [m] in front of the tissue
constexpr double kAway = 0.060;                                      // [m] depth of an applier that is drawn back
constexpr double kHalf = 0.42;                                       // handle of a half closed applier
constexpr double kIdleDepth = 0.042, kInDepth = 0.085;               // [m] an instrument that waits, one brought in
constexpr double kEmpty = 0.5e-6;                                    // [m^3] left in the pool
constexpr int kMostTries = 6;

constexpr const char* kDoing[] = {"wait",
                                  "make a mistake",
                                  "look where it bleeds",
                                  "bring the clip applier",
                                  "take the artery between the legs",
                                  "look whether the legs enclose it",
                                  "close the clip slowly",
                                  "open the applier",
                                  "draw the applier back",
                                  "draw an instrument back",
                                  "take the suction-irrigator",
                                  "bring it in",
                                  "suck the pool empty",
                                  "look whether it stays dry",
                                  "done"};

}  // namespace

BleedingSurgeon::BleedingSurgeon(const Exercise& exercise, const sim::Model& model, const Manner& manner)
    : m_goal(exercise.bleeding), m_manner(manner), m_arms(model, manner.tremor), m_camera(model) {
  std::vector<core::Fault> faults;
  for (size_t h = 0; h < hands(model); ++h)
    if (model.placed(h).name == m_goal.applier) m_applier = int(h);
  for (size_t h = 0; h < hands(model); ++h)
    for (size_t i = 0; i < model.hands[h].rack.size() && int(h) != m_applier && m_sucker < 0; ++i)
      if (model.hands[h].rack[i].kind == interactions::ToolKind::suction_irrigator) m_sucker = int(h), m_bore = int(i);
  for (size_t i = 0; m_sucker >= 0 && i < model.hands[size_t(m_sucker)].rack.size(); ++i)
    if (model.hands[size_t(m_sucker)].rack[i].kind == interactions::ToolKind::hook) m_hook = int(i);
  if (m_applier < 0)
    faults.push_back({m_goal.applier_at, "expected a hand that begins with the clip applier, got none"});
  if (model.vessels.bleeder.vessel < 0)
    faults.push_back({{exercise.file.string(), 0, 0}, "expected a scene in which an artery opens by itself, got none"});
  if (!faults.empty()) throw core::BadInput(faults);
  const std::string& name = model.hands[size_t(m_applier)].name;
  m_jaws[0] = model.target_index(name + ".jaw_a");
  m_jaws[1] = model.target_index(name + ".jaw_b");
  m_hosts = sim::make_host_views(model);
  m_artery.resize(model.vessels.list[size_t(model.vessels.bleeder.vessel)].path.points.size());
}

const char* BleedingSurgeon::doing() const { return kDoing[size_t(m_phase)]; }

void BleedingSurgeon::go(Phase next) {
  m_phase = next;
  m_in_phase = m_steady = 0;
}

const interactions::VesselPath& BleedingSurgeon::path() const {
  return m_model->vessels.list[size_t(m_model->vessels.bleeder.vessel)].path;
}
interactions::VesselSpot BleedingSurgeon::spot(double s) const { return vessel_spot(path(), m_artery, {}, s); }
Vec3d BleedingSurgeon::place() const { return point(m_model->vessels.bleeder.s); }

double BleedingSurgeon::clip_at() const {
  // Arteries are written from the heart on. A little nearer or farther off after each failure.
  constexpr double kElsewhere[] = {0, -0.001, 0.001};  // [m]
  const double off = (kBeside + kElsewhere[m_tries % 3]) / path().length;
  return std::clamp(m_model->vessels.bleeder.s + (m_upstream ? -off : off), 0.0, 1.0);
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
  constexpr double kSpare = 0.0008;   // [m] between the carrier and the clip's bend
  constexpr double kMissed = 0.014;   // [m] as a flaw
  constexpr double kCaught = 0.0002;  // [m] the same: of the artery's middle from the legs' ends
  const interactions::ToolModel& t = m_model->tool(*m_state, size_t(m_applier));
  if (errs("A3.3")) return t.jaw_length - kCaught;
  return t.jaw_length - t.clip_length + m_carrier.radius + kSpare + (errs("E12") ? kMissed : 0);
}

BleedingSurgeon::Carrier BleedingSurgeon::on_strand(int strand, interactions::StrandPlace place) const {
  const interactions::StrandBody& body = m_model->strand_bodies[size_t(strand)];
  const tissue::StrandState& state = m_state->strands[size_t(strand)];
  return {interactions::point_at(body, state, place), interactions::tangent_at(body, state, place),
          body.model.radius[size_t(place.element)]};
}

BleedingSurgeon::Carrier BleedingSurgeon::elsewhere() const {
  const int tube = m_model->strand_index(m_goal.delicate[place().x > 0 ? 0 : 1].name);
  const interactions::StrandBody& body = m_model->strand_bodies[size_t(tube)];
  return on_strand(tube, interactions::place_at(body, 0.35 * body.length()));
}

BleedingSurgeon::Carrier BleedingSurgeon::clipped() const {
  if (errs("A3.2")) return elsewhere();
  const interactions::VesselSpot at = spot(clip_at());
  const interactions::VesselHold& hold = path().points[size_t(at.after)].hold;
  if (hold.kind != interactions::VesselHold::strand)
    return {at.place, at.along, path().points[size_t(at.after)].radius};
  // The point before the place: what is left lies along the strand.
  const interactions::StrandBody& body = m_model->strand_bodies[size_t(hold.index)];
  Carrier c = on_strand(hold.index, {hold.element, hold.w});
  const double ahead = dot(at.place - c.place, c.along);
  return on_strand(hold.index,
                   interactions::place_at(body, interactions::arc_at(body, {hold.element, hold.w}) + ahead));
}

bool BleedingSurgeon::aim(double back, double speed) {
  const interactions::ToolModel& t = m_model->tool(*m_state, size_t(m_applier));
  const Vec3d to = m_carrier.place + m_aside;
  const Vec3d axis = normalised(to - m_arms[m_applier].port);
  const bool there = m_arms.move(m_applier, to + (t.jaw_length - inside() - back) * axis, speed);
  return m_arms.turn_across(m_applier, m_carrier.along) && there;
}

bool BleedingSurgeon::between_legs() const {
  constexpr double kShort = 0.002;  // [m]
  const interactions::ToolState& tool = m_state->tools[size_t(m_applier)];
  const interactions::ToolShape shape =
      interactions::shape_of(m_model->tool(*m_state, size_t(m_applier)), tool.pose(), tool.aperture);
  const Vec3d local = interactions::to_jaw(shape, clipped().place);
  return std::fabs(local.x) < shape.half_gap && local.z < inside() + kShort;
}

void BleedingSurgeon::learn_from_a_miss() {
  // What lies on a leg's end has slid to that side: next time a little farther there.
  const interactions::ToolState& tool = m_state->tools[size_t(m_applier)];
  const interactions::ToolShape shape =
      interactions::shape_of(m_model->tool(*m_state, size_t(m_applier)), tool.pose(), tool.aperture);
  const double aside = interactions::to_jaw(shape, clipped().place).x;
  constexpr double kMost = 0.0008, kFarthest = 0.003;  // [m]
  m_aside += std::clamp(0.5 * aside, -kMost, kMost) * interactions::direction_from_jaw(shape, {1, 0, 0});
  if (length(m_aside) > kFarthest) m_aside = {0, 0, 0};
}

bool BleedingSurgeon::sees_jaw() const {
  return sim::visible(*m_model, *m_state, m_jaws[0]) || sim::visible(*m_model, *m_state, m_jaws[1]);
}

void BleedingSurgeon::look_at_clip() {
  // If the legs' tips stay hidden: from the midline, then from the side; one is seen past the artery's carrier.
  constexpr double kPatience = 1, kAside = 0.03;  // [s] [m]
  const Vec3d at = clipped().place;
  if (errs("E4.2")) return want(at - Vec3d{2 * at.x, 0, 0});  // the other side of the patient
  constexpr double kAsides[] = {0, kAside, -kAside, 1.6 * kAside, -1.6 * kAside};
  const double x = kAsides[int(m_unseen / kPatience) % 5];
  want(at - Vec3d{at.x > 0 ? x : -x, 0, 0});
}

void BleedingSurgeon::draw_back_others() {
  for (int h = 0; h < m_arms.count(); ++h)
    if (h != m_applier && m_state->tools[size_t(h)].depth > kIdleDepth) m_arms.move_to_depth(h, kIdleDepth, kTravel);
}

void BleedingSurgeon::watch() {
  // What is in the way is drawn back, until blood shows somewhere.
  draw_back_others();
  if (burns() && !m_blundered && m_in_phase > 1) return go(Phase::blunder);
  if (m_state->opening_count > 0 && m_in_phase > 1 && !waits()) go(Phase::find);
}

double BleedingSurgeon::lost() const {
  return fluids::kM3PerPicolitre * double(m_state->fluids.ledger.in[size_t(fluids::Source::kBled)].blood);
}

bool BleedingSurgeon::waits() const {
  constexpr double kMore = 1.05;
  const double wanted = flawed("E9.1") || flawed("E10") ? std::max(m_goal.lost_some, m_goal.pool_left)
                        : flawed("E9.2")                ? m_goal.lost_much
                        : flawed("E9")                  ? m_goal.lost_too_much
                                                        : 0;
  return lost() < kMore * (flawed("E10") ? 1.5 : 1) * wanted ||
         (flawed("E9.3") && m_in_phase < m_goal.control_within + 8);
}

namespace {
constexpr int kBurning = 3, kDone = 7;  // stages of a blunder: the pedal is down; the hand draws back
}

Vec3d BleedingSurgeon::burnt() const {
  const Vec3d port = m_arms[m_sucker].port;
  if (flawed("E7")) return elsewhere().place;
  if (flawed("E8") || (flawed("E7.2") && m_stage <= kBurning)) return point(clip_at());
  if (flawed("E7.2")) return elsewhere().place;
  if (flawed("E6")) return port + 0.07 * normalised(place() - port);
  const int bowel = m_model->organ_index(m_goal.bowel[0].name);
  const tissue::Skin& skin = m_model->skin(bowel);
  const tissue::NodeView nodes = nodes_of(*m_model, *m_state, bowel);
  Vec3d nearest = tissue::skin_point(nodes, skin, 0);
  for (int v = 0; v < skin.size(); ++v)
    if (const Vec3d p = tissue::skin_point(nodes, skin, v); length(p - port) < length(nearest - port)) nearest = p;
  return nearest + 0.002 * normalised(nearest - port);
}

void BleedingSurgeon::blunder() {
  Arms::Arm& arm = m_arms[m_sucker];
  const Vec3d goal = burnt();
  const double pressed = flawed("E8") ? 8 : flawed("E7.2") ? 2 : 1;  // [s]
  constexpr double kFar = 8;                                         // [s] farther away is nothing here
  const auto touches_something = [this](int h) { return norm(m_state->tools[size_t(h)].contact_force) > 0.05; };
  want(arm.tip);
  want(goal);
  switch (m_stage) {
    case 0:
      if (m_arms.move_to_depth(m_sucker, kIdleDepth, 2 * kTravel)) ++m_stage;
      break;
    case 1:
      arm.instrument = m_hook;
      arm.tip = arm.port + kIdleDepth * normalised(goal - arm.port);
      if (m_state->tools[size_t(m_sucker)].instrument == m_hook && m_camera.settled()) ++m_stage;
      break;
    case 2:  // tissue that is pushed gives way
      m_steady += sim::kTick;
      if (m_arms.move(m_sucker, goal, kCareful) || touches_something(m_sucker) || m_steady > kFar)
        ++m_stage, m_steady = 0;
      break;
    case kBurning:
      m_steady += sim::kTick;
      arm.coagulating = m_steady < pressed;
      if (!arm.coagulating) m_stage = flawed("E7.2") ? kBurning + 1 : kDone;
      break;
    case kBurning + 1:
      if (m_arms.move_to_depth(m_sucker, kIdleDepth, kTravel)) ++m_stage, m_steady = 0;
      break;
    case kBurning + 2:
      m_steady += sim::kTick;
      if (m_arms.move(m_sucker, goal, kCareful) || touches_something(m_sucker) || m_steady > kFar)
        ++m_stage, m_steady = 0;
      break;
    case kBurning + 3:
      m_steady += sim::kTick;
      if (m_steady > 0.5) m_stage = kDone;
      break;
    default:
      m_blundered = m_arms.move_to_depth(m_sucker, kIdleDepth, kCareful);
      if (m_blundered) go(Phase::watch);
  }
}

void BleedingSurgeon::find() {
  want(place());
  m_steady += m_camera.settled() ? sim::kTick : 0;
  if (m_steady < m_goal.find_time + 0.3) return;
  go(choose_side() ? Phase::reach : Phase::change);
}

void BleedingSurgeon::reach() {
  m_carrier = clipped();
  want(place());
  want(point(clip_at()));
  if (m_in_phase > 0.5) want(m_arms[m_applier].tip);
  m_clips_before = m_state->clip_count;
  m_unseen = 0;
  if (m_arms.grip(m_applier, 0, 0.5) && aim(kBack, kTravel)) go(Phase::enter);
  if (m_in_phase > 15) go(Phase::leave);
}

void BleedingSurgeon::enter() {
  want(place());
  want(m_arms[m_applier].tip);
  if ((errs("E12") || errs("A3.2") || errs("A3.3")) && m_in_phase > 2) return go(Phase::inspect);
  if (!aim(0, kCareful) && m_in_phase < 8) return;
  m_steady += sim::kTick;
  if (between_legs()) return go(Phase::inspect);
  if (m_steady < 0.3) return;  // it still slides in
  learn_from_a_miss();
  go(Phase::leave);
}

void BleedingSurgeon::inspect() {
  look_at_clip();
  if (!errs("E4.2")) want(m_arms[m_applier].tip);
  m_distance = m_seen_from = 0.052 + 0.008 * double(int(m_in_phase / 1.5) % 4);
  aim(0, kTrack);
  if (!m_arms.grip(m_applier, kHalf, 1.6)) return;
  const bool careless = errs("E4.2") || errs("E12") || errs("A3.2") || errs("A3.3");
  if (careless && m_in_phase > 4) return go(Phase::close);
  m_unseen += sees_jaw() ? 0 : sim::kTick;
  m_steady = sees_jaw() && !careless ? m_steady + sim::kTick : 0;
  if (m_steady > 0.3) go(Phase::close);
  if (m_in_phase > 8) go(Phase::leave);
}

void BleedingSurgeon::close() {
  look_at_clip();
  m_distance = m_seen_from + (m_unseen > 0.5 ? 0.008 * double(int(m_unseen / 1.5) % 4) : 0);
  if (!errs("E4.2")) want(m_arms[m_applier].tip);
  aim(0, kTrack);
  const double quick = errs("A3.4") ? 0.4 : 1;
  const bool careless = !m_blundered && !m_manner.flaw.empty();
  if (!sees_jaw() && !careless && m_state->clip_count == m_clips_before && m_in_phase < 7) {  // wait for the camera
    m_unseen += sim::kTick;
    return;
  }
  if (m_arms.grip(m_applier, 1, 2.6 * quick * m_goal.clip_closing) && m_state->clip_count > m_clips_before)
    go(Phase::open);
  if (m_in_phase > 11) go(Phase::open);
}

void BleedingSurgeon::open() {
  want(place());
  m_blundered = true;
  if (m_arms.grip(m_applier, 0, 0.5)) go(Phase::leave);
}

void BleedingSurgeon::leave() {
  want(place());
  want(m_arms[m_applier].tip);
  m_arms.grip(m_applier, 0, 0.5);
  const Vec3d out = normalised(m_arms[m_applier].port - m_arms[m_applier].tip);
  m_arms.move(m_applier, m_arms[m_applier].tip + 0.01 * out, kCareful);
  if (m_in_phase < 1.5) return;
  m_tries = has_clip(m_upstream) ? 0 : m_tries + 1;
  if (m_tries == 0) m_aside = {0, 0, 0};
  m_gave_up = m_tries >= kMostTries;
  if (m_gave_up) return go(Phase::finished);
  go(choose_side() ? Phase::reach : Phase::change);
}

/// Can the suction-irrigator go straight to a point of the pool, or is what the pool lies on in its way?
bool BleedingSurgeon::free_way(Vec3d to) const {
  constexpr double kClear = 0.006, kLast = 0.012, kStep = 0.004;  // [m] above the floor; of the way; between looks
  const fluids::PoolModel& pool = m_model->wet.model.pool;
  const Vec3d from = m_arms[m_sucker].port, way = to - from;
  for (double s = kLast; s < length(way); s += kStep) {
    const fluids::PoolPoint p = locate(pool, to - s * normalised(way));
    if (p.inside && p.height < floor_at(pool, m_state->pool_floor, p.i, p.j) + kClear) return false;
  }
  return true;
}

std::optional<Vec3d> BleedingSurgeon::deepest() const {
  const fluids::PoolModel& pool = m_model->wet.model.pool;
  constexpr float kShallow = 0.0002f;  // [m]
  float most = kShallow;
  std::optional<Vec3d> found;
  for (int j = 0; j < pool.ny; ++j)
    for (int i = 0; i < pool.nx; ++i) {
      const float d = depth_at(pool, m_state->fluids.pool, i, j);
      if (d <= most) continue;
      const double height = double(floor_at(pool, m_state->pool_floor, i, j)) + 0.5 * double(d);
      const Vec3d at = world(pool, (i + 0.5) * pool.cell, (j + 0.5) * pool.cell, height);
      if (free_way(at)) most = d, found = at;
    }
  return found;
}

void BleedingSurgeon::change() {
  want(place());
  m_arms.move_to_depth(m_applier, kAway, kTravel);
  if (m_sucker < 0 || flawed("E10")) return go(Phase::check);
  if (m_arms.move_to_depth(m_sucker, kIdleDepth, 2 * kTravel) && m_in_phase > 0.5) go(Phase::fetch);
}

void BleedingSurgeon::fetch() {
  Arms::Arm& arm = m_arms[m_sucker];
  arm.instrument = m_bore;
  const Vec3d inwards = normalised(deepest().value_or(place()) - arm.port);
  arm.tip = arm.port + kIdleDepth * inwards;
  want(arm.port + 0.055 * inwards);
  want(arm.port + kInDepth * inwards);
  if (m_state->tools[size_t(m_sucker)].instrument == m_bore && m_camera.settled() && m_in_phase > 0.6) go(Phase::bring);
}

void BleedingSurgeon::bring() {
  const Arms::Arm& arm = m_arms[m_sucker];
  want(arm.tip);
  want(arm.tip + 0.02 * normalised(deepest().value_or(place()) - arm.port));
  if (m_arms.move_to_depth(m_sucker, kInDepth, 0.035)) go(Phase::suck);
}

void BleedingSurgeon::suck() {
  constexpr double kTouches = 1;  // [N]
  Arms::Arm& arm = m_arms[m_sucker];
  const std::optional<Vec3d> pool = deepest();
  want(arm.tip);
  want(pool.value_or(place()));
  const double left = fluids::kM3PerPicolitre * double(at(m_state->fluids.ledger, fluids::Place::kPool).total());
  const bool pushes = norm(m_state->tools[size_t(m_sucker)].contact_force) > kTouches;
  arm.sucking = pool && left >= kEmpty && !pushes && m_in_phase < 40;
  if (!arm.sucking) return go(Phase::check);
  m_arms.move(m_sucker, *pool, kCareful);
}

void BleedingSurgeon::check() {
  want(place());
  m_distance = 0.05 + 0.01 * double(int(m_in_phase / 4) % 4);
  m_arms.move_to_depth(m_applier, kAway, kTravel);
  if (m_sucker >= 0) m_arms.move_to_depth(m_sucker, kInDepth, kTravel);
  const double late = flawed("E10") ? m_goal.clear_within : 0;
  if (m_in_phase > m_goal.stopped_time + m_goal.check_time + 6 + late) go(Phase::finished);
}

sim::Input BleedingSurgeon::next(const sim::Model& model, const sim::State& state) {
  m_model = &model;
  m_state = &state;
  m_in_phase += sim::kTick;
  m_point_count = 0;
  m_distance = 0.06;
  m_arms.begin_tick();
  pose_vessel(path(), look_at_hosts(model, state, m_hosts), m_artery);
  static constexpr void (BleedingSurgeon::*kRun[])() = {
      &BleedingSurgeon::watch, &BleedingSurgeon::blunder, &BleedingSurgeon::find,  &BleedingSurgeon::reach,
      &BleedingSurgeon::enter, &BleedingSurgeon::inspect, &BleedingSurgeon::close, &BleedingSurgeon::open,
      &BleedingSurgeon::leave, &BleedingSurgeon::change,  &BleedingSurgeon::fetch, &BleedingSurgeon::bring,
      &BleedingSurgeon::suck,  &BleedingSurgeon::check};
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
