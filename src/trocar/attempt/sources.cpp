#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/attempt/session.hpp>
#include <trocar/attempt/sources.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/log.hpp>
#include <trocar/core/text.hpp>
#include <trocar/core/tick.hpp>
#include <trocar/kinematics/fulcrum.hpp>
#include <trocar/training/observe/hands.hpp>

namespace trocar::attempt {

namespace {

constexpr std::uint64_t kNoteEvery = 20;  // ticks
constexpr std::size_t kMostNoted = 5000;

}  // namespace

bool ReplaySource::next(const sim::State& state, sim::Input& input) {
  if (state.tick >= m_inputs.size()) return false;
  input = m_inputs[state.tick];
  return true;
}

bool SurgeonSource::next(const sim::State& state, sim::Input& input) {
  if (m_expert->done()) return false;
  input = m_expert->next(m_model, state);
  return true;
}

void SurgeonSource::after(const sim::State& state, const sim::StepReport& report) {
  m_expert->after(m_model, state, report);
  if (state.tick % kNoteEvery == 0) note_doing(state.tick);
}

/// For the player's captions. A pause between two skills belongs to the one before.
void SurgeonSource::note_doing(std::uint64_t tick) {
  std::string goal = m_expert->goal(), skill = m_expert->doing();
  if (m_performed.size() >= kMostNoted || skill == "think" || m_expert->done()) return;
  if (goal == m_goal && skill == m_skill) return;
  m_goal = std::move(goal);
  m_skill = std::move(skill);
  m_performed.push_back({{"tick", tick}, {"goal", m_goal}, {"skill", m_skill}});
}

Json SurgeonSource::describe() const {
  return {{"surgeon",
           {{"doing", m_expert->doing()},
            {"done", m_expert->done()},
            {"gave_up", m_expert->gave_up()},
            {"performed", m_performed},
            {"difficulties", m_expert->difficulties()}}}};
}

Vec3d HandPlacement::to_scene(const std::array<double, 3>& tip) const {
  return centre + axes * Vec3d{tip[0] - centroid[0], tip[1] - centroid[1], tip[2] - centroid[2]};
}

namespace {

constexpr double kApproachSpeed = 0.03;  // [m/s] mean, on the way to where the trial begins
constexpr double kTouch = 0.01;          // [N] what counts as touching tissue
constexpr double kApproachLeast = 0.5;   // [s]

Mat3d from_columns(Vec3d x, Vec3d y, Vec3d z) { return {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}}; }

/// The one of the first two instruments whose trocar lies further to the picture's left, or right.
int tool_of(const sim::Model& model, Vec3d picture_right, devices::Hand hand) {
  const bool first_is_left = dot(model.hands[0].port - model.hands[1].port, picture_right) < 0;
  return first_is_left == (hand == devices::Hand::left) ? 0 : 1;
}

double smooth_step(double f) { return f * f * (3 - 2 * f); }

double between_rows(const devices::MotionTrial& trial, devices::Hand hand, std::size_t row) {
  const auto& a = trial.samples[row].hand(hand).tip;
  const auto& b = trial.samples[row + 1].hand(hand).tip;
  return length(Vec3d{b[0] - a[0], b[1] - a[1], b[2] - a[2]});
}

}  // namespace

std::array<HandPlacement, 2> place_hands(const sim::Model& model, const devices::MotionTrial& trial) {
  const Vec3d right =
      kinematics::scope_frame(model.scope.port, pose_of(model.start.scope), model.scope.angle, model.start.scope.post)
          .right;
  std::array<HandPlacement, 2> hands;
  for (const devices::Hand which : {devices::Hand::left, devices::Hand::right}) {
    HandPlacement& hand = hands[size_t(which)];
    hand.tool = tool_of(model, right, which);
    const interactions::ToolModel& tool = model.placed(size_t(hand.tool));
    hand.centroid = devices::bounds_of(trial, which).centroid;
    hand.centre = kinematics::forward(tool.port, pose_of(model.start.tools[size_t(hand.tool)])).tip;
    const Vec3d z = normalised(hand.centre - tool.port);
    const Vec3d x = normalised(right - dot(right, z) * z);
    hand.axes = from_columns(x, cross(z, x), z);
  }
  return hands;
}

MotionSource::MotionSource(const sim::Model& model, const std::string& argument)
    : m_model(model), m_trial(devices::read_motion_trial(argument)), m_curve(m_trial) {
  if (model.hands.size() < 2)
    throw core::BadInput({{{argument, 0, 0}, "expected a scene with two instruments for two hands, got fewer"}});
  const std::array<HandPlacement, 2> places = place_hands(model, m_trial);
  double farthest = 0;
  for (const devices::Hand which : {devices::Hand::left, devices::Hand::right}) {
    Hand& hand = m_hands[size_t(which)];
    hand.place = places[size_t(which)];
    hand.bounds = devices::bounds_of(m_trial, which);
    hand.start = hand.place.centre;
    hand.start_roll = double(model.start.tools[size_t(hand.place.tool)].roll);
    hand.first_roll = m_trial.samples.front().hand(which).roll;
    hand.last_tip = hand.start;
    farthest = std::max(farthest, length(hand.place.to_scene(m_trial.samples.front().hand(which).tip) - hand.start));
  }
  m_approach = std::uint64_t(double(core::kTicksPerSecond) * std::max(kApproachLeast, farthest / kApproachSpeed));
}

