#include "trainer/window_loop.hpp"

#include <algorithm>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <trocar/attempt/interrupt.hpp>
#include <trocar/attempt/lesson_shelf.hpp>
#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/log.hpp>
#include <trocar/training/store/attempt.hpp>

#include "shell/ui.hpp"
#include "trainer/attempt_window.hpp"
#include "trainer/demonstrator.hpp"
#include "trainer/start_screen.hpp"

namespace trocar::app {

using training::AttemptMode;

namespace {

constexpr double kMenuRate = 30;  // [pictures/s]
constexpr int kPreviewWidth = 800, kPreviewHeight = 600, kPreviewPictures = 12;

/// A picture of the scene as the endoscope sees it first, for the start screen.
class Preview {
 public:
  ~Preview() {
    if (m_texture != 0) glDeleteTextures(1, &m_texture);
  }
  /// Draws it once per lesson.
  unsigned of(TrainerWindow& stage, const attempt::Lesson& lesson) {
    if (m_lesson == &lesson) return m_texture;
    m_lesson = &lesson;
    const sim::State state = sim::initial_state(lesson.model);
    view::ViewOptions options;
    options.eye_index = 1;
    render::Frame frame = stage.view_of(lesson).frame(state, options);
    for (int i = 0; i < kPreviewPictures; ++i) {  // its exposure settles
      frame.tick = std::uint64_t(200 * i);
      render::draw_frame(*stage.backend, frame, render::Target::off_screen(kPreviewWidth, kPreviewHeight));
    }
    upload(stage.backend->read_pixels());
    return m_texture;
  }
  void forget() { m_lesson = nullptr; }

 private:
  void upload(const render::Image& image) {
    if (m_texture == 0) glGenTextures(1, &m_texture);
    glBindTexture(GL_TEXTURE_2D, m_texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, image.width, image.height, 0, GL_RGB, GL_UNSIGNED_BYTE, image.rgb.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glBindTexture(GL_TEXTURE_2D, 0);
  }

  const attempt::Lesson* m_lesson = nullptr;
  unsigned m_texture = 0;
};

/// The program of screens.
class Trainer {
 public:
  Trainer(std::unique_ptr<attempt::Lesson> lesson, const WindowOptions& options)
      : m_options(options),
        m_direct(lesson != nullptr),
        m_stage(options),
        m_shelf(std::move(lesson)),
        m_exercises(attempt::list_trainings(attempt::scenes_folder())) {
    const std::string trainee = m_stage.settings.trainee;
    trainee.copy(m_memory.trainee, training::kLongestName);
    for (std::size_t i = 0; i < m_exercises.size(); ++i)
      if (m_exercises[i].name == options.exercise) m_selected = int(i);
    m_seed = options.seed;
  }

  Json run() {
    if (m_direct) {
      const attempt::Lesson& lesson = *m_shelf.poll();
      if (train(lesson, first_plan()) == Choice::quit) return m_result;
    }
    for (;;) {
      const StartChoice choice = start_screen();
      if (choice == StartChoice::quit) return m_result;
      const attempt::Lesson& lesson = *m_shelf.poll();
      const bool demonstration = choice == StartChoice::demonstrate;
      if (demonstration && m_demonstrator.play(m_stage, lesson) != PlayerEnd::now_you) continue;
      if (train(lesson, plan_for(demonstration ? StartChoice::start : choice)) == Choice::quit) return m_result;
    }
  }

  /// Lines of the log that are lost are lost output, whatever else went well.
  void tell_lost_log(Json& result) const {
    if (m_stage.log.failure().empty()) return;
    if (result.is_null()) throw core::EnvironmentLacks(m_stage.log.failure());
    result["log_failure"] = m_stage.log.failure();
  }

 private:
  attempt::AttemptPlan first_plan() const {
    attempt::AttemptPlan plan;
    plan.trainee = m_options.trainee;
    plan.input = m_options.input;
    plan.mode = m_options.familiarisation ? AttemptMode::familiarisation : attempt::mode_of_input(m_options.input);
    plan.recording = m_options.record;
    return plan;
  }
  attempt::AttemptPlan plan_for(StartChoice choice) const {
    attempt::AttemptPlan plan;
    plan.trainee = m_stage.settings.trainee;
    plan.mode = choice == StartChoice::familiarise   ? AttemptMode::familiarisation
                : choice == StartChoice::demonstrate ? AttemptMode::demonstration
                                                     : AttemptMode::assessed;
    plan.input = choice == StartChoice::demonstrate           ? "demo"
                 : touched(m_stage.window.gamepads().state()) ? "gamepad"
                                                              : "mouse";
    return plan;
  }

  /// Attempts at one exercise, until something else is wanted.
  Choice train(const attempt::Lesson& lesson, attempt::AttemptPlan plan) {
    for (;;) {
      AttemptWindow attempt(m_stage, lesson, plan);
      const Choice next = attempt.run();
      m_result = attempt.result();
      if (next != Choice::restart) return next;
      if (!plan.recording.empty()) plan.recording = attempt::unused(plan.recording);
    }
  }

  StartChoice start_screen();
  ExerciseFacts facts_of(const attempt::Lesson* lesson);
  void take_answer(const StartAnswer& answer);

