#include "window_loop.hpp"

#include <cstdlib>
#include <thread>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/log.hpp>
#include <trocar/render/backend.hpp>
#include <trocar/render/gl_context.hpp>
#include <trocar/render/governor.hpp>
#include <trocar/view/scene_view.hpp>

#include "event_log.hpp"
#include "hand_pilot.hpp"
#include "interrupt.hpp"
#include "live.hpp"
#include "panel.hpp"
#include "paths.hpp"
#include "sources.hpp"
#include "window.hpp"

namespace trocar::app {

namespace fs = std::filesystem;

namespace {

constexpr double kFullRate = 62, kYieldingRate = 24;  // [pictures/s] at most; the second while the simulation lags

/// A software renderer that takes every core would take the simulation's, too. Read by Mesa when the context is made.
void leave_a_core_to_the_simulation() {
  const unsigned cores = std::max(2u, std::thread::hardware_concurrency());
  setenv("LP_NUM_THREADS", std::to_string(cores - 1).c_str(), 0);
}

std::string log_path(const WindowOptions& options) {
  const char* from_environment = std::getenv("TROCAR_WINDOW_LOG");
  return !options.log.empty() ? options.log : from_environment ? from_environment : "";
}

/// Everything that lives as long as the window.
struct Stage {
  Window window;
  std::unique_ptr<render::GlContext> context = render::GlContext::adopt_current();
  std::unique_ptr<render::Backend> backend = render::make_gl_backend(*context);
  view::SceneView view;
  render::Governor governor;
  EventLog log;
  bool help = false;

  Stage(const Lesson& lesson, const WindowOptions& options)
      : window("Trocar: " + (lesson.title.empty() ? lesson.name : lesson.title), options.size),
        view(lesson.model, *backend),
        log(log_path(options)) {}
  bool wants_to_close() const { return window.wants_to_close() || interrupted(); }
};

/// One attempt, from the first tick to the end of its recording.
class Attempt {
 public:
  Attempt(Stage& stage, const Lesson& lesson, const WindowOptions& options, const fs::path& recording)
      : m_stage(stage), m_lesson(lesson), m_options(options), m_recording(recording), m_session(lesson) {
    if (options.input == "mouse")
      m_pilot = std::make_unique<HandPilot>(lesson.model);
    else
      m_source = make_source(lesson, options.input);
    if (recording.has_parent_path()) make_folder(recording.parent_path());
    m_session.record(recording, options.trainee, options.input);
    if (m_session.monitor()) m_steps = m_session.monitor()->steps();
  }

  /// Until it is over; says what is wanted next.
  Choice run();
  const Json& result() const { return m_result; }

 private:
  void picture(Live& live, Choice& choice);
  void draw_scene(const Snapshot& now);
  void tell(Live& live);
  void save_picture();
  void end(Live& live, bool interrupted);

