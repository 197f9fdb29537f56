#include "trainer/window_loop.hpp"

#include <algorithm>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <trocar/attempt/interrupt.hpp>
#include <trocar/attempt/lesson_shelf.hpp>
#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/log.hpp>
#include <trocar/core/text.hpp>
#include <trocar/training/store/attempt.hpp>

#include "shell/ui.hpp"
#include "start/start_screen.hpp"
#include "start/thumbnails.hpp"
#include "trainer/attempt_window.hpp"
#include "trainer/demonstrator.hpp"

namespace trocar::app {

using training::AttemptMode;

namespace {

constexpr double kMenuRate = 30;  // [pictures/s]
constexpr int kPreviewWidth = 800, kPreviewHeight = 600, kPreviewPictures = 12;
constexpr double kQuietTime = 3;  // [s] on the start screen before pictures are made in the background

/// A picture of the scene as the endoscope sees it first, for the start screen. Its exposure settles over some pictures
/// of the window, so that none of them takes long.
class Preview {
 public:
  ~Preview() {
    if (m_texture != 0) glDeleteTextures(1, &m_texture);
  }
  /// Once per picture. 0: it is not ready.
  unsigned of(TrainerWindow& stage, const attempt::Lesson& lesson) {
    if (m_lesson != &lesson) begin(stage, lesson);
    if (m_drawn == kPreviewPictures) return m_texture;
    m_frame.tick = std::uint64_t(200 * m_drawn);
    render::draw_frame(*stage.backend, m_frame, render::Target::off_screen(kPreviewWidth, kPreviewHeight));
    if (++m_drawn < kPreviewPictures) return 0;
    m_image = stage.backend->read_pixels();
    upload(m_image);
    return m_texture;
  }
  void forget() { m_lesson = nullptr; }
  /// The scene's view may have gone: what is not ready begins again.
  void forget_unfinished() {
    if (m_drawn < kPreviewPictures) forget();
  }
  const render::Image& image() const { return m_image; }  ///< empty while it is not ready

 private:
  void begin(TrainerWindow& stage, const attempt::Lesson& lesson) {
    m_lesson = &lesson;
    m_drawn = 0;
    m_image = {};
    m_state = std::make_unique<sim::State>(sim::initial_state(lesson.model));
    view::ViewOptions options;
    options.eye_index = 1;
    m_frame = stage.view_of(lesson).frame(*m_state, options);
  }
  void upload(const render::Image& image) {
    if (m_texture == 0) glGenTextures(1, &m_texture);
    glBindTexture(GL_TEXTURE_2D, m_texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, image.width, image.height, 0, GL_RGB, GL_UNSIGNED_BYTE, image.rgb.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glBindTexture(GL_TEXTURE_2D, 0);
  }

  const attempt::Lesson* m_lesson = nullptr;
  std::unique_ptr<sim::State> m_state;  ///< as long as the frame
  render::Frame m_frame;
  render::Image m_image;
  int m_drawn = 0;
  unsigned m_texture = 0;
};

/// Half as wide and high: what a tile needs.
render::Image halved(const render::Image& whole) {
  render::Image half;
  half.width = whole.width / 2;
  half.height = whole.height / 2;
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x)
      for (int k = 0; k < 3; ++k)
        half.rgb.push_back(std::uint8_t((whole.at(2 * x, 2 * y)[k] + whole.at(2 * x + 1, 2 * y)[k] +
                                         whole.at(2 * x, 2 * y + 1)[k] + whole.at(2 * x + 1, 2 * y + 1)[k]) /
                                        4));
  return half;
}

/// The program of screens.
class Trainer {
 public:
  Trainer(std::unique_ptr<attempt::Lesson> lesson, const WindowOptions& options)
      : m_options(options),
        m_direct(lesson != nullptr),
        m_stage(options),
        m_shelf(std::move(lesson)),
        m_exercises(attempt::list_trainings(attempt::scenes_folder())) {
    for (std::size_t i = 0; i < m_exercises.size(); ++i)
      if (m_exercises[i].name == options.exercise) m_memory.selected = int(i);
    m_memory.seed = options.seed;
    if (!options.trainee.empty()) m_memory.open(StartPage::exercises);
  }