void MotionSource::aim(Hand& hand, devices::Hand which, std::uint64_t tick, sim::ToolInput& input) {
  const bool approaching = tick < m_approach;
  const std::uint64_t trial_tick = approaching ? 0 : tick - m_approach;
  const devices::HandMotion motion = m_curve.at_tick(trial_tick).hand(which);
  Vec3d tip = hand.place.to_scene(motion.tip);
  double closed = devices::closure(motion.handle, hand.bounds);
  if (approaching) {
    const double f = smooth_step(double(tick) / double(m_approach));
    tip = hand.start + f * (tip - hand.start);
    closed *= f;
  }
  const interactions::ToolModel& tool = m_model.placed(size_t(hand.place.tool));
  const kinematics::FulcrumPose wanted =
      kinematics::inverse(tool.port, tip, hand.start_roll + motion.roll - hand.first_roll);
  const kinematics::FulcrumPose allowed = kinematics::clamped(wanted, tool.limits);
  const bool reachable = wanted.yaw == allowed.yaw && wanted.pitch == allowed.pitch && wanted.depth == allowed.depth;
  if (!approaching && !reachable) {
    ++hand.unreachable;
    hand.row_reachable = false;
  }
  input = sim::tool_input(allowed, float(closed));
}

bool MotionSource::next(const sim::State&, sim::Input& input) {
  if (m_tick >= m_approach + m_curve.ticks()) return false;
  input = m_model.start;
  for (const devices::Hand which : {devices::Hand::left, devices::Hand::right}) {
    Hand& hand = m_hands[size_t(which)];
    aim(hand, which, m_tick, input.tools[hand.place.tool]);
  }
  ++m_tick;
  return true;
}

void MotionSource::after(const sim::State& state, const sim::StepReport&) {
  for (const devices::Hand which : {devices::Hand::left, devices::Hand::right}) {
    Hand& hand = m_hands[size_t(which)];
    const Vec3d tip = training::tip_of(m_model, state, size_t(hand.place.tool));
    if (m_tick > m_approach + 1) hand.since_row += length(tip - hand.last_tip);
    hand.last_tip = tip;
    const double(&force)[3] = state.tools[size_t(hand.place.tool)].contact_force;
    if (m_tick > m_approach && length(Vec3d{force[0], force[1], force[2]}) > kTouch) ++hand.touching;
    const double time = m_tick > m_approach ? double(m_tick - m_approach - 1) * sim::kTick : 0.0;
    if (hand.row + 1 >= m_trial.samples.size() || time < m_trial.samples[hand.row + 1].time) continue;
    if (hand.row_reachable) {
      hand.file_path += between_rows(m_trial, which, hand.row);
      hand.performed += hand.since_row;
    }
    ++hand.row;
    hand.since_row = 0;
    hand.row_reachable = true;
  }
}

Json MotionSource::describe() const {
  Json out{{"trial", m_trial.name}, {"trial_seconds", m_curve.duration()}, {"hands", Json::array()}};
  for (const devices::Hand which : {devices::Hand::left, devices::Hand::right}) {
    const Hand& hand = m_hands[size_t(which)];
    const double done = m_tick > m_approach ? double(m_tick - m_approach) : 0.0;
    out["hands"].push_back({{"hand", which == devices::Hand::left ? "left" : "right"},
                            {"instrument", m_model.placed(size_t(hand.place.tool)).name},
                            {"file_path_length_mm", 1000 * hand.bounds.path_length},
                            {"file_path_length_reachable_mm", 1000 * hand.file_path},
                            {"performed_path_length_mm", 1000 * hand.performed},
                            {"path_ratio", hand.file_path > 0 ? Json(hand.performed / hand.file_path) : Json(nullptr)},
                            {"touching_tissue_share", done > 0 ? double(hand.touching) / done : 0.0},
                            {"unreachable_share", done > 0 ? double(hand.unreachable) / done : 0.0}});
  }
  return out;
}

namespace {

/// The inputs of a recording; where they were made for something else, their different effect here is reported.
std::unique_ptr<InputSource> replay_source(const Lesson& lesson, const std::string& file) {
  sim::Recording recording = sim::read_recording(file);
  if (!recording.damage.empty())
    core::log::warn("{}: {}; {} ticks are used", file, recording.damage, recording.inputs.size());
  if (recording.header.exercise != lesson.name)
    core::log::warn("{}: was made in {}, not in {}", file, recording.header.exercise, lesson.name);
  if (recording.header.seed != lesson.seed)
    core::log::warn("{}: was made with --seed {}, not {}", file, recording.header.seed, lesson.seed);
  else if (recording.header.model_hash != lesson.model.hash)
    core::log::warn(
        "{}: was made with another version of the physics or the scene; the same motions may have other effects", file);
  return std::make_unique<ReplaySource>(std::move(recording.inputs));
}

}  // namespace

std::unique_ptr<InputSource> make_source(const Lesson& lesson, const std::string& input) {
  const auto argument = [&input](const std::string& kind) {
    return input.rfind(kind + ":", 0) == 0 ? input.substr(kind.size() + 1) : std::string{};
  };
  if (input == "demo") return lesson.surgeon();
  if (const std::string file = argument("motion"); !file.empty())
    return std::make_unique<MotionSource>(lesson.model, file);
  if (const std::string file = argument("replay"); !file.empty()) return replay_source(lesson, file);
  throw core::BadInput(
      {{{"--input", 0, 0}, tr("expected mouse, demo, motion:FILE, replay:FILE or box:PORT, got '{}'", input)}});
}

}  // namespace trocar::attempt