  const WindowOptions m_options;
  bool m_direct;
  TrainerWindow m_stage;
  attempt::LessonShelf m_shelf;
  std::vector<attempt::ExerciseEntry> m_exercises;
  int m_selected = 0;
  std::uint64_t m_seed = 0;  ///< of the anatomy
  StartMemory m_memory;
  Past m_past;
  Preview m_preview;
  Demonstrator m_demonstrator;
  Json m_result;
};

/// A step's title without its side, in the middle of a sentence.
std::string title_of(const training::Exercise& e, const std::string& task) {
  const training::StepText* step = e.step(task);
  std::string title = step && step->title.find('{') == std::string::npos ? step->title : task;
  if (!title.empty() && title[0] >= 'A' && title[0] <= 'Z') title[0] = char(title[0] - 'A' + 'a');
  return title;
}

ExerciseFacts Trainer::facts_of(const attempt::Lesson* lesson) {
  ExerciseFacts facts;
  facts.aspect = float(kPreviewWidth) / float(kPreviewHeight);
  if (!lesson) return facts;
  facts.picture = m_preview.of(m_stage, *lesson);
  if (!lesson->exercise) {
    facts.summary = "Free practice: no task, no clock, no score. Everything is kept as a recording.";
    return facts;
  }
  const training::Exercise& e = *lesson->exercise;
  facts.facts.push_back(fmt::format("about {:.0f} minutes", std::max(1.0, e.expert_time / 60)));
  facts.facts.push_back(fmt::format("passed from {:.0f} of 100", e.pass_mark));
  const std::unique_ptr<training::Monitor> monitor = lesson->monitor();
  const std::string* side = nullptr;
  for (const training::StepStatus& s : monitor->steps()) {  // a line for what belongs to both, one for each side
    if (side && *side == s.side)
      facts.steps.back() += ", " + title_of(e, s.task);
    else
      facts.steps.push_back(s.name);
    side = &s.side;
  }
  facts.summary = e.summary;
  return facts;
}

void Trainer::take_answer(const StartAnswer& answer) {
  if (answer.selected >= 0) m_selected = answer.selected;
  m_seed = answer.seed.value_or(m_seed);
  if (answer.trainee_changed) {
    m_stage.settings.trainee = training::clean_name(m_memory.trainee);
    m_past = read_past(m_stage.options.store, m_stage.settings.trainee);
  }
  std::int64_t report_of = answer.report_of;
  if (answer.choice == StartChoice::report && !m_past.attempts.empty()) report_of = m_past.attempts.front().number;
  if (report_of != 0) m_stage.reports.open(m_stage.options.store, std::to_string(report_of));
  if (answer.choice == StartChoice::settings) m_stage.open(TrainerWindow::Overlay::settings);
  if (answer.choice == StartChoice::help) m_stage.open(TrainerWindow::Overlay::help);
}

/// Until an exercise is to begin, or the window is closed.
StartChoice Trainer::start_screen() {
  m_stage.window.set_title("Trocar");
  ui::set_middle(0);
  m_memory.was_ready = false;
  m_stage.window.set_picture_rate(kMenuRate);
  m_past = read_past(m_stage.options.store, m_stage.settings.trainee);
  std::vector<std::string> notices = m_past.notices;
  for (const core::Fault& f : m_stage.setting_faults) notices.push_back(core::to_string(f) + " (left out)");
  ExerciseFacts facts;
  const attempt::Lesson* shown = nullptr;
  while (!m_stage.wants_to_close()) {
    if (!m_exercises.empty() &&
        (m_exercises[size_t(m_selected)].name != m_shelf.wanted() || m_seed != m_shelf.seed())) {
      m_stage.drop_view();  // before the lesson that it shows is gone
      m_preview.forget();
      m_shelf.want(m_exercises[size_t(m_selected)].name, m_seed);
    }
    m_stage.begin_picture(false);
    const attempt::Lesson* lesson = m_shelf.poll();
    if (!lesson || lesson != shown) facts = facts_of(lesson);
    shown = lesson;
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, m_stage.window.width(), m_stage.window.height());
    glClearColor(0.09f, 0.10f, 0.12f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    const StartContent content{m_exercises,
                               m_selected,
                               m_seed,
                               facts,
                               lesson != nullptr,
                               m_shelf.failure(),
                               m_past,
                               m_stage.window.gamepads().names(),
                               notices,
                               m_stage.sound.audible(),
                               m_stage.reports.say()};
    StartAnswer answer;
    if (m_stage.overlay() == TrainerWindow::Overlay::none) answer = draw_start(content, m_memory);
    const bool demonstration_ready = m_demonstrator.draw(lesson);
    take_answer(answer);
    m_stage.end_picture("start", attempt::data_folder() / "start");
    if (answer.choice == StartChoice::quit) return StartChoice::quit;
    if (answer.choice == StartChoice::demonstrate && lesson) m_demonstrator.ask(*lesson);
    if (demonstration_ready) answer.choice = StartChoice::demonstrate;
    const bool begin =
        answer.choice == StartChoice::start || answer.choice == StartChoice::familiarise || demonstration_ready;
    if (begin && lesson) {
      m_stage.settings.trainee = training::clean_name(m_memory.trainee);
      m_stage.keep_settings();
      return answer.choice;
    }
  }
  return StartChoice::quit;
}

}  // namespace

Json run_window(std::unique_ptr<attempt::Lesson> lesson, const WindowOptions& options) {
  attempt::catch_interrupts();
  Trainer trainer(std::move(lesson), options);
  Json result = trainer.run();
  trainer.tell_lost_log(result);
  return result;
}

}  // namespace trocar::app
