// Everything that lives as long as the window: context, settings, sound, log, store, the view of the scene that is
// there; and what every screen does the same way: begin a picture, show help and settings over it, end it.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include <trocar/render/backend/backend.hpp>
#include <trocar/render/frame/governor.hpp>
#include <trocar/render/gl/gl_context.hpp>
#include <trocar/view/scene/scene_view.hpp>

#include "rooms/room_beside.hpp"
#include "shell/event_log.hpp"
#include "shell/second_window.hpp"
#include "shell/settings.hpp"
#include "shell/sound.hpp"
#include "shell/window.hpp"
#include "trainer/guidance.hpp"
#include "trainer/report_opener.hpp"
#include "trainer/window_loop.hpp"

namespace trocar::app {

class TrainerWindow {
 public:
  explicit TrainerWindow(const WindowOptions& options);
  ~TrainerWindow();  ///< keeps the window's size
  TrainerWindow(const TrainerWindow&) = delete;
  TrainerWindow& operator=(const TrainerWindow&) = delete;

  const WindowOptions& options;
  std::vector<core::Fault> setting_faults;
  Settings settings;
  Window window;
  std::unique_ptr<render::GlContext> context;
  std::unique_ptr<render::Backend> backend;
  render::Governor governor;
  EventLog log;
  Sound sound;
  ReportOpener reports;
  std::unique_ptr<RoomBeside> room;  ///< null: none is shown
  Equipment equipment;               ///< of which help speaks: of everything, or of the exercise that runs
  bool gamepad_in_use = false;       ///< help begins with its page

  bool wants_to_close() const;
  /// The view of this lesson's scene; made again where it is another lesson than last time.
  view::SceneView& view_of(const attempt::Lesson& lesson);
  void drop_view();  ///< the lesson is about to go

  /// Help and settings, over whatever is there.
  enum class Overlay { none, help, settings };
  void open(Overlay overlay);
  Overlay overlay() const { return m_overlay; }

  /// What the settings say, as far as this window can show it.
  pictures::TwoEyes eyes() const;
  /// The frame, in a part of the window; for two eyes, if that is set. @param through_scope  may be mirrored
  /// @param over  lays over it what belongs there, once for each eye
  void draw_scene(const render::Frame& frame, const render::Target& part, bool through_scope = true,
                  std::function<void()> over = {});

  /// The second window, open as `choice` wants it, with its picture: of the canvas, or, where that is null, of what was
  /// in the first pane. Where somebody closed it `choice` says so.
  void show_elsewhere(LayoutChoice& choice, const PaneCanvas* canvas, const view::Legend& legend);
  pictures::PictureSize size_elsewhere() const;
  PaneCanvas first_pane;  ///< a copy, kept while the second window shows it
  void close_elsewhere() { m_second.reset(); }

  void begin_picture(bool hands);  ///< hands: the pointer is the instrument's
  /// Overlays, ImGui, F12, the finished picture. `name` of the screen is for the log.
  void end_picture(const std::string& name, const std::filesystem::path& pictures);

  void apply_settings();
  void keep_settings();  ///< writes the file; a fault is told once on stderr

 private:
  void draw_overlay();
  void draw_eye(const render::Frame& frame);
  void draw_other_eye();
  void log_widgets(const std::string& screen);
  void save_picture(const std::filesystem::path& stem);

  std::unique_ptr<view::SceneView> m_view;
  const attempt::Lesson* m_viewed = nullptr;
  Overlay m_overlay = Overlay::none;
  HelpPage m_help;
  std::optional<SecondWindow> m_second;
  Settings m_before;
  std::string m_logged;
  std::optional<render::Frame> m_other_eye;  ///< to be drawn before the picture is shown
  render::Target m_scene_part;
  bool m_scene_mirrored = false;
  std::function<void()> m_over_scene;
  int m_pictures = 0;
  bool m_told_fault = false;
};

}  // namespace trocar::app
