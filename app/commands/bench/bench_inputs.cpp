#include "commands/bench/bench_inputs.hpp"

#include <trocar/attempt/session.hpp>
#include <trocar/attempt/sources.hpp>
#include <trocar/core/log.hpp>

namespace trocar::app {
namespace {

std::vector<sim::Input> operation(const attempt::Lesson& lesson, double seconds) {
  const std::unique_ptr<attempt::InputSource> source = lesson.surgeon();
  attempt::Session session(lesson);
  std::vector<sim::Input> inputs;
  sim::Input input = lesson.model.start;
  while (double(inputs.size()) * sim::kTick < seconds && !session.finished() && source->next(session.state(), input)) {
    source->after(session.state(), session.advance(input));
    inputs.push_back(input);
  }
  return inputs;
}

/// The point of the organs' skins that is nearest to a port.
Vec3d nearest_skin(const sim::Model& model, Vec3d port) {
  Vec3d best = model.hands.front().port;
  double least = 1e9;
  for (int organ = 0; organ < model.organs(); ++organ) {
    const tissue::Skin& skin = model.skin(organ);
    for (int v = 0; v < skin.size(); ++v) {
      const Vec3d p = vec_cast<double>(skin.rest[std::size_t(v)]);
      if (!skin.at_surface(v) || length(p - port) >= least) continue;
      least = length(p - port);
      best = p;
    }
  }
  return best;
}

std::vector<sim::Input> rummage(const sim::Model& model, double seconds) {
  std::vector<Vec3d> goal;
  for (const sim::HandModel& hand : model.hands) goal.push_back(nearest_skin(model, hand.port));
  std::vector<sim::Input> inputs(std::size_t(seconds / sim::kTick), model.start);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const std::size_t round = i / 2000, t = i % 2000;
    const double deep = 0.004 * double(1 + round % 6), back = t < 1000 ? 0 : 0.012;
    const float handle = t >= 500 && t < 1700 ? 1.0f : 0.0f;
    for (std::size_t h = 0; h < model.hands.size(); ++h) {
      const Vec3d port = model.hands[h].port, in = normalised(goal[h] - port);
      sim::ToolInput& tool = inputs[i].tools[h];
      tool = sim::tool_input(kinematics::inverse(port, goal[h] + (deep - back) * in, double(tool.roll)), handle,
                             tool.instrument);
    }
  }
  return inputs;
}

}  // namespace

std::vector<sim::Input> bench_inputs(const attempt::Lesson& lesson, double seconds) {
  if (!lesson.exercise) return rummage(lesson.model, seconds);
  core::log::info("the surgeon operates for up to {:.0f} s, first to record, then to measure", seconds);
  return operation(lesson, seconds);
}

}  // namespace trocar::app