  Json run() {
    if (m_direct) {
      const attempt::Lesson& lesson = *m_shelf.poll();
      if (train(lesson, first_plan(lesson)) == Choice::quit) return m_result;
    }
    for (;;) {
      const StartChoice choice = start_screen();
      if (choice == StartChoice::quit) return m_result;
      const attempt::Lesson& lesson = *m_shelf.poll();
      const bool demonstration = choice == StartChoice::demonstrate;
      if (demonstration && m_demonstrator.play(m_stage, lesson) != PlayerEnd::now_you) continue;
      if (train(lesson, plan_for(demonstration ? StartChoice::start : choice, lesson)) == Choice::quit) return m_result;
    }
  }

  /// Lines of the log that are lost are lost output, whatever else went well.
  void tell_lost_log(Json& result) const {
    if (m_stage.log.failure().empty()) return;
    if (result.is_null()) throw core::EnvironmentLacks(m_stage.log.failure());
    result["log_failure"] = m_stage.log.failure();
  }

 private:
  attempt::AttemptPlan first_plan(const attempt::Lesson& lesson) const {
    attempt::AttemptPlan plan;
    plan.input = m_options.input;
    if (attempt::mode_of_input(plan.input) != AttemptMode::demonstration) plan.trainee = m_stage.settings.trainee;
    plan.mode = m_options.familiarisation ? AttemptMode::familiarisation
                : lesson.exercise         ? attempt::mode_of_input(m_options.input)
                                          : AttemptMode::free_practice;
    plan.recording = m_options.record;
    return plan;
  }
  attempt::AttemptPlan plan_for(StartChoice choice, const attempt::Lesson& lesson) const {
    attempt::AttemptPlan plan;
    plan.trainee = m_stage.settings.trainee;
    plan.mode = choice == StartChoice::familiarise ? AttemptMode::familiarisation
                : lesson.exercise                  ? AttemptMode::assessed
                                                   : AttemptMode::free_practice;
    plan.input = touched(m_stage.window.gamepads().state()) ? "gamepad" : "mouse";
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
  const attempt::Lesson* prepare();
  void show_pictures(const attempt::Lesson* lesson);
  StartContent content(bool ready);
  std::vector<std::string> known_people() const;
  std::vector<std::string> notices() const;
  StartAnswer draw();
  void take_answer(const StartAnswer& answer);
  void choose(const std::string& person);

  const WindowOptions m_options;
  bool m_direct;
  TrainerWindow m_stage;
  attempt::LessonShelf m_shelf;
  std::vector<attempt::ExerciseEntry> m_exercises;
  StartMemory m_memory;
  Past m_past;
  Children m_children;
  Thumbnails m_thumbnails;
  Preview m_preview;
  ExerciseFacts m_facts;
  const attempt::Lesson* m_shown = nullptr;  ///< whose facts these are
  Demonstrator m_demonstrator;
  Json m_result;
};

ExerciseFacts Trainer::facts_of(const attempt::Lesson* lesson) {
  ExerciseFacts facts;
  facts.aspect = float(kPreviewWidth) / float(kPreviewHeight);
  if (!lesson || !lesson->exercise) return facts;
  const auto monitor = lesson->monitor();
  for (const training::StepStatus& step : monitor->steps()) facts.steps.push_back(step.name);
  return facts;
}

/// The lesson of the selected exercise; null while it is being prepared.
const attempt::Lesson* Trainer::prepare() {
  if (m_memory.selected < 0) return nullptr;
  const std::string& name = m_exercises[size_t(m_memory.selected)].name;
  if (name != m_shelf.wanted() || m_memory.seed != m_shelf.seed()) {
    m_stage.drop_view();  // before the lesson that it shows is gone
    m_preview.forget();
    m_shelf.want(name, m_memory.seed);
  }
  const attempt::Lesson* lesson = m_shelf.poll();
  if (!lesson || lesson != m_shown) m_facts = facts_of(lesson);
  m_shown = lesson;
  return lesson;
}

/// The picture of the prepared scene; where it is the standard patient's, it is the tile's, too.
void Trainer::show_pictures(const attempt::Lesson* lesson) {
  if (lesson && m_memory.page == StartPage::details) {
    const bool fresh = m_facts.picture == 0;
    m_facts.picture = m_preview.of(m_stage, *lesson);
    if (fresh && m_facts.picture != 0 && lesson->seed == 0)
      m_thumbnails.keep(m_exercises[size_t(m_memory.selected)], halved(m_preview.image()));
  }
}

/// Who has practised here, or was added: whoever did last, first.
std::vector<std::string> Trainer::known_people() const {
  std::vector<std::string> people;
  const auto add = [&people](const std::string& name) {
    if (!name.empty() && std::find(people.begin(), people.end(), name) == people.end()) people.push_back(name);
  };
  add(m_stage.settings.trainee);
  for (const std::string& name : m_past.people) add(name);
  for (const KnownPerson& person : m_stage.settings.others) add(person.name);
  return people;
}

std::vector<std::string> Trainer::notices() const {
  std::vector<std::string> all = m_past.notices;
  for (const core::Fault& f : m_stage.setting_faults) all.push_back(tr("{} (ignored)", core::to_string(f)));
  return all;
}

void Trainer::choose(const std::string& person) {
  choose_person(m_stage.settings, person);
  m_stage.apply_settings();
  m_stage.keep_settings();
  m_past = read_past(m_stage.options.store, person);
  m_memory.selected = -1;
  m_memory.name[0] = 0;
  m_memory.open(StartPage::exercises);
}

void Trainer::take_answer(const StartAnswer& answer) {
  if (answer.person) choose(*answer.person);
  if (answer.report_of != 0) m_stage.reports.open(m_stage.options.store, std::to_string(answer.report_of));
  if (answer.news_read) m_children.forget_news();
  if (!answer.stop.empty()) m_children.stop(answer.stop);
  if (!answer.program.arguments.empty()) {
    m_children.start(answer.program);
    m_stage.log.event("program", {{"arguments", answer.program.arguments}, {"started", !m_children.refused()}});
  }
  if (answer.choice == StartChoice::settings) m_stage.open(TrainerWindow::Overlay::settings);
  if (answer.choice == StartChoice::help) m_stage.open(TrainerWindow::Overlay::help);
}

StartContent Trainer::content(bool ready) {
  return {m_exercises,
          m_facts,
          ready,
          m_shelf.failure(),
          m_past,
          m_stage.settings.trainee,
          known_people(),
          m_stage.window.gamepads().names(),
          notices(),
          m_stage.sound.audible(),
          m_stage.reports.say(),
          m_children,
          [this](int i) { return m_thumbnails.of(m_exercises[size_t(i)]); }};
}

/// One picture of the start screen.
StartAnswer Trainer::draw() {
  m_stage.begin_picture(false);
  const attempt::Lesson* lesson = prepare();
  show_pictures(lesson);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, m_stage.window.width(), m_stage.window.height());
  glClearColor(0.09f, 0.10f, 0.12f, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  StartAnswer answer;
  const StartPage page = m_memory.page;
  if (m_stage.overlay() == TrainerWindow::Overlay::none)
    answer = draw_start(content(lesson != nullptr), m_memory, m_stage.window.keys().back);
  if (answer.choice == StartChoice::demonstrate && lesson) m_demonstrator.ask(*lesson);
  if (answer.choice == StartChoice::demonstrate) answer.choice = StartChoice::none;
  if (m_demonstrator.draw(lesson)) answer.choice = StartChoice::demonstrate;
  take_answer(answer);
  m_stage.end_picture(name_of(page), attempt::data_folder() / "start");
  if (!lesson) answer.choice = answer.choice == StartChoice::quit ? StartChoice::quit : StartChoice::none;
  return answer;
}

/// Until an exercise is to begin, or the window is closed.
StartChoice Trainer::start_screen() {
  m_stage.window.set_title("Trocar");
  ui::set_middle(0);
  m_stage.window.set_picture_rate(kMenuRate);
  m_past = read_past(m_stage.options.store, m_stage.settings.trainee);
  if (m_memory.page == StartPage::details) m_memory.open(StartPage::exercises);
  m_shown = nullptr;
  m_preview.forget_unfinished();
  double time = 0;
  while (!m_stage.wants_to_close()) {
    const StartChoice choice = draw().choice;
    time += m_stage.window.picture_time();
    m_children.poll(time);
    const bool loads = m_memory.page == StartPage::details && !m_shown;
    m_thumbnails.work(time > kQuietTime && !loads);
    if (choice == StartChoice::quit) return StartChoice::quit;
    if (choice == StartChoice::start || choice == StartChoice::familiarise || choice == StartChoice::demonstrate) {
      m_stage.keep_settings();
      return choice;
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
