#include "player/player.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <iterator>

#include <fmt/format.h>
#include <imgui.h>

#include <trocar/attempt/interrupt.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>

#include "player/player_parts.hpp"
#include "shell/display_panel.hpp"
#include "shell/layout_panel.hpp"
#include "shell/settings.hpp"

namespace trocar::app {

namespace fs = std::filesystem;

namespace {

constexpr double kPlayingRate = 62, kRestingRate = 25;  // [pictures/s] at most

bool draws_on_processors() { return render::GlContext::adopt_current()->draws_on_processors(); }

training::Steps steps_of(const attempt::Lesson& lesson) {
  const std::unique_ptr<training::Monitor> monitor = lesson.monitor();
  return monitor ? monitor->steps() : training::Steps();
}

Window open_window(const PlayerOptions& options) {
  try {
    return Window("Trocar: " + fs::path(options.file).filename().string(), options.size,
                  options.eyes.mode == render::StereoMode::quad_buffer);
  } catch (const core::EnvironmentLacks& lacks) {
    throw core::EnvironmentLacks(
        tr("{}\nWithout a window: trocar replay {} with --shots DIR, --video FILE, --verify or --headless",
           lacks.what(), options.file));
  }
}

}  // namespace

Player::Player(Window& window, render::Backend& backend, const attempt::Lesson& lesson, const sim::Recording& recording,
               const PlayerOptions& options, EventLog& log)
    : m_window(window),
      m_lesson(lesson),
      m_recording(recording),
      m_options(options),
      m_log(log),
      m_backend(backend),
      m_view(lesson.model, m_backend),
      m_governor(render::Governor::Limits{}, render::first_level(draws_on_processors())),
      m_footage(lesson.model, recording.keyframes),
      m_reel(lesson, recording, attempt::Reel::Options{}),
      m_line(m_reel.last()),
      m_captions(recording.result_json, steps_of(lesson)),
      m_around(view::orbit_around(lesson.model)),
      m_panes(lesson.model) {
  if (lesson.model.wet.there || !lesson.model.cuttables.empty()) m_backend.prepare_liquids();
  m_playing = options.inside;
}

PlayerEnd Player::run() {
  log_camera();
  while (!m_window.wants_to_close() && !m_end && !attempt::interrupted()) picture();
  return m_end.value_or(PlayerEnd::closed);
}

void Player::lay_out() {
  const float scale = m_window.scale(), width = float(m_window.width()), height = float(m_window.height());
  const float panel = std::floor(std::min(kPlayerPanelWidth * scale, 0.5f * width));
  const float bar = std::floor(std::min(bar_height(width - panel, scale), 0.5f * height));
  m_main = {0, 0, std::max(1.0f, width - panel), std::max(1.0f, height - bar)};
  m_panel = {m_main.width, 0, panel, height};
  m_bar = {0, m_main.height, m_main.width, bar};
  m_panes.lay_out(
      m_layout, m_main, scale,
      m_second ? pictures::PictureSize{m_second->width(), m_second->height()} : pictures::PictureSize{0, 0});
  m_governor.load_becomes(m_panes.load());
}

void Player::draw_captions() {
  if (!m_show_captions || overlay()) return;
  const attempt::Caption caption = m_captions.at(now());
  draw_caption(caption, m_options.note, m_panes.first().area);
  if (caption == m_caption) return;
  m_caption = caption;
  m_log.event("caption", {{"tick", now()}, {"step", caption.step}, {"hint", caption.hint}, {"doing", caption.doing}});
}

void Player::draw_overlays() {
  if (m_film) {
    const double share = double(m_film->next) / double(m_film->plan.pictures());
    if (!draw_film_progress(m_film->video->path(), share) || m_window.keys().back)
      end_film(tr("Video export cancelled."));
    return;
  }
  if (m_menu) {
    const PlayerChoice choice = draw_player_menu(m_options);
    if (choice != PlayerChoice::none) m_menu = false;
    if (choice == PlayerChoice::film) start_film();
    if (choice == PlayerChoice::display) m_display = true;
    if (choice == PlayerChoice::views) m_views = true;
    if (choice == PlayerChoice::help) m_help = true;
    if (choice == PlayerChoice::quit) m_end = m_options.inside ? PlayerEnd::back : PlayerEnd::closed;
    if (choice == PlayerChoice::now_you) m_end = PlayerEnd::now_you;
    if (choice == PlayerChoice::picture) m_picture_wanted = true;
  }
  if (m_display && draw_display(m_view.parts(), m_styles)) m_display = false;
  if (m_views && draw_layout_panel(m_layout, m_panes)) m_views = false;
  if (m_help) draw_player_help();
}

void Player::picture() {
  m_window.set_picture_rate(m_playing || m_panes.dragging() ? kPlayingRate : kRestingRate);
  m_window.draw_pointer(m_options.eyes.on());
  m_window.begin_picture();
  lay_out();
  m_reel.findings(m_found_version, m_found);
  PlayerCommands commands;
  listen(commands);
  std::uint64_t wanted = now();
  draw_bar({m_found, now(), m_reel.known_until(), m_reel.differs_from(), m_playing, endoscope(),
            m_layout.layout != Layout::one, m_speed, m_show_captions, m_options.inside, m_options.now_you},
           m_line, m_bar.width, m_bar.y, m_bar.height, commands, wanted);
  if (m_film) {
    film_on();
  } else {
    if (wanted != now()) {
      m_playing = false;
      seek(wanted);
    }
    obey(commands);
    play_on();
    m_line.follow(m_now);
  }
  const sim::State& state = m_film ? m_reel.exact() : state_to_show();
  if (!m_film) {
    show_scene(state);
    show_elsewhere();
    m_panes.write_over(true);
    draw_captions();
  }
  draw_player_panel(
      {m_lesson, m_recording, m_found, state, now(), m_line.last(), m_reel.known_until(), m_reel.replays(), m_exact,
       m_reel.complete(), now() >= m_reel.differs_from(), m_reel.way_to_go(), m_message},
      m_panel.x, m_panel.width, m_panel.height);
  draw_overlays();
  if (m_picture_wanted && !m_film) save_picture(state);
  m_window.draw_panels();
  if (m_options.eyes.on()) draw_other_eye();
  m_window.show();
  log_widgets();
  if (!m_film) log_shown(state);
}

PlayerEnd play_inside(Window& window, render::Backend& backend, const attempt::Lesson& lesson,
                      const sim::Recording& recording, PlayerOptions options, EventLog& log) {
  options.inside = true;
  ui::set_middle(0);
  window.capture_pointer(false);
  return Player(window, backend, lesson, recording, options, log).run();
}

namespace {

using LoadingLesson = std::future<std::unique_ptr<attempt::Lesson>>;

/// Shows that the scene is read and compiled until it is. Null: the window was closed.
std::unique_ptr<attempt::Lesson> wait_for(LoadingLesson& lesson, Window& window) {
  while (lesson.wait_for(std::chrono::milliseconds(10)) != std::future_status::ready) {
    if (window.wants_to_close() || attempt::interrupted()) return nullptr;  // the lesson may come, nobody waits for it
    window.begin_picture();
    draw_waiting(tr("Preparing the scene"), -1);
    window.draw_panels();
    window.show();
  }
  return lesson.get();
}

}  // namespace

void run_player(const sim::Recording& recording, PlayerOptions options) {
  LoadingLesson loading;  // outlives the window: that goes at once when it is closed early, whatever the thread does
  std::vector<core::Fault> ignored;  // told by the trainer's start screen, where they can be mended
  const Settings settings = read_settings(settings_file(), ignored);
  if (!options.eyes.on()) options.eyes = two_eyes(settings);
  Window window = open_window(options);
  if (options.eyes.mode == render::StereoMode::quad_buffer && !window.has_quad_buffers()) options.eyes.mode.reset();
  window.set_text_size(settings.text_size);
  EventLog log(EventLog::path_of(options.log));
  attempt::catch_interrupts();
  loading = std::async(std::launch::async, attempt::load_lesson, options.exercise, recording.header.seed);
  log.event("preparing", {{"exercise", options.exercise}});
  const std::unique_ptr<attempt::Lesson> lesson = wait_for(loading, window);
  if (!lesson) return;
  const std::unique_ptr<render::GlContext> context = render::GlContext::adopt_current();
  const std::unique_ptr<render::Backend> backend = render::make_gl_backend(*context);
  Player player(window, *backend, *lesson, recording, options, log);
  player.run();
  if (!log.failure().empty()) throw core::EnvironmentLacks(log.failure());
}

}  // namespace trocar::app
