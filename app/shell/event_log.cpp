#include "shell/event_log.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/log.hpp>
#include <trocar/core/text.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/stages/visibility.hpp>

namespace trocar::app {
namespace {

Json millimetres(Vec3d v) { return {1000 * v.x, 1000 * v.y, 1000 * v.z}; }
Json direction(Vec3d v) { return {v.x, v.y, v.z}; }

/// Middle of every named stretch of every strand.
Json landmarks(const sim::Model& model, const sim::State& state) {
  Json out = Json::object();
  for (std::size_t i = 0; i < model.strands.size(); ++i)
    for (const sim::LandmarkModel& l : model.strands[i].landmarks) {
      const interactions::StrandPlace place = interactions::place_at(model.strand_bodies[i], 0.5 * (l.from + l.to));
      out[model.strands[i].name + "." + l.name] = {
          {"at_mm", millimetres(interactions::point_at(model.strand_bodies[i], state.strands[i], place))},
          {"along", direction(interactions::tangent_at(model.strand_bodies[i], state.strands[i], place))},
          {"from_mm", 1000 * l.from},
          {"to_mm", 1000 * l.to}};
    }
  return out;
}

/// Is this jaw in the picture and nothing before it?
bool seen(const sim::Model& model, const sim::State& state, std::size_t hand, const char* jaw) {
  return sim::visible(model, state, model.target_index(model.hands[hand].name + jaw));
}

Json clips(const sim::Model& model, const sim::State& state) {
  Json out = Json::array();
  for (int i = 0; i < state.clip_count; ++i) {
    const interactions::Clip& c = state.clips[size_t(i)];
    out.push_back({{"on", c.body().exists() ? sim::name_of(model, c.body()) : ""},
                   {"s_mm", 1000 * c.s},
                   {"off_square_rad", c.theta},
                   {"cover", c.cover},
                   {"closing_s", c.closing_time},
                   {"tips_seen", c.tips_visible}});
  }
  return out;
}

/// Every strand as points along it: [arc length from its start, x, y, z, radius] [mm], one about every 4 mm.
Json courses(const sim::Model& model, const sim::State& state) {
  Json out = Json::object();
  for (std::size_t i = 0; i < model.strands.size(); ++i) {
    const interactions::StrandBody& body = model.strand_bodies[i];
    const double whole = body.length();
    Json points = Json::array();
    const int pieces = std::clamp(int(whole / 0.004), 2, 40);
    for (int p = 0; p <= pieces; ++p) {
      const double s = whole * double(p) / pieces;
      const Vec3d x = interactions::point_at(body, state.strands[i], interactions::place_at(body, s));
      const double radius = body.model.radius[size_t(interactions::place_at(body, s).element)];
      points.push_back({1000 * s, 1000 * x.x, 1000 * x.y, 1000 * x.z, 1000 * radius});
    }
    out[model.strands[i].name] = points;
  }
  return out;
}

/// Who is at the left, at the right, what the mouse leads, and whether the endoscope is led just now.
Json pair_of(const sim::Model& model, const devices::BothHands* both) {
  if (!both) return nullptr;
  const auto name = [&](int side) { return model.hands[size_t(both->pair[size_t(side)])].name; };
  return {{"left", name(devices::kLeft)},
          {"right", name(devices::kRight)},
          {"mouse", name(both->mouse)},
          {"looking", both->looking}};
}

}  // namespace

std::string EventLog::path_of(const std::string& given) {
  const char* from_environment = std::getenv("TROCAR_WINDOW_LOG");
  return !given.empty() ? given : from_environment ? from_environment : "";
}

EventLog::EventLog(const std::string& path) : m_path(path) {
  if (path.empty()) return;
  m_file.reset(std::fopen(path.c_str(), "w"));
  if (!m_file) throw core::EnvironmentLacks(tr("cannot write the log {}: check the folder", path));
}

void EventLog::event(const std::string& name, const Json& details) {
  if (!m_file) return;
  Json line{{"event", name}};
  line.update(details);
  const std::string text = line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  const bool written = std::fputs(text.c_str(), m_file.get()) >= 0 && std::fflush(m_file.get()) == 0;
  if (written || !m_failure.empty()) return;
  m_failure = tr("lines of the log {} are lost: {}", m_path, std::strerror(errno ? errno : EIO));
  core::log::error("{}", m_failure);
}

void EventLog::moment(const sim::Model& model, const attempt::Moment& moment) {
  Json details{{"tick", moment.tick}, {"text", moment.text}};
  if (moment.tool >= 0) details["tool"] = model.hands[size_t(moment.tool)].name;
  if (!moment.code.empty()) details["code"] = moment.code;
  event(moment.what, details);
}

void EventLog::pose(const sim::Model& model, const attempt::Snapshot& now, int led, const devices::BothHands* both) {
  const sim::State& state = now.state;
  if (!m_file || (state.tick < m_next_pose && state.tick >= m_last_tick)) return;
  m_last_tick = state.tick;
  m_next_pose = state.tick + 100;
  const kinematics::ScopeFrame view = sim::scope_of(model, state);
  Json tools = Json::array();
  for (std::size_t h = 0; h < model.hands.size(); ++h) {
    const interactions::ToolState& tool = state.tools[h];
    const interactions::ToolModel& held = model.tool(state, h);
    const interactions::ToolShape shape = sim::shape_of(model, state, h);
    Json rack = Json::array();
    for (const interactions::ToolModel& t : model.hands[h].rack) rack.push_back(t.name);
    tools.push_back({{"name", model.hands[h].name},
                     {"instrument", held.name},
                     {"rack", rack},
                     {"port_mm", millimetres(held.port)},
                     {"tip_mm", millimetres(shape.frame.tip)},
                     {"pivot_mm", millimetres(shape.pivot)},
                     {"shaft", direction(shape.frame.axis())},
                     {"opening", direction(shape.frame.opening())},
                     {"depth_mm", 1000 * tool.depth},
                     {"jaw_mm", 1000 * held.jaw_length},
                     {"clip_mm", 1000 * held.clip_length},
                     {"seen", {seen(model, state, h, ".jaw_a"), seen(model, state, h, ".jaw_b")}},
                     {"aperture", tool.aperture},
                     {"handle", tool.handle},
                     {"holds", tool.holds},
                     {"clips_left", tool.clips_left},
                     {"pull_N", length(Vec3d{tool.pull[0], tool.pull[1], tool.pull[2]})}});
  }
  event("pose", {{"tick", state.tick},
                 {"seconds", now.seconds},
                 {"speed", now.speed},
                 {"step", now.current_step},
                 {"led", led < 0 || led >= int(model.hands.size()) ? "scope" : model.hands[size_t(led)].name},
                 {"both", pair_of(model, both)},
                 {"picture",
                  {{"port_mm", millimetres(model.scope.port)},
                   {"depth_mm", 1000 * double(state.scope.depth)},
                   {"field_rad", model.scope.field_of_view},
                   {"eye_mm", millimetres(view.eye)},
                   {"right", direction(view.right)},
                   {"up", direction(view.up)},
                   {"forward", direction(view.forward)}}},
                 {"tools", tools},
                 {"landmarks", landmarks(model, state)},
                 {"strands", courses(model, state)},
                 {"clips", clips(model, state)},
                 {"cuts", state.cut_count}});
}

}  // namespace trocar::app
