#include <algorithm>

#include <trocar/training/surgeon.hpp>

namespace trocar::training {
namespace {

constexpr double kTravel = 0.045, kCareful = 0.018;  // [m/s] through the open, and at the tissue
constexpr double kNear = 0.0006;                     // [m] close enough
constexpr double kPatience = 25;                     // [s] in one phase before giving up
constexpr double kBack = 0.022;                      // [m] in front of the tissue where an approach begins

int tool_named(const sim::Model& model, const std::string& name) {
  for (size_t t = 0; t < model.hands.size(); ++t)
    if (model.placed(t).name == name) return int(t);
  return -1;
}

/// One tick of a hand that slows down near its goal.
Vec3d moved(Vec3d from, Vec3d to, double speed) {
  const Vec3d way = to - from;
  const double distance = length(way);
  const double pace = std::min(speed, 0.002 + 6.0 * distance) * sim::kTick;
  return distance <= pace ? to : from + (pace / distance) * way;
}

double turned(double from, double to) { return from + std::clamp(to - from, -0.0015, 0.0015); }

/// The jaws look the same after half a turn: the nearest of the equivalent rolls.
double nearest_roll(double wanted, double now) {
  constexpr double kHalfTurn = 3.14159265358979323846;
  while (wanted - now > 0.5 * kHalfTurn) wanted -= kHalfTurn;
  while (wanted - now < -0.5 * kHalfTurn) wanted += kHalfTurn;
  return wanted;
}

double norm(const double (&v)[3]) { return length(Vec3d{v[0], v[1], v[2]}); }

}  // namespace

Surgeon::Surgeon(const Exercise& exercise, const sim::Model& model) : m_exercise(exercise) {
  const Sterilisation& g = exercise.goal;
  m_tube = model.strand_index(g.tube);
  m_grasper = tool_named(model, g.grasper);
  m_applier = tool_named(model, g.applier);
  m_scissors = tool_named(model, g.scissors);
  if (m_tube < 0 || m_grasper < 0 || m_applier < 0 || m_scissors < 0)
    throw core::BadInput({{{exercise.file.string(), 0, 0}, "expected the tube and three instruments in the scene"}});
  // Both clips inside their ranges, symmetric about the place of the cut.
  m_clip_at[0] = g.first_clip.low + 0.5 * (g.first_clip.high - g.first_clip.low);
  m_clip_at[1] = std::clamp(m_clip_at[0] + 0.5 * (g.clip_distance.low + g.clip_distance.high), g.second_clip.low,
                            g.second_clip.high);
  m_cut_at = 0.5 * (m_clip_at[0] + m_clip_at[1]);
  m_grasp_at = 0.040;
  for (const sim::LandmarkModel& l : model.strands[size_t(m_tube)].landmarks)
    if (l.name == "ampulla") m_grasp_at = l.from + 0.35 * (l.to - l.from);
  for (size_t t = 0; t < model.hands.size(); ++t) {
    const sim::ToolInput& in = model.start.tools[t];
    m_hand[t] = {kinematics::forward(model.hands[t].port, pose_of(in)).tip, double(in.roll), double(in.handle)};
  }
  m_scope = model.start.scope;
  m_scope_tip = kinematics::forward(model.scope.port, pose_of(m_scope)).tip;
}

const char* Surgeon::doing() const {
  switch (m_phase) {
    case Phase::look:
      return "look around";
    case Phase::reach_ampulla:
      return "approach the ampulla";
    case Phase::enter_ampulla:
      return "take the ampulla between the jaws";
    case Phase::grasp:
      return "grasp";
    case Phase::lift:
      return "lift the tube";
    case Phase::reach_clip:
      return "bring the clip applier";
    case Phase::enter_clip:
      return "take the isthmus between the legs";
    case Phase::close_clip:
      return "close the clip slowly";
    case Phase::open_clip:
      return "open the applier";
    case Phase::leave_clip:
      return "draw the applier back";
    case Phase::reach_cut:
      return "bring the scissors";
    case Phase::enter_cut:
      return "take the isthmus between the blades";
    case Phase::close_cut:
      return "cut";
    case Phase::open_cut:
      return "open the scissors";
    case Phase::leave_cut:
      return "draw the scissors back";
    case Phase::finished:
      break;
  }
  return "done";
}

void Surgeon::go(Phase next) {
  m_phase = next;
  m_in_phase = 0;
}

bool Surgeon::aim(const sim::Model& model, const sim::State& state, int tool, double s, double inside, double back,
                  double speed) {
  const interactions::ToolModel& t = model.placed(size_t(tool));
  Hand& hand = m_hand[size_t(tool)];
  const interactions::StrandBody& tube = model.bodies[size_t(m_tube)];
  const interactions::StrandPlace place = interactions::place_at(tube, s);
  const Vec3d at = interactions::point_at(tube, state.strands[size_t(m_tube)], place);
  const Vec3d tangent = interactions::tangent_at(tube, state.strands[size_t(m_tube)], place);
  const Vec3d axis = normalised(at - t.port);
  const Vec3d goal = at + (t.jaw_length - inside - back) * axis;
  hand.tip = moved(hand.tip, goal, speed);
  const kinematics::FulcrumPose pose = kinematics::inverse(t.port, hand.tip, hand.roll);
  const double wanted = nearest_roll(kinematics::roll_towards(pose, tangent), hand.roll);
  hand.roll = turned(hand.roll, wanted);
  return length(hand.tip - goal) < kNear && std::fabs(wanted - hand.roll) < 0.02;
}

bool Surgeon::move_handle(int tool, double to, double seconds) {
  double& handle = m_hand[size_t(tool)].handle;
  const double pace = sim::kTick / seconds;
  handle += std::clamp(to - handle, -pace, pace);
  return std::fabs(handle - to) < 1e-9;
}

void Surgeon::lift(const sim::Model& model, const sim::State& state) {
  // Up and outwards until the isthmus is straight enough for a perpendicular clip, but gently.
  const double pull = norm(state.tools[size_t(m_grasper)].pull);
  const double comfortable = 0.6 * m_exercise.goal.present_pull.high;
  constexpr double kHighest = 0.030;  // [m]
  const interactions::StrandBody& tube = model.bodies[size_t(m_tube)];
  const tissue::StrandState& s = state.strands[size_t(m_tube)];
  const double side = tube.model.rest.back().x > 0 ? 1 : -1;
  const Vec3d up = normalised(Vec3d{0.35 * side, 0.10, 1.0});
  if (pull < comfortable && m_lifted < kHighest) m_lifted += 0.012 * sim::kTick;
  if (pull > 1.1 * comfortable) m_lifted -= 0.006 * sim::kTick;
  m_hand[size_t(m_grasper)].tip = m_lift_from + m_lifted * up;
  const interactions::StrandPlace place = interactions::place_at(tube, m_cut_at);
  const Vec3d at = interactions::point_at(tube, s, place), tangent = interactions::tangent_at(tube, s, place);
  const Vec3d axis = normalised(at - model.hands[size_t(m_applier)].port);
  const bool across = std::fabs(dot(axis, tangent)) < 0.10;
  const bool enough = pull > 1.3 * m_exercise.goal.present_pull.low;
  if ((across && enough) || m_lifted >= kHighest || pull >= comfortable)
    if (m_in_phase > 1.5) go(Phase::reach_clip);
}

void Surgeon::steer_clip(const sim::Model& model, const sim::State& state) {
  const interactions::ToolModel& t = model.placed(size_t(m_applier));
  const double s = m_clip_at[size_t(std::min(m_clips, 1))];
  const double inside = t.jaw_length - 0.5 * t.clip_length;  // the tube in the middle of the clip
  switch (m_phase) {
    case Phase::reach_clip:
      if (aim(model, state, m_applier, s, inside, kBack, kTravel)) go(Phase::enter_clip);
      break;
    case Phase::enter_clip:
      if (aim(model, state, m_applier, s, inside, 0, kCareful)) go(Phase::close_clip);
      break;
    case Phase::close_clip:
      aim(model, state, m_applier, s, inside, 0, 0.004);
      if (move_handle(m_applier, 1, 2.6 * m_exercise.goal.clip_closing) && state.clip_count > m_clips) {
        m_clips = state.clip_count;
        go(Phase::open_clip);
      }
      break;
    case Phase::open_clip:
      if (move_handle(m_applier, 0, 0.5)) go(Phase::leave_clip);
      break;
    case Phase::leave_clip:
      if (aim(model, state, m_applier, s, inside, kBack, kCareful))
        go(m_clips < 2 ? Phase::reach_clip : Phase::reach_cut);
      break;
    default:
      break;
  }
}

void Surgeon::steer_cut(const sim::Model& model, const sim::State& state) {
  const interactions::ToolModel& t = model.placed(size_t(m_scissors));
  const double inside = 0.72 * t.jaw_length;  // near the blades' ends: spare the fold behind the tube
  // The applier makes room.
  const interactions::ToolModel& a = model.placed(size_t(m_applier));
  Hand& applier = m_hand[size_t(m_applier)];
  applier.tip = moved(applier.tip, a.port + 0.045 * normalised(applier.tip - a.port), kTravel);
  switch (m_phase) {
    case Phase::reach_cut:
      if (aim(model, state, m_scissors, m_cut_at, inside, kBack, kTravel)) go(Phase::enter_cut);
      break;
    case Phase::enter_cut:
      if (aim(model, state, m_scissors, m_cut_at, inside, 0, kCareful)) go(Phase::close_cut);
      break;
    case Phase::close_cut:
      aim(model, state, m_scissors, m_cut_at, inside, 0, 0.004);
      if (move_handle(m_scissors, 1, 0.6)) go(Phase::open_cut);
      break;
    case Phase::open_cut:
      if (move_handle(m_scissors, 0, 0.5)) go(Phase::leave_cut);
      break;
    case Phase::leave_cut: {
      Hand& hand = m_hand[size_t(m_scissors)];
      hand.tip = moved(hand.tip, hand.tip - kBack * normalised(hand.tip - t.port), kCareful);
      if (m_in_phase > 2) go(Phase::finished);
      break;
    }
    default:
      break;
  }
}

void Surgeon::steer(const sim::Model& model, const sim::State& state) {
  const double inside = 0.6 * model.placed(size_t(m_grasper)).jaw_length;
  switch (m_phase) {
    case Phase::look:
      if (m_in_phase > 0.5) go(Phase::reach_ampulla);
      break;
    case Phase::reach_ampulla:
      if (aim(model, state, m_grasper, m_grasp_at, inside, kBack, kTravel)) go(Phase::enter_ampulla);
      break;
    case Phase::enter_ampulla:
      if (aim(model, state, m_grasper, m_grasp_at, inside, 0, kCareful)) go(Phase::grasp);
      break;
    case Phase::grasp:
      if (move_handle(m_grasper, 0.95, 0.8) && m_in_phase > 1.2) {
        m_lift_from = m_hand[size_t(m_grasper)].tip;
        go(Phase::lift);
      }
      break;
    case Phase::lift:
      lift(model, state);
      break;
    case Phase::finished:
      break;
    default:
      if (m_phase < Phase::reach_cut)
        steer_clip(model, state);
      else
        steer_cut(model, state);
  }
}

void Surgeon::follow_with_scope(const sim::Model& model, const sim::State& state, sim::Input& input) {
  // The camera comes closer to where the work is and keeps a working distance.
  if (m_phase >= Phase::lift && m_phase < Phase::finished) {
    constexpr double kWorking = 0.062;  // [m] lens to tissue
    const interactions::StrandBody& tube = model.bodies[size_t(m_tube)];
    const Vec3d at =
        interactions::point_at(tube, state.strands[size_t(m_tube)], interactions::place_at(tube, m_cut_at));
    const Vec3d towards = normalised(at - model.scope.port);
    m_scope_tip = moved(m_scope_tip, at - kWorking * towards, 0.008);
  }
  const kinematics::FulcrumPose pose = kinematics::inverse(model.scope.port, m_scope_tip, double(m_scope.roll));
  m_scope.yaw = float(pose.yaw);
  m_scope.pitch = float(pose.pitch);
  m_scope.depth = float(pose.depth);
  input.scope = m_scope;
}

sim::Input Surgeon::next(const sim::Model& model, const sim::State& state) {
  m_in_phase += sim::kTick;
  if (m_in_phase > kPatience && !done()) {
    m_gave_up = true;
    go(Phase::finished);
  }
  if (!done()) steer(model, state);
  sim::Input input = model.start;
  for (size_t t = 0; t < model.hands.size(); ++t) {
    const Hand& h = m_hand[t];
    input.tools[t] = sim::tool_input(kinematics::inverse(model.hands[t].port, h.tip, h.roll), float(h.handle));
  }
  follow_with_scope(model, state, input);
  return input;
}

}  // namespace trocar::training
