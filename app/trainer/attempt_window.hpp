// One attempt in the window, from the first tick to the end of its recording: hands or a source lead, the panel guides,
// pause, rack, help, result.
//
//   AttemptWindow attempt(stage, lesson, plan);
//   const Choice next = attempt.run();        // restart, start_screen or quit
#pragma once

#include <trocar/attempt/attempt_log.hpp>
#include <trocar/attempt/live.hpp>
#include <trocar/core/controls/control_keys.hpp>
#include <trocar/training/exercise/outlook.hpp>
#include <trocar/training/exercise/step_needs.hpp>

#include "shell/panes.hpp"
#include "shell/rumble.hpp"
#include "trainer/choice.hpp"
#include "trainer/crew.hpp"
#include "trainer/feedback.hpp"
#include "trainer/force_feel.hpp"
#include "trainer/pause.hpp"
#include "trainer/picture_age.hpp"
#include "trainer/trainer_window.hpp"

namespace trocar::app {

class AttemptWindow {
 public:
  /// @param plan.input "mouse" or "gamepad": hands; else a source, see make_source()
  AttemptWindow(TrainerWindow& stage, const attempt::Lesson& lesson, const attempt::AttemptPlan& plan);
  ~AttemptWindow();

  Choice run();
  const Json& result() const { return m_result; }
  const std::string& recording() const { return m_log.attempt().recording; }

 private:
  enum class Ending { came_to_its_end, finished_early, left };

  void picture(attempt::Live& live, Choice& choice);
  void look_at_keys();
  void hold(const std::string& why);
  bool stands_still() const;
  void lead(const attempt::Snapshot& now);
  void tell_of_team(const attempt::Snapshot& now);
  void listen_to_device(const attempt::Snapshot& now);
  void keep_mode();
  void tell(attempt::Live& live);
  int felt_hand(const attempt::Snapshot& now) const;
  void feel(const attempt::Snapshot& now);
  void warn_of_pull(const attempt::Snapshot& now);
  void ask_for_the_eye(const attempt::Snapshot& now);
  bool crowds_simulation(const attempt::Snapshot& now) const;
  void log_rate(const attempt::Snapshot& now);
  void draw_scene(const attempt::Snapshot& now);
  void draw_panes(const attempt::Snapshot& now);
  void notice_refusal(const devices::HandSample& sample, const attempt::Snapshot& now);
  void draw_control_marks(const attempt::Snapshot& now) const;
  core::KeyDevice device_in_use() const;
  std::vector<std::string> key_lines_now(const attempt::Snapshot& now) const;
  void toggle_second_window();
  void run_beside();
  void show_beside(const attempt::Snapshot& now);
  void tell_views(const LayoutChoice& choice);
  void draw_over(const attempt::Snapshot& now, Choice& choice);
  void draw_the_rack(const attempt::Snapshot& now);
  void end(attempt::Live& live, Ending ending);
  bool counts() const;
  LayoutChoice layout() const;
  std::string screen_name() const;
  std::string mode_text() const;
  std::optional<training::Foretold> outlook(const attempt::Snapshot& now);
  double now_seconds() const;

  TrainerWindow& m_stage;
  const attempt::Lesson& m_lesson;
  attempt::AttemptPlan m_plan;
  std::unique_ptr<attempt::SolverBeside> m_beside;  ///< null: no other solver runs beside
  attempt::Session m_session;
  attempt::AttemptLog m_log;
  Crew m_crew;
  attempt::HandPilot* m_pilot;  ///< the crew's; null: a source leads
  std::vector<training::StepStatus> m_steps;
  std::unique_ptr<training::Outlook> m_outlook;  ///< made when it is first asked
  Feedback m_feedback;
  attempt::Feeler m_feeler;
  ForceFeel m_feel;
  Rumble m_rumble;
  int m_felt_hand = -1;
  PullWarning m_pull_warning;
  std::string m_told_warning, m_told_views, m_told_waits, m_why_paused;
  Json m_result;
  bool m_hint = false, m_hint_again = false, m_paused = false, m_rack = false, m_over = false;
  bool m_display = false, m_views = false;
  PauseMenu m_pause_menu;
  std::string m_refusal;  ///< why the last key did nothing
  double m_refusal_until = 0;
  devices::Gamepad m_pad_before;
  bool m_declares = false;  ///< the exercise asks for a declaration
  Panes m_panes;
  std::vector<view::PartStyle> m_styles;  ///< of the scene's parts
  bool m_was_still = true, m_gamepad_used = false, m_had_focus = false;
  int m_pictures = 0;  ///< since m_rate_since
  double m_rate_since = 0, m_slowest = 1;
  bool m_device_lost = false;    ///< as told
  attempt::DeviceNews m_device;  ///< of the source, as of this picture
  std::string m_told_device, m_told_device_hint;
  PictureAge m_age;          ///< of what a device leads
  int m_asked_for_eye = -1;  ///< hand whose insertion waits to be seen, as told
};

}  // namespace trocar::app
