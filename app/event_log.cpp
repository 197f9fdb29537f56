#include "event_log.hpp"

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/sim/visibility.hpp>

namespace trocar::app {
namespace {

Json millimetres(Vec3d v) { return {1000 * v.x, 1000 * v.y, 1000 * v.z}; }
Json direction(Vec3d v) { return {v.x, v.y, v.z}; }

/// Middle of every named stretch of every strand.
Json landmarks(const sim::Model& model, const sim::State& state) {
  Json out = Json::object();
  for (std::size_t i = 0; i < model.strands.size(); ++i)
    for (const sim::LandmarkModel& l : model.strands[i].landmarks) {
      const interactions::StrandPlace place = interactions::place_at(model.bodies[i], 0.5 * (l.from + l.to));
      out[model.strands[i].name + "." + l.name] = {
          {"at_mm", millimetres(interactions::point_at(model.bodies[i], state.strands[i], place))},
          {"along", direction(interactions::tangent_at(model.bodies[i], state.strands[i], place))}};
    }
  return out;
}

}  // namespace

EventLog::EventLog(const std::string& path) {
  if (path.empty()) return;
  m_file.reset(std::fopen(path.c_str(), "w"));
  if (!m_file) throw core::EnvironmentLacks(fmt::format("cannot write the log {}: check the folder", path));
}

void EventLog::event(const std::string& name, const Json& details) {
  if (!m_file) return;
  Json line{{"event", name}};
  line.update(details);
  const std::string text = line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  std::fputs(text.c_str(), m_file.get());
  std::fflush(m_file.get());
}

void EventLog::moment(const sim::Model& model, const Moment& moment) {
  Json details{{"tick", moment.tick}, {"text", moment.text}};
  if (moment.tool >= 0) details["tool"] = model.tools[size_t(moment.tool)].name;
  event(moment.what, details);
}

void EventLog::pose(const sim::Model& model, const sim::State& state, int led) {
  if (!m_file || state.tick < m_next_pose) return;
  m_next_pose = state.tick + 100;
  const kinematics::ScopeFrame view = sim::scope_of(model, state);
  Json tools = Json::array();
  for (std::size_t t = 0; t < model.tools.size(); ++t) {
    const interactions::ToolState& tool = state.tools[t];
    const kinematics::TipFrame frame = kinematics::forward(model.tools[t].port, tool.pose());
    tools.push_back({{"name", model.tools[t].name},
                     {"tip_mm", millimetres(frame.tip)},
                     {"shaft", direction(frame.axis())},
                     {"opening", direction(frame.opening())},
                     {"depth_mm", 1000 * tool.depth},
                     {"jaw_mm", 1000 * model.tools[t].jaw_length},
                     {"aperture", tool.aperture},
                     {"handle", tool.handle},
                     {"holds", tool.holds},
                     {"pull_N", length(Vec3d{tool.pull[0], tool.pull[1], tool.pull[2]})}});
  }
  event("pose",
        {{"tick", state.tick},
         {"led", led < 0 ? "scope" : model.tools[size_t(led)].name},
         {"picture", {{"eye_mm", millimetres(view.eye)}, {"right", direction(view.right)}, {"up", direction(view.up)}}},
         {"tools", tools},
         {"landmarks", landmarks(model, state)}});
}

}  // namespace trocar::app
