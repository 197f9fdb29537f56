// The player's window, in five files: it opens and goes from picture to picture (player.cpp), what people ask for
// (player_controls.cpp), the pictures of the scene (player_scene.cpp), films and saved pictures (player_film.cpp), and
// what it tells tests (player_log.cpp). Private to them.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>

#include <trocar/attempt/footage.hpp>
#include <trocar/attempt/playback/captions.hpp>
#include <trocar/pictures/camera_choice.hpp>
#include <trocar/pictures/film_plan.hpp>
#include <trocar/pictures/legend_drawing.hpp>
#include <trocar/render/backend/backend.hpp>
#include <trocar/render/frame/governor.hpp>
#include <trocar/render/gl/gl_context.hpp>

#include "player/player.hpp"
#include "player/player_bar.hpp"
#include "player/player_panel.hpp"
#include "shell/event_log.hpp"
#include "shell/panes.hpp"
#include "shell/second_window.hpp"
#include "shell/ui.hpp"
#include "shell/window.hpp"

namespace trocar::app {

/// What the scene's picture depends on: while it stays the same the picture is not drawn again, so that panel and
/// timeline answer at once on a machine that draws slowly.
struct Drawn {
  std::uint64_t tick = attempt::Reel::kNowhere;
  bool exact = false;
  std::vector<Panes::Pane> panes;
  PaneCameras cameras;
  std::vector<view::PartStyle> styles;
  render::Quality quality;

  friend bool operator==(const Drawn&, const Drawn&) = default;
};

/// A film that is being made, a picture at a time, as the reel gets there.
struct FilmJob {
  pictures::FilmPlan plan;
  view::ViewOptions view;
  pictures::PictureSize size;
  std::unique_ptr<pictures::Video> video;
  std::uint64_t next = 0;
  bool settled = false;  ///< has its exposure found what it will begin with?
};

class Player {
 public:
  /// @param options.eyes  as this window can show them
  Player(Window& window, render::Backend& backend, const attempt::Lesson& lesson, const sim::Recording& recording,
         const PlayerOptions& options, EventLog& log);

  /// Until it is left or closed, or the program shall end.
  PlayerEnd run();

 private:
  void picture();
  void lay_out();
  void draw_overlays();
  void draw_captions();

  void listen(PlayerCommands& commands);
  void read_pointer(PlayerCommands& commands);
  void obey(const PlayerCommands& commands);
  void obey_times(const PlayerCommands& commands);
  void obey_cameras(const PlayerCommands& commands);
  bool turn_camera(const PlayerCommands& commands);
  void seek(std::uint64_t tick);
  void play_on();

  const sim::State& state_to_show();
  void show_scene(const sim::State& state);
  void draw_scene(const sim::State& state, const render::Quality& quality, bool all);
  void show_elsewhere();
  void draw_other_eye();
  view::ViewOptions view_of_first(const render::Quality& quality) const;

  void save_picture(const sim::State& state);
  void start_film();
  void film_on();
  void end_film(const std::string& message);

  void log_widgets();
  void log_shown(const sim::State& state);
  void log_camera();

  std::uint64_t now() const { return std::uint64_t(m_now + 0.5); }
  bool overlay() const { return m_help || m_menu || m_display || m_views || m_film; }
  bool endoscope() const { return m_layout.panes[0] == PaneShows::endoscope; }

  using Clock = std::chrono::steady_clock;
  Window& m_window;
  const attempt::Lesson& m_lesson;
  const sim::Recording& m_recording;
  const PlayerOptions& m_options;
  EventLog& m_log;
  render::Backend& m_backend;
  view::SceneView m_view;
  render::Governor m_governor;
  Drawn m_drawn;
  std::optional<SecondWindow> m_second;
  PaneCanvas m_first, m_first_other;  ///< the first pane's picture, and the right eye's
  std::uint64_t m_picture_clock = 0;  ///< [ms] what the exposure goes by: a camera's own time, not the recording's
  attempt::Footage m_footage;
  attempt::Reel m_reel;
  attempt::Timeline m_line;
  const attempt::Captions m_captions;
  attempt::Caption m_caption;  ///< as shown
  attempt::Findings m_found;
  std::uint64_t m_found_version = 0;
  PadReader m_pad;

  double m_now = 0;  ///< [ticks]
  double m_speed = 1;
  bool m_playing = false, m_exact = false;
  bool m_help = false, m_menu = false, m_display = false, m_views = false, m_picture_wanted = false;
  bool m_show_captions = true, m_first_picture = true;
  std::optional<PlayerEnd> m_end;         ///< it is being left
  std::vector<view::PartStyle> m_styles;  ///< of the scene's parts
  int m_preset = 1;
  view::Orbit m_around;
  LayoutChoice m_layout{.layout = Layout::corner};
  Panes m_panes;
  PaneShows m_led = PaneShows::outside;  ///< what keys turn
  Area m_main, m_bar, m_panel;
  std::string m_message;
  std::unique_ptr<FilmJob> m_film;
  pictures::LegendPainter m_legend;  ///< of saved pictures and films
  std::vector<ui::Widget> m_widgets;
  std::string m_screen;
  std::uint64_t m_logged_tick = attempt::Reel::kNowhere;
  bool m_logged_exact = false, m_logged_playing = false;
  Clock::time_point m_asked_at = Clock::now();
};

}  // namespace trocar::app
