#include "commands/rooms/room_follow.hpp"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include <trocar/attempt/lesson.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/sim/recording/recording.hpp>

#include "rooms/room_hands.hpp"

namespace trocar::app {

using namespace studies;

RoomMotion motion_of_recording(const RoomModel& model, const std::string& file, double seconds) {
  auto recording = std::make_shared<const sim::Recording>(sim::read_recording(file));
  if (recording->inputs.empty()) throw core::BadInput({{{file, 0, 0}, "expected a recording with inputs, got none"}});
  const std::shared_ptr<const attempt::Lesson> lesson =
      attempt::load_lesson(recording->header.exercise, recording->header.seed);
  const RoomHands hands(model, lesson->model);
  RoomMotion motion;
  std::vector<RoomHands::Link> link_of(model.arms().size());
  for (const RoomHands::Link& link : hands.links()) {
    motion.moves.push_back(link.arm);
    link_of[std::size_t(link.arm)] = link;
  }
  if (motion.moves.empty())
    throw core::BadInput(
        {{{model.room().file, 0, 0},
          tr("expected an arm at the port of one of the recording's hands ({}), got none", hands.known())}});
  const double recorded = double(recording->inputs.size() - 1) / double(core::kTicksPerSecond);
  motion.length = seconds > 0 ? std::min(seconds, recorded) : recorded;
  const auto input = [recording](double at) -> const sim::Input& {
    return recording
        ->inputs[std::min(recording->inputs.size() - 1, std::size_t(at * double(core::kTicksPerSecond) + 0.5))];
  };
  motion.goal = [input, hands, link_of, lesson](int arm, double at) {
    return hands.goal(link_of[std::size_t(arm)], input(at));
  };
  motion.tips = [input, hands, lesson](double at) { return hands.tips(input(at)); };
  const scene::RoomTilt still = model.room().table.tilt;
  motion.tilt = [still](double) { return still; };
  return motion;
}

}  // namespace trocar::app
