#include "commands/rooms/room_follow.hpp"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include <trocar/attempt/lesson.hpp>
#include <trocar/core/error.hpp>
#include <trocar/sim/recording/recording.hpp>

namespace trocar::app {

using namespace studies;

namespace {

constexpr double kSamePort = 0.002;  // [m]

struct HandOfArm {
  int hand = -1;
  Vec3d port;
};

}  // namespace

RoomMotion motion_of_recording(const RoomModel& model, const std::string& file, double seconds) {
  auto recording = std::make_shared<const sim::Recording>(sim::read_recording(file));
  if (recording->inputs.empty()) throw core::BadInput({{{file, 0, 0}, "expected a recording with inputs, got none"}});
  const std::unique_ptr<attempt::Lesson> lesson =
      attempt::load_lesson(recording->header.exercise, recording->header.seed);
  std::vector<HandOfArm> hands(model.arms().size());
  RoomMotion motion;
  std::string known;
  for (std::size_t h = 0; h < lesson->model.hands.size(); ++h) {
    const sim::HandModel& hand = lesson->model.hands[h];
    known += fmt::format("{}{} ({:.0f}, {:.0f}, {:.0f})", known.empty() ? "" : "; ", hand.name, 1e3 * hand.port.x,
                         1e3 * hand.port.y, 1e3 * hand.port.z);
    for (std::size_t a = 0; a < hands.size(); ++a)
      if (length(model.arms()[a].port - hand.port) < kSamePort) {
        hands[a] = {int(h), hand.port};
        motion.moves.push_back(int(a));
      }
  }
  if (motion.moves.empty())
    throw core::BadInput(
        {{{model.room().file, 0, 0},
          fmt::format("expected an arm at the port of one of the recording's hands ({}), got none", known)}});
  const double recorded = double(recording->inputs.size() - 1) / double(core::kTicksPerSecond);
  motion.length = seconds > 0 ? std::min(seconds, recorded) : recorded;
  motion.goal = [recording, hands](int arm, double at) {
    const auto tick = std::min(recording->inputs.size() - 1, std::size_t(at * double(core::kTicksPerSecond) + 0.5));
    const HandOfArm& hand = hands[std::size_t(arm)];
    const sim::ToolInput& t = recording->inputs[tick].tools[hand.hand];
    const kinematics::TipFrame tip = kinematics::forward(hand.port, {t.yaw, t.pitch, t.roll, t.depth});
    return ArmGoal{tip.tip, true, tip.rotation};
  };
  const scene::RoomTilt still = model.room().table.tilt;
  motion.tilt = [still](double) { return still; };
  return motion;
}

}  // namespace trocar::app
