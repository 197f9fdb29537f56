#include "mechanisms/design_window.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <memory>
#include <optional>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <trocar/attempt/interrupt.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/text.hpp>
#include <trocar/modeller/picture/handles.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/render/gl/gl_context.hpp>
#include <trocar/scene/mechanisms/mechanism_file.hpp>
#include <trocar/studies/design_desk.hpp>
#include <trocar/studies/optimise.hpp>
#include <trocar/view/mechanisms/mechanism_drawing.hpp>

#include "shell/event_log.hpp"
#include "shell/open_window.hpp"
#include "shell/pane_canvas.hpp"
#include "shell/panes.hpp"
#include "shell/settings.hpp"
#include "shell/ui.hpp"

namespace trocar::app {
namespace {

using kinematics::Measure;
using kinematics::Parameter;
using studies::DesignDesk;
using studies::PairClearance;

constexpr float kDeskPanel = 400;  // [px]
constexpr double kSwing = 3;       // a drive's way and back, played [s]
constexpr view::painted::Colour kMeets{226, 84, 40}, kNear{240, 190, 60};
constexpr std::size_t kShownPairs = 5;

double per_file(Measure measure) {
  return measure == Measure::angle ? 180 / portable::pi : measure == Measure::length ? 1e3 : 1;
}
const char* unit_word(Measure measure) {
  return measure == Measure::angle ? " deg" : measure == Measure::length ? " mm" : "";
}

class DesignWindow {
 public:
  DesignWindow(Window& window, const DesignWindowOptions& options, EventLog& log)
      : m_window(window),
        m_options(options),
        m_log(log),
        m_context(render::GlContext::adopt_current()),
        m_backend(render::make_gl_backend(*m_context)),
        m_desk(options.description),
        m_drawing(*m_backend, m_desk.mechanism(), m_desk.pose()),
        m_orbit(m_drawing.about_joints(m_desk.mechanism(), m_desk.pose())),
        m_frame(std::max(0, m_desk.mechanism().frame(options.frame))) {
    std::filesystem::path proposed = options.file.filename();
    proposed.replace_filename(proposed.stem().string() + "_changed.json");
    const std::string text = proposed.string();
    text.copy(m_path, sizeof m_path - 1);
    stand(true);
  }

  void run() {
    while (!m_window.wants_to_close() && !m_quit && !attempt::interrupted()) picture();
  }

 private:
  const kinematics::Mechanism& mechanism() const { return m_desk.mechanism(); }
  std::string name_of(const PairClearance& pair) const {
    return mechanism().links[std::size_t(pair.first)] + " - " + mechanism().links[std::size_t(pair.second)];
  }
  void picture();
  void stand(bool other_shapes);
  void listen();
  void point();
  void play();
  void look_after_optimiser();
  void draw();
  void draw_path();
  void draw_desk();
  void draw_leads();
  void draw_dials();
  void draw_steps();
  void draw_clearance();
  void draw_saving();
  void save();
  void tell();

