#include "rooms/room_window.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <trocar/attempt/interrupt.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/modeller/picture/handles.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/render/gl/gl_context.hpp>
#include <trocar/studies/operating_room/motion.hpp>

#include "rooms/room_camera.hpp"
#include "shell/event_log.hpp"
#include "shell/open_window.hpp"
#include "shell/pane_canvas.hpp"
#include "shell/panes.hpp"
#include "shell/settings.hpp"
#include "shell/ui.hpp"

namespace trocar::app {
namespace {

using namespace studies;

constexpr double kDegree = portable::pi / 180, kTiltStep = 1 * kDegree;
constexpr float kPanelWidth = 360, kPortReach = 14;  // [px]
constexpr double kPlayedEvery = 0.05;                // [s] of a programme that is gone through
constexpr double kGapShown = 0.06;                   // [m]

class RoomWindow {
 public:
  RoomWindow(Window& window, RoomWindowOptions options, EventLog& log)
      : m_window(window),
        m_log(log),
        m_room(std::move(options.room)),
        m_programme(std::move(options.programme)),
        m_context(render::GlContext::adopt_current()),
        m_backend(render::make_gl_backend(*m_context)),
        m_orbit(room_views()[1].orbit) {
    rebuild();
  }

  void run() {
    while (!m_window.wants_to_close() && !m_quit && !attempt::interrupted()) picture();
  }

 private:
  void tell_log(const std::string& what) {
    m_log.event(what, {{"head_down_deg", m_pose.tilt.head_down / kDegree},
                       {"left_down_deg", m_pose.tilt.left_down / kDegree},
                       {"time", m_time},
                       {"least_mm", m_near.empty() ? 0 : 1e3 * m_near.front().distance}});
  }

  /// After ports or places have changed: arms are docked anew and a programme is gone through again.
  void rebuild() {
    try {
      m_model = std::make_unique<RoomModel>(m_room);
    } catch (const std::invalid_argument& bad) {
      m_said = bad.what();
      return;
    }
    m_said.clear();
    const scene::RoomTilt tilt = m_drawing ? m_pose.tilt : m_room.table.tilt;
    m_pose = m_model->start();
    m_pose.tilt = tilt;
    m_motion.reset();
    m_report = {};
    if (!m_programme.moves.empty()) {
      m_motion = motion_of(*m_model, m_programme);
      MotionOptions quick;
      quick.step = kPlayedEvery;
      quick.kept_every = 1;
      m_report = go_through(*m_model, *m_motion, quick);
      show_time();
    }
    stand();
    if (!m_drawing) m_drawing = std::make_unique<view::RoomDrawing>(*m_backend, scenery());
    m_stale = true;
  }

  view::Scenery scenery() const {
    view::Scenery s = scenery_of(*m_model, m_pose);
    if (m_shows_gaps) show_clearance(s, *m_model, m_pose, kGapShown);
    if (m_shows_reach) show_reach(s, *m_model);
    if (m_port >= 0) s.chosen.push_back(m_room.ports[std::size_t(m_port)].position);
    return s;
  }

  void stand() {
    m_model->place(m_pose);
    m_near = m_model->nearest(m_pose);
    m_stale = true;
  }

  void show_time() {
    if (m_report.steps.empty()) return;
    m_pose = step_at(m_report, m_time).pose;
    stand();
  }

  void tilt(double head, double left) {
    scene::RoomTilt wanted = m_pose.tilt;
    wanted.head_down += head;
    wanted.left_down += left;
    if (!m_model->can_tilt(wanted)) {
      m_said = "the table cannot tilt further";
      return;
    }
    m_pose.tilt = wanted;
    m_said.clear();
    stand();
    tell_log("tilted");
  }