  Stage& m_stage;
  const Lesson& m_lesson;
  const WindowOptions& m_options;
  fs::path m_recording;
  Session m_session;
  std::unique_ptr<HandPilot> m_pilot;
  std::unique_ptr<InputSource> m_source;
  std::vector<training::StepStatus> m_steps;
  std::string m_message;
  Json m_result;
  bool m_menu = false, m_over = false;
  int m_pictures = 0;
};

Choice Attempt::run() {
  m_stage.log.event("attempt", {{"exercise", m_lesson.name}, {"recording", m_recording.string()}});
  Live live(m_session, m_source.get(), m_options.seconds > 0 ? std::uint64_t(1000 * m_options.seconds) : 0);
  Choice choice = Choice::none;
  while (choice != Choice::restart && choice != Choice::quit && !m_stage.wants_to_close()) picture(live, choice);
  if (!m_over) end(live, true);
  return m_stage.wants_to_close() ? Choice::quit : choice;
}

void Attempt::picture(Live& live, Choice& choice) {
  Window& window = m_stage.window;
  window.set_picture_rate(live.snapshot().speed < 0.97 ? kYieldingRate : kFullRate);
  window.capture_pointer(m_pilot && !m_menu && !m_over);
  window.begin_picture();
  if (window.keys().help) m_stage.help = !m_stage.help;
  if (window.keys().menu && !m_over) m_menu = !m_menu;
  live.pause(m_menu);
  live.refresh();
  const Snapshot& now = live.snapshot();
  if (m_pilot && !m_menu && !m_over) live.put(m_pilot->lead(window.hands(), now.state));
  tell(live);
  if (now.finished && !m_over) end(live, false);

  draw_scene(now);
  if (m_stage.help) draw_help(window.scale());
  if (m_over)
    choice = draw_result(m_result, window.scale());
  else if (m_menu)
    choice = draw_menu(m_recording.string(), window.scale());
  if (choice == Choice::resume) m_menu = false;
  if ((m_over || m_menu) && window.keys().restart) choice = Choice::restart;
  if ((m_over || m_menu) && window.keys().quit) choice = Choice::quit;
  window.draw_panels();
  if (window.keys().picture) save_picture();
  window.show();
  m_stage.governor.frame_took(window.picture_time());
}

void Attempt::draw_scene(const Snapshot& now) {
  const Window& window = m_stage.window;
  const int panel = std::min(int(kPanelWidth * window.scale()), window.width() / 2);
  const int width = std::max(1, window.width() - panel), height = std::max(1, window.height());
  view::ViewOptions options;
  options.quality = m_stage.governor.quality();
  render::Target target = render::Target::window(width, height);
  render::draw_frame(*m_stage.backend, m_stage.view.frame(now.state, options), target);
  draw_panel({m_lesson, now, m_pilot ? &m_pilot->hands() : nullptr, m_options.input, m_steps, m_message, m_menu},
             float(width), float(panel), float(height), window.scale());
}

void Attempt::tell(Live& live) {
  for (const Moment& m : live.take_moments()) {
    m_message = m.text;
    m_stage.log.moment(m_lesson.model, m);
  }
  m_stage.log.pose(m_lesson.model, live.snapshot().state, m_pilot ? m_pilot->hands().led : 0);
}

void Attempt::save_picture() {
  fs::path file = m_recording;
  file.replace_extension(fmt::format("{:03}.png", m_pictures++));
  try {
    render::write_png(file.string(), m_stage.window.read_back());
    m_message = "saved " + file.string();
    m_stage.log.event("picture", {{"file", file.string()}});
  } catch (const core::EnvironmentLacks& lacks) {
    m_message = lacks.what();
  }
}

void Attempt::end(Live& live, bool interrupted) {
  live.stop();
  tell(live);
  // Practice has no goal, so closing the window is its proper end.
  m_result = m_session.result(interrupted && m_session.monitor());
  m_result["input"] = m_options.input;
  m_result["slow_motion_share"] = live.slow_share();
  if (m_source) m_result.update(m_source->describe());
  m_session.finish(m_result);
  m_stage.log.event("end",
                    {{"interrupted", interrupted}, {"passed", m_result["passed"]}, {"ticks", m_result["ticks"]}});
  m_over = true;
}

}  // namespace

Json run_window(const Lesson& lesson, const WindowOptions& options) {
  leave_a_core_to_the_simulation();
  catch_interrupts();
  Stage stage(lesson, options);
  core::log::info("drawing with {}", stage.context->description());
  for (int number = 1;; ++number) {
    fs::path recording = options.record.empty() ? default_recording(lesson.name) : fs::path(options.record);
    if (number > 1) recording = unused(recording);
    Attempt attempt(stage, lesson, options, recording);
    const Choice next = attempt.run();
    core::log::info("recording: {}", recording.string());
    if (next != Choice::restart) return attempt.result();
  }
}

}  // namespace trocar::app
