#include "trainer/trainer_window.hpp"

#include <cstdlib>
#include <thread>

#include <fmt/format.h>

#include <trocar/attempt/interrupt.hpp>
#include <trocar/core/log.hpp>
#include <trocar/training/store/attempt.hpp>

#include "shell/mirror.hpp"
#include "shell/ui.hpp"
#include "trainer/start_screen.hpp"

namespace trocar::app {

namespace fs = std::filesystem;

namespace {

pictures::PictureSize first_size(const WindowOptions& options, const Settings& settings) {
  return options.size.value_or(pictures::PictureSize{settings.window_width, settings.window_height});
}

}  // namespace

TrainerWindow::TrainerWindow(const WindowOptions& o)
    : options(o),
      settings(read_settings(settings_file(), setting_faults)),
      window("Trocar", first_size(o, settings), two_eyes(settings).mode == render::StereoMode::quad_buffer),
      context(render::GlContext::adopt_current()),
      backend(render::make_gl_backend(*context)),
      governor({}, render::first_level(context->draws_on_processors())),
      log(EventLog::path_of(o.log)) {
  for (const core::Fault& f : setting_faults) core::log::warn("{}", core::to_string(f));
  if (!o.trainee.empty()) settings.trainee = training::clean_name(o.trainee);
  apply_settings();
  core::log::info("drawing with {}", context->description());
  if (!o.room.empty()) room = std::make_unique<RoomBeside>(window, *backend, o.room);
}

TrainerWindow::~TrainerWindow() {
  if (!options.size) {
    const pictures::PictureSize size = window.size_to_keep();
    settings.window_width = std::clamp(size.width, kLeastWidth, kMostPixels);
    settings.window_height = std::clamp(size.height, kLeastHeight, kMostPixels);
  }
  keep_settings();
}

bool TrainerWindow::wants_to_close() const { return window.wants_to_close() || attempt::interrupted(); }

view::SceneView& TrainerWindow::view_of(const attempt::Lesson& lesson) {
  if (m_viewed != &lesson) {
    m_view.reset();
    m_view = std::make_unique<view::SceneView>(lesson.model, *backend);
    if (lesson.model.wet.there || !lesson.model.cuttables.empty())
      backend->prepare_liquids();  // not when the first drop falls
    m_viewed = &lesson;
  }
  return *m_view;
}

void TrainerWindow::drop_view() {
  m_view.reset();
  m_viewed = nullptr;
}

void TrainerWindow::open(Overlay overlay) {
  if (overlay == Overlay::settings) m_before = settings;
  if (overlay == Overlay::help) m_help = {gamepad_in_use, settings.both_hands && equipment.hands > 1};
  m_overlay = overlay;
}

pictures::TwoEyes TrainerWindow::eyes() const {
  pictures::TwoEyes eyes = two_eyes(settings);
  if (eyes.mode == render::StereoMode::quad_buffer && !window.has_quad_buffers()) eyes.mode.reset();
  return eyes;
}

void TrainerWindow::draw_eye(const render::Frame& frame) {
  render::draw_frame(*backend, frame, m_scene_part);
  if (m_scene_mirrored) mirror(m_scene_part);
  if (m_over_scene) m_over_scene();
}

void TrainerWindow::draw_scene(const render::Frame& frame, const render::Target& part, bool through_scope,
                               std::function<void()> over) {
  m_scene_part = part;
  m_scene_mirrored = through_scope && settings.mirrored_picture;
  m_over_scene = std::move(over);
  pictures::TwoEyes two = eyes();
  if (!two.on()) return draw_eye(frame);
  if (m_scene_mirrored) two.swapped = !two.swapped;  // in a mirror depth is turned round, too
  render::StereoPair pair = pictures::eyes_of(two, frame);
  draw_eye(pair.left);
  m_other_eye = std::move(pair.right);
}

/// All of the window once more for the other eye, then both on one screen. Panels and menus lie on it.
void TrainerWindow::draw_other_eye() {
  const render::Target whole = render::Target::window(window.width(), window.height());
  backend->keep_eye(render::Eye::left, whole);
  if (m_other_eye) {
    draw_eye(*m_other_eye);
    window.draw_panels_again();
  }
  backend->keep_eye(render::Eye::right, whole);
  backend->combine(*eyes().mode, whole);
  m_other_eye.reset();
}

pictures::PictureSize TrainerWindow::size_elsewhere() const {
  return m_second ? pictures::PictureSize{m_second->width(), m_second->height()} : pictures::PictureSize{0, 0};
}

void TrainerWindow::show_elsewhere(LayoutChoice& choice, const PaneCanvas* canvas, const view::Legend& legend) {
  if (m_second && m_second->wants_to_close()) choice.elsewhere.reset();
  if (choice.elsewhere.has_value() != m_second.has_value())
    log.event("second-window", {{"open", choice.elsewhere.has_value()}});
  if (!choice.elsewhere) return m_second.reset();
  try {
    if (!m_second) m_second.emplace(window, "Trocar");
    m_second->show(canvas ? *canvas : first_pane, legend);
  } catch (const core::EnvironmentLacks& lacks) {
    core::log::warn("{}", lacks.what());
    choice.elsewhere.reset();
  }
}

void TrainerWindow::begin_picture(bool hands) {
  window.capture_pointer(hands);
  window.draw_pointer(eyes().on());
  window.begin_picture();
  if (window.keys().help) open(m_overlay == Overlay::help ? Overlay::none : Overlay::help);
}

void TrainerWindow::apply_settings() {
  window.set_text_size(settings.text_size);
  sound.set_volume(settings.volume);
}

void TrainerWindow::keep_settings() {
  try {
    write_settings(settings_file(), settings);
  } catch (const core::EnvironmentLacks& lacks) {
    if (!m_told_fault) core::log::warn("{}", lacks.what());
    m_told_fault = true;
  }
}

void TrainerWindow::draw_overlay() {
  if (m_overlay == Overlay::none) return;
  const bool back = window.keys().back;
  if (m_overlay == Overlay::help) {
    const Choice choice = draw_help(equipment, settings.left_handed, m_help);
    if (choice != Choice::none || back) m_overlay = Overlay::none;
    return;
  }
  const bool closed = draw_settings(settings, m_before, sound.audible(), window.has_quad_buffers());
  apply_settings();
  if (!closed && !back) return;
  keep_settings();
  m_overlay = Overlay::none;
}

void TrainerWindow::end_picture(const std::string& name, const fs::path& pictures) {
  if (m_overlay != Overlay::none) static_cast<void>(ui::take_widgets());  // what lies under it cannot be reached
  const std::string shown = m_overlay == Overlay::help ? "help" : m_overlay == Overlay::settings ? "settings" : name;
  draw_overlay();
  if (const std::string page = reports.poll(); !page.empty()) log.event("report", {{"file", page}});
  window.draw_panels();
  if (eyes().on()) draw_other_eye();
  log_widgets(shown);
  if (window.keys().picture) save_picture(pictures);
  window.show();
}

/// What an eye would find on the screen: told when it has changed.
void TrainerWindow::log_widgets(const std::string& screen) {
  const std::vector<ui::Widget> widgets = ui::take_widgets();
  if (!log.on()) return;
  Json list = Json::object();
  std::string focus;
  for (const ui::Widget& w : widgets) {
    list[w.id] = {w.x, w.y};
    if (w.focus) focus = w.id;
  }
  const Json line{{"name", screen}, {"widgets", list}, {"focus", focus}};
  if (std::string text = line.dump(-1, ' ', false, Json::error_handler_t::replace); text != m_logged) {
    m_logged = std::move(text);
    log.event("screen", line);
  }
}

void TrainerWindow::save_picture(const fs::path& stem) {
  fs::path file = stem;
  file.replace_extension(fmt::format("{:03}.png", m_pictures++));
  try {
    render::write_png(file.string(), window.read_back());
    core::log::info("saved {}", file.string());
    log.event("picture", {{"file", file.string()}});
  } catch (const core::EnvironmentLacks& lacks) {
    core::log::warn("{}", lacks.what());
  }
}

}  // namespace trocar::app