  void listen() {
    if (m_window.keys().back) m_quit = true;
    if (ImGui::GetIO().WantTextInput) return;
    for (const TypedKey& k : m_window.typed()) {
      if (k.key == GLFW_KEY_W) tilt(kTiltStep, 0);
      if (k.key == GLFW_KEY_S) tilt(-kTiltStep, 0);
      if (k.key == GLFW_KEY_A) tilt(0, kTiltStep);
      if (k.key == GLFW_KEY_D) tilt(0, -kTiltStep);
      if (k.key == GLFW_KEY_SPACE) m_plays = !m_plays && m_motion.has_value();
      if (k.key == GLFW_KEY_R) m_shows_reach = !m_shows_reach, m_stale = true;
      if (k.key == GLFW_KEY_C) m_shows_gaps = !m_shows_gaps, m_stale = true;
      const std::vector<RoomView> views = room_views();
      if (k.key >= GLFW_KEY_1 && k.key < GLFW_KEY_1 + int(views.size()))
        m_orbit = views[std::size_t(k.key - GLFW_KEY_1)].orbit, m_redraw = true;
    }
  }

  std::optional<modeller::Spot> spot(Vec3d in_patient) const {
    const Vec3d p = m_model->table_frame(m_pose.tilt) * in_patient;
    return modeller::spot_of(m_camera, int(m_area.width), int(m_area.height), p);
  }

  /// The place on the abdomen under the pointer.
  std::optional<Vec3d> skin_at(float x, float y) const {
    const kinematics::Frame back = kinematics::inverse(m_model->table_frame(m_pose.tilt));
    const Vec3d eye = back * m_orbit.eye();
    const Vec3d way = back.r * modeller::ray_through(m_camera, int(m_area.width), int(m_area.height), {x, y});
    for (double s = 0.05; s < 6; s += 0.004) {
      const Vec3d p = eye + s * way;
      if (p.y > m_model->figure().low() && p.y < m_model->figure().high() && p.z <= m_model->figure().front(p.x, p.y) &&
          m_model->figure().trunk_distance(p) <= 0.002)
        return Vec3d{p.x, p.y, m_model->figure().front(p.x, p.y)};
    }
    return std::nullopt;
  }

  void point() {
    const ImGuiIO& io = ImGui::GetIO();
    if (m_drags && io.MouseDown[0]) {
      if (const std::optional<Vec3d> at = skin_at(io.MousePos.x, io.MousePos.y);
          at && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) {
        m_room.ports[std::size_t(m_port)].position = *at;
        m_moved = true;
        m_stale = true;
      }
      return;
    }
    if (m_drags) {
      m_drags = false;
      if (m_moved) rebuild(), tell_log("port");
      m_moved = false;
      return;
    }
    if (io.WantCaptureMouse || !m_area.holds(io.MousePos.x, io.MousePos.y)) return;
    if (io.MouseClicked[0]) {
      m_port = -1;
      for (std::size_t k = 0; k < m_room.ports.size(); ++k)
        if (const auto s = spot(m_room.ports[k].position);
            s && std::hypot(s->x - io.MousePos.x, s->y - io.MousePos.y) < kPortReach * m_window.scale())
          m_port = int(k), m_drags = true;
      if (m_drags) tell_log("held");
      m_stale = true;
    }
    const bool pans = io.MouseDown[2] || (io.MouseDown[1] && io.KeyShift);
    const bool turns = !pans && (io.MouseDown[1] || (io.MouseDown[0] && !m_drags));
    if (pans)
      m_orbit.pan(-0.0011 * m_orbit.distance * double(io.MouseDelta.x),
                  0.0011 * m_orbit.distance * double(io.MouseDelta.y));
    if (turns) m_orbit.turn(-0.006 * double(io.MouseDelta.x), 0.006 * double(io.MouseDelta.y));
    if (io.MouseWheel != 0) m_orbit.zoom(std::exp(-0.12 * double(io.MouseWheel)));
    m_redraw = m_redraw || pans || turns || io.MouseWheel != 0;
  }

  void play() {
    if (!m_plays || !m_motion) return;
    const double before = m_time;
    m_time += m_window.picture_time();
    if (m_time > m_motion->length) m_time = 0;
    show_time();
    if (std::floor(before) != std::floor(m_time)) tell_log("played");
  }