  Window& m_window;
  const DesignWindowOptions& m_options;
  EventLog& m_log;
  std::unique_ptr<render::GlContext> m_context;
  std::unique_ptr<render::Backend> m_backend;
  DesignDesk m_desk;
  view::MechanismDrawing m_drawing;
  view::UprightOrbit m_orbit;
  PaneCanvas m_canvas;
  render::Camera m_camera;
  Area m_area;
  std::vector<Vec3d> m_path_drawn;
  std::future<studies::OptimiseResult> m_search;
  std::vector<ui::Widget> m_widgets;
  std::string m_said, m_saved, m_logged;
  char m_path[512] = {};
  int m_frame = 0;
  double m_phase = 0;
  float m_drawn_width = 0;
  bool m_plays = false, m_quit = false, m_redraw = true;
};

/// After a drive or a dimension has been changed.
void DesignWindow::stand(bool other_shapes) {
  std::vector<std::pair<int, view::painted::Colour>> marked;
  if (const auto& clearance = m_desk.clearance())
    for (const PairClearance& pair : clearance->pairs) {
      const double gap = m_desk.gap_now(pair);
      if (gap >= m_options.clearance) continue;
      for (const int link : {pair.first, pair.second}) marked.emplace_back(link, gap < 0 ? kMeets : kNear);
    }
  m_drawing.stand_out(std::move(marked));
  m_drawing.shape(mechanism());
  m_drawing.move(m_desk.pose());
  if (other_shapes || m_desk.leads().size() > 1) m_path_drawn = m_desk.path(m_frame);
  m_redraw = true;
}

void DesignWindow::listen() {
  if (m_window.keys().back) m_quit = true;
  if (ImGui::GetIO().WantTextInput) return;
  for (const TypedKey& k : m_window.typed()) {
    const bool control = (k.mods & GLFW_MOD_CONTROL) != 0;
    if (control && k.key == GLFW_KEY_Z) m_desk.undo(), stand(true);
    if (control && k.key == GLFW_KEY_Y) m_desk.redo(), stand(true);
    if (control && k.key == GLFW_KEY_S) save();
    if (k.key == GLFW_KEY_SPACE) m_plays = !m_plays && !m_desk.leads().empty();
    if (k.key == GLFW_KEY_HOME) {
      const bool near = m_orbit.distance < m_drawing.whole().distance;
      m_orbit = near ? m_drawing.whole() : m_drawing.about_joints(mechanism(), m_desk.pose());
      m_redraw = true;
    }
  }
}

void DesignWindow::point() {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantCaptureMouse || !m_area.holds(io.MousePos.x, io.MousePos.y)) return;
  const bool pans = io.MouseDown[2] || ((io.MouseDown[0] || io.MouseDown[1]) && io.KeyShift);
  const bool turns = !pans && (io.MouseDown[0] || io.MouseDown[1]);
  if (pans)
    m_orbit.pan(-0.0011 * m_orbit.distance * double(io.MouseDelta.x),
                0.0011 * m_orbit.distance * double(io.MouseDelta.y));
  if (turns) m_orbit.turn(-0.006 * double(io.MouseDelta.x), 0.006 * double(io.MouseDelta.y));
  if (io.MouseWheel != 0) m_orbit.zoom(std::exp(-0.12 * double(io.MouseWheel)));
  m_redraw = m_redraw || pans || turns || io.MouseWheel != 0;
}

void DesignWindow::play() {
  if (!m_plays) return;
  m_phase = std::fmod(m_phase + m_window.picture_time() / kSwing, 1.0);
  m_desk.lead(0, 0.5 - 0.5 * std::cos(portable::two_pi * m_phase));
  stand(false);
}

void DesignWindow::look_after_optimiser() {
  if (!m_search.valid() || m_search.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  try {
    const studies::OptimiseResult r = m_search.get();
    m_desk.put(r.values);
    m_said = r.free ? "optimised: free over the whole motion" : "no dimensions found that do all that was asked";
    m_log.event("optimised", {{"free", r.free}, {"tried", r.evaluations}});
  } catch (const std::exception& fault) {
    m_said = fault.what();
  }
  stand(true);
}

void DesignWindow::draw() {
  if (m_redraw || m_drawn_width != m_area.width) {
    const render::Frame frame = m_drawing.frame(m_orbit);
    m_camera = frame.camera;
    render::draw_frame(*m_backend, frame, m_canvas.target(int(m_area.width), int(m_area.height)));
  }
  m_redraw = false;
  m_drawn_width = m_area.width;
  m_canvas.lay(window_target(m_area, m_window.height()));
  draw_path();
}

/// The way of the frame, with where it is now.
void DesignWindow::draw_path() {
  if (mechanism().frames.empty()) return;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto spot = [this](Vec3d p) {
    return modeller::spot_of(m_camera, int(m_area.width), int(m_area.height), m_drawing.drawn(p));
  };
  for (std::size_t i = 1; i < m_path_drawn.size(); ++i) {
    const auto a = spot(m_path_drawn[i - 1]), b = spot(m_path_drawn[i]);
    if (a && b) list.AddLine({a->x, a->y}, {b->x, b->y}, IM_COL32(40, 60, 90, 200), 2 * m_window.scale());
  }
  const auto name = mechanism().frame_names[std::size_t(m_frame)];
  if (const auto at = spot(kinematics::place(mechanism().frames[std::size_t(m_frame)], m_desk.pose()).p)) {
    list.AddCircleFilled({at->x, at->y}, 4 * m_window.scale(), IM_COL32(20, 40, 70, 255));
    list.AddText({at->x + 8, at->y - 8}, IM_COL32(20, 40, 70, 255), name.c_str());
  }
}

void DesignWindow::draw_leads() {
  ui::heading("Motion");
  for (std::size_t i = 0; i < m_desk.leads().size(); ++i) {
    double handle = m_desk.handle(i);
    if (ui::slider(m_desk.leads()[i].name, handle, 0, 1, "%.3f", false)) {
      m_plays = false;
      m_desk.lead(i, handle);
      stand(false);
    }
  }
  if (!m_desk.leads().empty() && ui::button(m_plays ? "Pause (space)" : "Play (space)", {.width = 150}))
    m_plays = !m_plays;
  if (mechanism().frames.size() > 1) {
    ImGui::SameLine();
    ImGui::SetNextItemWidth(150 * ui::scale());
    if (ImGui::BeginCombo("way of", mechanism().frame_names[std::size_t(m_frame)].c_str())) {
      for (std::size_t f = 0; f < mechanism().frames.size(); ++f)
        if (ImGui::Selectable(mechanism().frame_names[f].c_str())) m_frame = int(f), stand(true);
      ImGui::EndCombo();
    }
  }
  ui::mark(m_desk.closed() ? ui::Mark::done : ui::Mark::error);
  ui::text(m_desk.words(), m_desk.closed() ? ui::kGrey : ui::kOrange);
}

void DesignWindow::draw_dials() {
  ui::heading("Dimensions");
  if (m_desk.dials().empty()) ui::text("none of this mechanism's dimensions has a name", ui::kGrey);
  for (const DesignDesk::Dial& dial : m_desk.dials()) {
    const Parameter& p = mechanism().parameters[std::size_t(dial.parameter)];
    const double unit = per_file(p.measure);
    double value = m_desk.value(dial) * unit;
    const std::string format = std::string("%.3f") + unit_word(p.measure);
    if (ui::slider(p.name, value, dial.low * unit, dial.high * unit, format.c_str(), false)) {
      m_desk.turn(dial, value / unit);
      stand(true);
    }
    if (ImGui::IsItemDeactivatedAfterEdit()) {
      m_desk.keep();
      m_log.event("turned", {{"name", p.name}, {"value", m_desk.value(dial) * unit}});
    }
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("%s", (dial.bounded ? tr("{}: {:.3f}{} in the file", p.name, m_desk.value_in_file(dial) * unit,
                                                 unit_word(p.measure))
                                            : tr("{}: {:.3f}{} in the file; no bounds there", p.name,
                                                 m_desk.value_in_file(dial) * unit, unit_word(p.measure)))
                                  .c_str());
  }
}

void DesignWindow::draw_steps() {
  if (ui::button("Undo", {.width = 65, .enabled = m_desk.can_undo()})) m_desk.undo(), stand(true);
  ImGui::SameLine();
  if (ui::button("Redo", {.width = 65, .enabled = m_desk.can_redo()})) m_desk.redo(), stand(true);
  ImGui::SameLine();
  if (ui::button("As in the file", {.width = 115, .enabled = m_desk.changed()})) m_desk.reset(), stand(true);
  ImGui::SameLine();
  const bool can = std::any_of(m_desk.dials().begin(), m_desk.dials().end(), [](const auto& d) { return d.bounded; });
  if (m_search.valid()) {
    ui::text("looking for dimensions ...", ui::kGrey);
  } else if (ui::button("Optimise",
                        {.width = 90, .enabled = can, .tip = "changes the dimensions that have bounds in the file"})) {
    const studies::OptimiseOptions wish{.clearance = m_options.clearance, .follow = m_frame};
    m_search = std::async(std::launch::async, [m = mechanism(), wish] { return studies::optimise(m, wish); });
    m_said.clear();
  }
}

void DesignWindow::draw_clearance() {
  ui::heading("Own links over the whole motion");
  const auto& clearance = m_desk.clearance();
  if (!clearance || clearance->pairs.empty()) {
    ui::text(m_desk.closed() ? "no two links that could meet" : "it does not close", ui::kGrey);
    return;
  }
  for (std::size_t k = 0; k < std::min(kShownPairs, clearance->pairs.size()); ++k) {
    const PairClearance& pair = clearance->pairs[k];
    const bool meets = pair.least < 0, near = pair.least < m_options.clearance;
    ui::mark(meets ? ui::Mark::error : near ? ui::Mark::warning : ui::Mark::done);
    ui::text(fmt::format("{:+.3f} mm  {}  (now {:+.3f})", 1e3 * pair.least, name_of(pair), 1e3 * m_desk.gap_now(pair)),
             meets ? ui::kOrange : ui::kWhite);
  }
  const PairClearance& nearest = clearance->pairs.front();
  if (nearest.curve.size() > 1) {
    std::vector<float> curve;
    for (const double gap : nearest.curve) curve.push_back(std::isfinite(gap) ? float(1e3 * gap) : 0.0f);
    ImGui::PlotLines("##gap", curve.data(), int(curve.size()), 0, "mm along the first drive", FLT_MAX, FLT_MAX,
                     {ImGui::GetContentRegionAvail().x, 70 * ui::scale()});
  }
}

void DesignWindow::draw_saving() {
  ui::heading("File");
  if (m_options.file.extension() != ".json") {
    ui::text("only JSON can be written", ui::kGrey);
    return;
  }
  ImGui::SetNextItemWidth(-110 * ui::scale());
  ImGui::InputText("##path", m_path, sizeof m_path);
  ImGui::SameLine();
  if (ui::button("Save", {.width = 90, .enabled = m_path[0] != 0})) save();
  if (!m_saved.empty()) ui::text(m_saved, ui::kGrey);
}

void DesignWindow::save() {
  try {
    const std::string text = core::read_file(m_options.file, scene::kMaxJsonBytes);
    const std::string changed = scene::mechanism_text_with(text, m_desk.values());
    const std::string fault = core::write_file(m_path, changed.data(), changed.size());
    m_saved = fault.empty() ? fmt::format("saved: {}", m_path) : fmt::format("{}: {}", m_path, fault);
    m_log.event("saved", {{"file", m_path}, {"written", fault.empty()}});
  } catch (const std::exception& fault) {
    m_saved = fault.what();
  }
}

void DesignWindow::draw_desk() {
  ImGui::SetNextWindowPos({m_area.width, 0});
  ImGui::SetNextWindowSize({float(m_window.width()) - m_area.width, float(m_window.height())});
  ImGui::Begin("desk", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
  ui::title(m_options.description.name);
  const float rest = ImGui::GetContentRegionAvail().y - 150 * ui::scale();
  ImGui::BeginChild("all", {0, rest}, false, ImGuiWindowFlags_NavFlattened);
  draw_leads();
  draw_dials();
  draw_steps();
  draw_clearance();
  if (!m_said.empty()) ui::text(m_said, ui::kBlue);
  ImGui::EndChild();
  draw_saving();
  ui::text(
      "drag: turn   shift: move   wheel: nearer   Home: joints, all of it   space: play   Ctrl+Z, Y: undo, redo   "
      "Ctrl+S: save "
      "  Esc: close",
      ui::kGrey);
  ImGui::End();
}

/// For tests that drive the window.
void DesignWindow::tell() {
  const std::vector<ui::Widget> widgets = ui::take_widgets();
  if (!m_log.on() || m_search.valid()) return;
  Json places = Json::object(), dials = Json::object();
  for (const ui::Widget& w : widgets) places[w.id] = {w.x, w.y};
  for (const DesignDesk::Dial& d : m_desk.dials()) {
    const Parameter& p = mechanism().parameters[std::size_t(d.parameter)];
    dials[p.name] = m_desk.value(d) * per_file(p.measure);
  }
  const auto& clearance = m_desk.clearance();
  const Json line{{"name", "design"},
                  {"widgets", places},
                  {"dials", dials},
                  {"closed", m_desk.closed()},
                  {"least_mm", clearance ? Json(1e3 * clearance->least) : Json(nullptr)}};
  if (std::string text = line.dump(); text != m_logged) m_logged = std::move(text), m_log.event("screen", line);
}

void DesignWindow::picture() {
  m_window.set_picture_rate(m_plays || ImGui::IsAnyMouseDown() ? 60 : 30);
  m_window.begin_picture();
  const float panel = std::min(kDeskPanel * m_window.scale(), 0.5f * float(m_window.width()));
  m_area = {0, 0, std::max(64.0f, std::floor(float(m_window.width()) - panel)),
            std::max(64.0f, float(m_window.height()))};
  listen();
  look_after_optimiser();
  play();
  point();
  draw();
  draw_desk();
  m_window.draw_panels();
  m_window.show();
  tell();
}

}  // namespace

void run_design_window(DesignWindowOptions options) {
  std::vector<core::Fault> ignored;
  const Settings settings = read_settings(settings_file(), ignored);
  Window window = open_window("Trocar: " + options.description.name, options.size,
                              "A mechanism without a window: trocar mechanism FILE pose, clearance, optimise");
  window.set_text_size(settings.text_size);
  EventLog log(EventLog::path_of(options.log));
  attempt::catch_interrupts();
  DesignWindow(window, options, log).run();
  if (!log.failure().empty()) throw core::EnvironmentLacks(log.failure());
}

}  // namespace trocar::app