  void draw() {
    if (m_stale) m_drawing->move(scenery());
    if (m_stale || m_redraw || m_drawn_width != m_area.width) {
      render::Frame frame = m_drawing->frame(m_orbit);
      m_camera = frame.camera;
      render::draw_frame(*m_backend, frame, m_canvas.target(int(m_area.width), int(m_area.height)));
    }
    m_stale = m_redraw = false;
    m_drawn_width = m_area.width;
    m_canvas.lay(window_target(m_area, m_window.height()));
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    for (const scene::RoomPort& p : m_room.ports)
      if (const auto s = spot(p.position)) {
        list.AddCircle({s->x, s->y}, 7 * m_window.scale(), IM_COL32(20, 40, 60, 230), 24, 2);
        list.AddText({s->x + 10, s->y - 8}, IM_COL32(20, 40, 60, 255), p.name.c_str());
      }
  }

  void draw_panel() {
    ImGui::SetNextWindowPos({m_area.width, 0});
    ImGui::SetNextWindowSize({float(m_window.width()) - m_area.width, float(m_window.height())});
    ImGui::Begin("room", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
    ui::title(m_room.title.empty() ? m_room.name : m_room.title);
    ui::heading("Table");
    double head = m_pose.tilt.head_down / kDegree, left = m_pose.tilt.left_down / kDegree;
    const scene::RoomTable& t = m_room.table;
    if (ui::slider("head down", head, -t.head_up_most / kDegree, t.head_down_most / kDegree, "%.0f deg", false))
      tilt(head * kDegree - m_pose.tilt.head_down, 0);
    if (ui::slider("left down", left, -t.side_most / kDegree, t.side_most / kDegree, "%.0f deg", false))
      tilt(0, left * kDegree - m_pose.tilt.left_down);
    const Vec3d g = m_model->gravity(m_pose.tilt);
    ui::text(tr("gravity in the patient {:.2f}, {:.2f}, {:.2f} m/s2", g.x, g.y, g.z), ui::kGrey);
    ui::heading("Arms and their ports");
    for (std::size_t a = 0; a < m_room.arms.size(); ++a) draw_arm(a);
    ui::heading("Shown");
    if (ui::checkbox("reach", m_shows_reach)) m_stale = true;
    ImGui::SameLine();
    if (ui::checkbox("clearance", m_shows_gaps)) m_stale = true;
    ui::heading(tr("Clearance (margin {:.0f} mm)", 1e3 * m_room.margin));
    for (std::size_t k = 0; k < std::min<std::size_t>(6, m_near.size()); ++k) {
      const Near& n = m_near[k];
      const bool bad = n.distance < m_room.margin;
      if (bad) ui::mark(ui::Mark::error);
      ui::text(fmt::format("{:.0f} mm  {} - {}", 1e3 * n.distance, n.first, n.second), bad ? ui::kOrange : ui::kWhite);
    }
    if (m_motion) draw_programme();
    if (!m_said.empty()) ui::text(m_said, ui::kOrange);
    ui::heading("Keys");
    ui::text(
        "W S: head down, up   A D: left, right side down   drag: turn   middle drag: move   wheel: nearer   drag a "
        "port: "
        "move it   1-4: views   R, C: "
        "reach, clearance   space: play   Esc: close",
        ui::kGrey);
    ImGui::End();
  }

  void draw_arm(std::size_t a) {
    scene::RoomArm& arm = m_room.arms[a];
    const double gap = port_gap(m_model->shaft(m_pose, int(a)), m_model->arms()[a].port);
    if (ImGui::BeginCombo(arm.name.c_str(), arm.port.c_str())) {
      for (const scene::RoomPort& p : m_room.ports) {
        const bool taken = std::any_of(m_room.arms.begin(), m_room.arms.end(),
                                       [&](const scene::RoomArm& o) { return o.port == p.name; });
        if (!taken && ImGui::Selectable(p.name.c_str())) {
          arm.port = p.name;
          rebuild();
          tell_log("port");
        }
      }
      ImGui::EndCombo();
    }
    ui::note_widget(arm.name);
    if (gap > 1e-4) {
      ui::mark(ui::Mark::error);
      ui::text(tr("its shaft is {:.1f} mm beside its port: dock it again", 1e3 * gap), ui::kOrange);
    }
  }

  void draw_programme() {
    ui::heading("Programme");
    ui::text(m_programme.title.empty() ? m_programme.name : m_programme.title);
    double at = m_time;
    if (ui::slider("time", at, 0, m_motion->length, "%.2f s", false)) m_time = at, m_plays = false, show_time();
    if (ui::button(m_plays ? "Pause" : "Play")) m_plays = !m_plays;
    if (m_report.good()) {
      ui::mark(ui::Mark::done);
      ui::text(
          tr("can be done; least clearance {:.0f} mm at {:.1f} s", 1e3 * m_report.least_clearance, m_report.least_at));
    }
    for (std::size_t k = 0; k < std::min<std::size_t>(4, m_report.faults.size()); ++k) {
      const MotionFault& f = m_report.faults[k];
      ui::mark(ui::Mark::error);
      ui::text(fmt::format("{:.2f} s, {}: {}", f.from, word_of(f.kind), f.words), ui::kOrange);
    }
  }

  void picture() {
    m_window.set_picture_rate(m_plays || ImGui::IsAnyMouseDown() ? 60 : 30);
    m_window.begin_picture();
    const float panel = std::min(kPanelWidth * m_window.scale(), 0.45f * float(m_window.width()));
    m_area = {0, 0, std::max(64.0f, std::floor(float(m_window.width()) - panel)),
              std::max(64.0f, float(m_window.height()))};
    listen();
    play();
    point();
    draw();
    draw_panel();
    m_window.draw_panels();
    m_window.show();
    const std::vector<ui::Widget> widgets = ui::take_widgets();
    if (!m_log.on()) return;
    Json ports = Json::object();
    for (const scene::RoomPort& p : m_room.ports)
      if (const auto s = spot(p.position)) ports[p.name] = {int(s->x), int(s->y)};
    if (widgets == m_widgets && ports == m_told_ports) return;
    m_widgets = widgets;
    m_told_ports = ports;
    Json places = Json::object();
    for (const ui::Widget& w : widgets) places[w.id] = {w.x, w.y};
    m_log.event("screen", {{"name", "room"}, {"widgets", places}, {"ports", ports}});
  }

  Window& m_window;
  EventLog& m_log;
  scene::Room m_room;
  scene::Programme m_programme;
  std::unique_ptr<render::GlContext> m_context;
  std::unique_ptr<render::Backend> m_backend;
  std::unique_ptr<RoomModel> m_model;
  std::unique_ptr<view::RoomDrawing> m_drawing;
  PaneCanvas m_canvas;
  view::UprightOrbit m_orbit;
  render::Camera m_camera;
  Area m_area;
  RoomPose m_pose;
  std::vector<Near> m_near;
  std::optional<RoomMotion> m_motion;
  MotionReport m_report;
  std::vector<ui::Widget> m_widgets;
  Json m_told_ports;
  std::string m_said;
  double m_time = 0;
  float m_drawn_width = 0;
  int m_port = -1;
  bool m_plays = false, m_drags = false, m_moved = false, m_quit = false;
  bool m_shows_reach = false, m_shows_gaps = true, m_stale = true, m_redraw = true;
};

}  // namespace

void run_room_window(RoomWindowOptions options) {
  std::vector<core::Fault> ignored;
  const Settings settings = read_settings(settings_file(), ignored);
  Window window = open_window("Trocar: " + options.room.name, options.size,
                              "A room without a window: trocar room FILE pose --shots FOLDER");
  window.set_text_size(settings.text_size);
  EventLog log(EventLog::path_of(options.log));
  attempt::catch_interrupts();
  RoomWindow(window, std::move(options), log).run();
  if (!log.failure().empty()) throw core::EnvironmentLacks(log.failure());
}

}  // namespace trocar::app
