#include "trainer/attempt_window.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <trocar/attempt/controls/first_control.hpp>
#include <trocar/attempt/hand_names.hpp>
#include <trocar/attempt/paths.hpp>
#include <trocar/attempt/team/message.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/log.hpp>
#include <trocar/core/text.hpp>
#include <trocar/core/tick.hpp>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "guide/control_mark.hpp"
#include "guide/key_lines.hpp"
#include "guide/refusals.hpp"
#include "shell/display_panel.hpp"
#include "shell/layout_panel.hpp"
#include "shell/ui.hpp"
#include "start/past.hpp"
#include "trainer/demonstrator.hpp"
#include "trainer/guidance.hpp"
#include "trainer/panel.hpp"
#include "trainer/rack.hpp"
#include "trainer/result.hpp"

namespace trocar::app {

using training::AttemptMode;
using training::AttemptState;

namespace {

constexpr double kSlowest = 0.05;
constexpr double kLagging = 0.95;
constexpr double kRefusalSeconds = 4;                 // that a line about a key stays
constexpr double kFullRate = 62, kYieldingRate = 24;  // [pictures/s] at most; the second while the simulation lags

double pull_limit(const attempt::Lesson& lesson) {
  return lesson.exercise ? lesson.exercise->limit("pull_limit_N", 5.0) : 5.0;
}

std::string window_title(const attempt::Lesson& lesson) {
  const std::string title = "Trocar: " + (lesson.title.empty() ? lesson.name : lesson.title);
  return lesson.seed == 0 ? title : tr("{}, patient {}", title, lesson.seed);
}

/// Shown as long as the program runs: whoever wants the figures wants them in the next exercise, too.
bool& details_open() {
  static bool open = false;
  return open;
}

}  // namespace

AttemptWindow::AttemptWindow(TrainerWindow& stage, const attempt::Lesson& lesson, const attempt::AttemptPlan& plan)
    : m_stage(stage),
      m_lesson(lesson),
      m_plan(plan),
      m_session(lesson),
      m_log(stage.options.store, m_session, plan),
      m_crew(stage, lesson, plan.input, attempt::first_control(m_session)),
      m_pilot(m_crew.pilot()),
      m_feeler(lesson.model),
      m_panes(lesson.model) {
  m_hint = m_pilot && !stage.options.member && stage.settings.show_hint;
  run_beside();
  m_gamepad_used = plan.input == "gamepad";
  if (const training::Monitor* monitor = m_session.monitor()) {
    m_steps = monitor->steps();
    m_declares = training::asks_for_declaration(monitor->rules());
  }
  stage.equipment = equipment_of(lesson.model, m_declares);
  stage.window.set_title(window_title(lesson));
}

AttemptWindow::~AttemptWindow() {
  m_stage.close_elsewhere();
  m_stage.equipment = {};
}

/// The simulation pauses while a participant is disconnected.
void AttemptWindow::tell_of_team(const attempt::Snapshot& now) {
  const std::string waits = m_over ? "" : m_crew.source().waits_for();
  if (waits == m_told_waits) return;
  m_told_waits = waits;
  m_stage.log.event("waits", {{"tick", now.state.tick}, {"for", waits}});
}

/// The other solver of an organ, where this is the exercise that it was asked for.
void AttemptWindow::run_beside() {
  const auto& other = m_stage.options.other_solver;
  if (!other || other->name != m_lesson.name || other->seed != m_lesson.seed) return;
  m_beside = std::make_unique<attempt::SolverBeside>(other->model, other->model.organ_index(m_stage.options.beside));
  m_session.run_beside(m_beside.get());
  m_panes.cameras.analysis.solvers = true;
  m_panes.cameras.analysis.strain = m_panes.cameras.analysis.forces = false;
}

void AttemptWindow::show_beside(const attempt::Snapshot& now) {
  if (!m_beside || now.beside_skin.empty()) return;
  m_panes.beside = std::make_shared<const view::OrganBeside>(
      view::OrganBeside{m_beside->organ(), now.beside_skin, now.beside_outline});
}

double AttemptWindow::now_seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// While it is only practice, people are told what their clip would be worth.
std::optional<training::Foretold> AttemptWindow::outlook(const attempt::Snapshot& now) {
  if (m_plan.mode != AttemptMode::familiarisation || !m_lesson.exercise || m_over) return std::nullopt;
  if (!m_outlook) m_outlook = std::make_unique<training::Outlook>(*m_lesson.exercise, m_lesson.model, m_lesson.seed);
  return m_outlook->of(m_lesson.model, now.state, now.step_done);
}

std::string AttemptWindow::mode_text() const {
  if (m_plan.mode == AttemptMode::familiarisation) return tr("familiarisation: no score");
  if (m_plan.mode == AttemptMode::demonstration) return tr("demonstration");
  return m_lesson.exercise ? "" : tr("free practice");
}

/// Is it scored? Then organs are not looked through.
bool AttemptWindow::counts() const { return m_plan.mode == AttemptMode::assessed && !m_steps.empty(); }

/// While it counts there is nothing but what the endoscope sees.
LayoutChoice AttemptWindow::layout() const {
  LayoutChoice choice = m_stage.settings.views;
  if (!counts() || m_over) return choice;
  LayoutChoice plain;
  if (choice.elsewhere) plain.elsewhere = PaneShows::endoscope;
  return plain;
}

std::string AttemptWindow::screen_name() const {
  return m_over      ? "result"
         : m_hint    ? "hint"
         : m_display ? "display"
         : m_views   ? "views"
         : m_paused  ? m_pause_menu.asks() ? "confirm" : "pause"
         : m_rack    ? "rack"
                     : "exercise";
}

Choice AttemptWindow::run() {
  m_stage.log.event("attempt", {{"exercise", m_lesson.name},
                                {"mode", name_of(m_plan.mode)},
                                {"trainee", m_log.attempt().trainee},
                                {"recording", m_log.attempt().recording}});
  const double seconds = m_stage.options.seconds;
  attempt::Live live(m_session, m_crew.source(),
                     seconds > 0 ? std::uint64_t(double(core::kTicksPerSecond) * seconds) : 0);
  Choice choice = Choice::none;
  const auto goes_on = [&] {
    return choice != Choice::restart && choice != Choice::start_screen && choice != Choice::quit;
  };
  while (goes_on() && !m_stage.wants_to_close()) {
    picture(live, choice);
    if (std::exchange(m_watch, false)) watch();
  }
  if (!m_over) end(live, Ending::left);
  return m_stage.wants_to_close() ? Choice::quit : choice;
}

/// Is it paused?
bool AttemptWindow::stands_still() const {
  return m_paused || m_hint || m_over || m_stage.overlay() != TrainerWindow::Overlay::none;
}

void AttemptWindow::hold(const std::string& why) {
  if (m_over) return;
  m_paused = true;
  m_rack = false;
  m_why_paused = why;
}

void AttemptWindow::picture(attempt::Live& live, Choice& choice) {
  Window& window = m_stage.window;
  const bool hands = m_pilot && !stands_still() && !m_rack;
  window.set_picture_rate(stands_still() || live.snapshot().speed < 0.97 ? kYieldingRate : kFullRate);
  m_stage.begin_picture(hands);
  look_at_keys();
  live.pause(stands_still());
  live.refresh();
  const attempt::Snapshot& now = live.snapshot();
  lead(now);
  listen_to_device(now);
  tell(live);
  tell_of_team(now);
  warn_of_pull(now);
  feel(now);
  ask_for_the_eye(now);
  if (now.finished && !m_over) end(live, Ending::came_to_its_end);
  draw_scene(now);
  draw_over(now, choice);
  if (m_device.wants_restart && choice == Choice::none && !m_over) choice = Choice::restart;
  if (choice == Choice::finish) {
    end(live, Ending::finished_early);
    choice = Choice::none;
  }
  std::filesystem::path pictures = m_log.attempt().recording;
  if (pictures.empty()) pictures = "trocar";
  m_stage.end_picture(screen_name(), pictures);
  if (!stands_still()) m_age.shown(m_device.acquired, now_seconds());
  m_stage.governor.frame_took(window.picture_time(), crowds_simulation(now));
  log_rate(now);
}

/// Where processors draw, they are the simulation's first: it keeps real time, pictures get cheaper.
bool AttemptWindow::crowds_simulation(const attempt::Snapshot& now) const {
  return m_stage.context->draws_on_processors() && !stands_still() && now.speed < kLagging;
}

/// Once a second: how fast pictures come and time passes, and at which of the governor's levels.
void AttemptWindow::log_rate(const attempt::Snapshot& now) {
  if (!m_stage.log.on()) return;
  ++m_pictures;
  m_slowest = std::min(m_slowest, now.speed);
  const double time = now_seconds(), took = time - m_rate_since;
  if (took < 1) return;
  if (m_rate_since > 0)
    m_stage.log.event("rate", {{"tick", now.state.tick},
                               {"pictures_per_second", std::round(10 * double(m_pictures) / took) / 10},
                               {"slowest", std::round(100 * m_slowest) / 100},
                               {"still", stands_still()},
                               {"level", m_stage.governor.level()},
                               {"hand_to_picture_ms", std::round(10'000 * m_age.smoothed()) / 10}});
  m_rate_since = time;
  m_pictures = 0;
  m_slowest = 1;
}

void AttemptWindow::look_at_keys() {
  const Window& window = m_stage.window;
  if (window.gamepads().lost() && m_gamepad_used)
    hold(tr("The gamepad is disconnected. Connect it again, or resume with mouse and keyboard."));
  if (const std::string missing = stands_still() ? "" : m_crew.missing(); !missing.empty())
    hold(tr("{} is disconnected. Connect it, then resume.", missing));
  if (m_had_focus && !window.focused() && m_pilot && !stands_still()) hold(tr("Another window came to the front."));
  m_had_focus = window.focused();
  m_gamepad_used |= touched(window.gamepads().state());
  m_stage.gamepad_in_use = m_gamepad_used && window.gamepads().present();
  if (window.keys().second) toggle_second_window();
  for (const TypedKey& typed : window.typed())
    if (typed.key == GLFW_KEY_F4) details_open() = !details_open();
  if (window.keys().layout && !counts()) {
    Layout& layout = m_stage.settings.views.layout;
    layout = after(layout);
    m_stage.keep_settings();
  }
  if (m_stage.overlay() != TrainerWindow::Overlay::none || m_over || m_hint || m_display || m_views) return;
  const bool back = window.keys().back, pause = window.keys().pause;
  if (m_paused && m_pause_menu.asks() && !pause) return;  // the question answers the key
  if (m_rack && back) {
    m_rack = false;
  } else if (back || pause) {
    m_paused = !m_paused;
    m_rack = false;
    m_why_paused.clear();
    m_pause_menu.forget();
  }
}

/// It must not cover the picture: without room beside the first window the key says so.
void AttemptWindow::toggle_second_window() {
  std::optional<PaneShows>& elsewhere = m_stage.settings.views.elsewhere;
  if (!elsewhere && !SecondWindow::has_room(m_stage.window)) {
    m_refusal = tr("The second window needs a second monitor, or free space beside this window.");
    m_refusal_until = now_seconds() + kRefusalSeconds;
    return;
  }
  elsewhere = elsewhere ? std::nullopt : std::optional(PaneShows::endoscope);
  m_stage.keep_settings();
}

core::KeyDevice AttemptWindow::device_in_use() const {
  if (m_plan.input.starts_with("box")) return core::KeyDevice::box;
  if (!m_gamepad_used || !m_stage.window.gamepads().present()) return core::KeyDevice::mouse_and_keys;
  return m_pilot && m_pilot->leads_both() ? core::KeyDevice::gamepad_both : core::KeyDevice::gamepad;
}

std::vector<std::string> AttemptWindow::key_lines_now(const attempt::Snapshot& now) const {
  const training::Monitor* monitor = m_session.monitor();
  if (!monitor || now.current_step >= int(m_steps.size())) return {};
  const training::StepNeeds needs = training::needs_of(monitor->rules(), now.current_step, {m_lesson.model, now.state});
  const bool box = m_plan.input.starts_with("box");
  if (!m_pilot && !box) return {};
  int led = m_pilot ? m_pilot->hands().led : kNobody;
  if (m_pilot && m_pilot->leads_both()) {
    const devices::BothHands& both = m_pilot->both();
    const bool of_pair = both.pair[devices::kLeft] == needs.hand || both.pair[devices::kRight] == needs.hand;
    led = both.looking ? devices::kScope : of_pair ? needs.hand : led;
  }
  return key_lines(
      {needs, m_steps[size_t(now.current_step)].hint_pattern, device_in_use(), led, m_lesson.model, now.state});
}

void AttemptWindow::notice_refusal(const devices::HandSample& sample, const attempt::Snapshot& now) {
  const devices::Gamepad before = std::exchange(m_pad_before, sample.gamepad);
  const int led = m_pilot->hands().led;
  const bool seen =
      led != devices::kScope && tip_in_circle(m_lesson.model, now.state, led).in_view && !m_pilot->inserting(led);
  const std::string why = refusal({m_lesson.model, now.state, led, counts(), m_declares, seen, device_in_use()}, sample,
                                  before, m_stage.window.keys().layout);
  if (why.empty()) return;
  m_refusal = why;
  m_refusal_until = now_seconds() + kRefusalSeconds;
  m_stage.log.event("refusal", {{"text", why}});
}

/// What is controlled, in the endoscope's picture.
void AttemptWindow::draw_control_marks(const attempt::Snapshot& now) const {
  if (!m_pilot || m_over || m_panes.first().shows != PaneShows::endoscope) return;
  const auto mark = [&](int hand) {
    if (hand != devices::kScope && hand < attempt::hand_count(m_lesson.model))
      draw_control_mark(m_lesson.model, now.state, hand, m_panes.first().area, m_stage.settings.mirrored_picture,
                        core::key_label("into_view", device_in_use()));
  };
  if (!m_pilot->leads_both()) return mark(m_pilot->hands().led);
  if (m_pilot->both().looking) return;
  for (const int hand : m_pilot->both().pair) mark(hand);
}

void AttemptWindow::lead(const attempt::Snapshot& now) {
  if (!m_pilot) return;
  devices::HandSample sample = m_stage.window.hands();
  sample.dt *= float(std::clamp(now.speed, kSlowest, 1.0));  // where time is slow, held keys and sticks are as slow
  const bool still = stands_still() || m_rack;
  if (still) {
    if (m_rack && !stands_still()) m_crew.put(m_pilot->rest(sample.dt, now.state), sample.dt, now.state);
  } else {
    if (m_was_still) m_crew.take_up(sample);
    notice_refusal(sample, now);
    m_crew.put(m_pilot->lead(sample, now.state), sample.dt, now.state);
    if (m_pilot->asks_for_rack() && !m_lesson.model.hands.empty()) m_rack = true;
    keep_mode();
  }
  m_was_still = still;
}

/// What leads may be unplugged, or ask for something.
void AttemptWindow::listen_to_device(const attempt::Snapshot& now) {
  const std::optional<attempt::DeviceNews> news = m_crew.source().device();
  if (!news) return;
  m_device = *news;
  const auto say = [&](const std::string& text, std::string& told, ui::Mark mark) {
    if (text == told || m_over) return;
    told = text;
    if (text.empty()) return;
    m_feedback.add(mark, text, now.seconds, now_seconds());
    m_stage.log.event("device", {{"tick", now.state.tick}, {"text", text}});
  };
  say(m_device.warning, m_told_device, ui::Mark::warning);
  say(m_device.hint, m_told_device_hint, ui::Mark::note);
}

/// One hand or both, as it was chosen last, is what the next attempt begins with.
void AttemptWindow::keep_mode() {
  const bool both = m_pilot->both().on;
  if (both == m_stage.settings.both_hands) return;
  m_stage.settings.both_hands = both;
  m_stage.keep_settings();
  m_stage.log.event("both-hands", {{"on", both}});
}

void AttemptWindow::tell(attempt::Live& live) {
  const attempt::Snapshot& now = live.snapshot();
  for (const attempt::Moment& m : live.take_moments()) {
    const Notice* notice = m_feedback.add(m, now.seconds, now_seconds());
    if (notice && notice->tone) m_stage.sound.play(*notice->tone);
    m_stage.log.moment(m_lesson.model, m);
  }
  if (const std::string warning = m_log.warning(); warning != m_told_warning) {
    m_told_warning = warning;
    m_feedback.add(ui::Mark::warning, warning, now.seconds, now_seconds());
  }
  const bool both = m_pilot && m_pilot->leads_both();
  m_stage.log.pose(m_lesson.model, now, m_pilot ? m_pilot->hands().led : 0, both ? &m_pilot->both() : nullptr);
}

/// The hand whose force is told: the device's, the led one, or, where a source leads, that which feels most.
int AttemptWindow::felt_hand(const attempt::Snapshot& now) const {
  if (m_crew.haptic()) return m_crew.haptic()->hand();
  if (m_pilot) return m_pilot->hands().led == devices::kScope ? m_pilot->hands().last_instrument : m_pilot->hands().led;
  int most = 0;
  double force = -1;
  for (int h = 0; h < attempt::hand_count(m_lesson.model); ++h) {
    const attempt::TipForces f = attempt::forces_at_tip(m_lesson.model, now.state, h);
    if (const double size = length(f.contact + f.pull); size > force) most = h, force = size;
  }
  return most;
}

void AttemptWindow::feel(const attempt::Snapshot& now) {
  const bool lost = m_crew.haptic() && m_crew.haptic()->lost();
  if (lost != std::exchange(m_device_lost, lost) && lost)
    m_feedback.add(ui::Mark::warning, tr("The haptic device does not answer. Its force is off until it answers again."),
                   now.seconds, now_seconds());
  m_rumble.use(m_stage.settings.rumble && m_gamepad_used ? m_stage.window.gamepads().guid() : std::string());
  const int hand = felt_hand(now);
  if (stands_still() || m_lesson.model.hands.empty() || hand != std::exchange(m_felt_hand, hand)) {
    m_feel.forget();
    return m_rumble.set(0, 0, now_seconds());
  }
  m_feel.add(now_seconds(), m_feeler.feel(now.state, hand), pull_limit(m_lesson));
  m_rumble.set(m_feel.strong(), m_feel.weak(), now_seconds());
  if (!m_stage.settings.force_sound) return;
  if (m_feel.click()) m_stage.sound.play(Tone::touch, m_feel.level());
  if (m_feel.beat()) m_stage.sound.play(Tone::beat);
}

void AttemptWindow::warn_of_pull(const attempt::Snapshot& now) {
  if (!m_pilot || stands_still()) return;
  double pull = 0;
  for (int h = 0; h < attempt::hand_count(m_lesson.model); ++h) pull = std::max(pull, attempt::pull_on(now.state, h));
  if (m_pull_warning.due(pull, pull_limit(m_lesson), now_seconds())) m_stage.sound.play(Tone::warning);
}

/// An instrument that comes in waits under its trocar until it is in the picture.
void AttemptWindow::ask_for_the_eye(const attempt::Snapshot& now) {
  if (!m_pilot || stands_still()) return;
  int waits = -1;
  for (int h = 0; h < attempt::hand_count(m_lesson.model); ++h)
    if (m_pilot->waits_for_eye(h)) waits = h;
  if (waits == m_asked_for_eye) return;
  m_asked_for_eye = waits;
  if (waits < 0) return;
  const std::string name = attempt::hand_name(m_lesson.model, waits);
  m_feedback.add(ui::Mark::warning,
                 tr("{} is out of view. Turn the endoscope ({}) towards it, then it moves in.", name,
                    core::key_label("endoscope", device_in_use())),
                 now.seconds, now_seconds());
  m_stage.log.event("waits-for-eye", {{"tick", now.state.tick}, {"tool", m_lesson.model.hands[size_t(waits)].name}});
}

void AttemptWindow::draw_panes(const attempt::Snapshot& now) {
  show_beside(now);
  const render::Quality quality = m_stage.governor.quality();
  view::SceneView& view = m_stage.view_of(m_lesson);
  m_panes.draw_others({view, *m_stage.backend, now.state, now.state.tick, quality, m_styles}, false);
  const Panes::Pane& first = m_panes.first();
  view::ViewOptions options = m_panes.options(first.shows);
  options.quality = quality;
  options.styles = m_styles;
  options.picture_height = double(first.area.height);
  render::Frame frame = view.frame(now.state, options);
  fit_to(first.area, frame);
  const bool scope = first.shows == PaneShows::endoscope || first.shows == PaneShows::second_scope;
  const render::Target part = window_target(first.area, m_stage.window.height());
  const bool copied = m_stage.size_elsewhere().width > 0 && !m_panes.canvas_elsewhere();
  m_stage.draw_scene(frame, part, scope, [this, part, first_eye = copied]() mutable {
    if (std::exchange(first_eye, false)) m_stage.first_pane.copy(part);
    m_panes.lay_others(m_stage.window.height(), m_stage.settings.mirrored_picture);
  });
  m_panes.write_over(layout().count() > 1);
}

/// For tests that drive the window: which panes there are, and where their cameras look.
void AttemptWindow::tell_views(const LayoutChoice& choice) {
  if (!m_stage.log.on()) return;
  Json panes = Json::array();
  for (const Panes::Pane& p : m_panes.panes())
    if (!p.elsewhere)
      panes.push_back({{"shows", name_of(p.shows)}, {"area", {p.area.x, p.area.y, p.area.width, p.area.height}}});
  const PaneCameras& cameras = m_panes.cameras;
  const Json line{{"layout", name_of(choice.layout)},      {"panes", panes},
                  {"outside_yaw", cameras.outside.yaw},    {"second_yaw", cameras.second.pose.yaw},
                  {"pressure", cameras.analysis.pressure}, {"solvers", cameras.analysis.solvers}};
  if (std::string text = line.dump(); text != m_told_views) {
    m_told_views = std::move(text);
    m_stage.log.event("views", line);
  }
}

void AttemptWindow::draw_scene(const attempt::Snapshot& now) {
  const Window& window = m_stage.window;
  const float panel = panel_width(float(window.width()), window.scale());
  const int width = std::max(1, window.width() - int(panel)), height = std::max(1, window.height());
  LayoutChoice choice = layout();
  m_panes.lay_out(choice, {0, 0, float(width), float(height)}, window.scale(), m_stage.size_elsewhere());
  m_panes.listen();
  m_stage.governor.load_becomes(m_panes.load());
  draw_panes(now);
  m_stage.show_elsewhere(choice, m_panes.canvas_elsewhere(),
                         choice.elsewhere ? m_panes.legend_of_pane(*choice.elsewhere) : view::Legend{});
  if (!choice.elsewhere) m_stage.settings.views.elsewhere.reset();
  if (m_stage.room) m_stage.room->show(m_lesson.model, now.state);
  tell_views(choice);
  draw_control_marks(now);
  ui::set_middle(float(width));
  const PanelContent content{
      m_lesson,
      now,
      m_pilot ? &m_pilot->hands() : nullptr,
      m_pilot && m_pilot->leads_both() ? &m_pilot->both() : nullptr,
      m_plan.input == "demo" ? tr("the demonstration") : m_plan.input,
      m_age.known() ? tr("{}, hand to picture {:.0f} ms", m_device.text, 1000 * m_age.smoothed()) : m_device.text,
      m_log.attempt().trainee,
      mode_text(),
      m_steps,
      m_feedback,
      stands_still(),
      m_gamepad_used && m_stage.window.gamepads().present(),
      device_in_use(),
      key_lines_now(now),
      now_seconds() < m_refusal_until ? m_refusal : std::string(),
      &details_open(),
      pull_limit(m_lesson),
      m_stage.settings.force_trace ? &m_feel : nullptr,
      outlook(now),
      m_crew.in_words()};
  draw_panel(content, float(width), panel, float(height));
  if (!m_told_waits.empty()) draw_waiting(m_told_waits, m_crew.how_to_join(), float(width), float(height));
  if (!stands_still()) draw_notices(m_feedback, now_seconds(), float(width), float(height));
}

void AttemptWindow::draw_over(const attempt::Snapshot& now, Choice& choice) {
  choice = Choice::none;  // what was chosen in the last picture has been done
  if (m_stage.overlay() != TrainerWindow::Overlay::none) return;
  const bool gamepad = m_stage.window.gamepads().present();
  if (m_over) {
    const std::string& person = m_log.attempt().trainee;
    choice = draw_result(
        {m_summary, mode_text(), is_reserved_name(person) ? std::string() : person, m_stage.options.store != nullptr,
         !m_log.attempt().recording.empty(), m_watch_failure.empty() ? m_stage.reports.say() : m_watch_failure},
        m_name_on_report);
  } else if (m_hint) {
    if (draw_hint(m_stage.equipment, gamepad, m_pilot->leads_both(), m_hint_again) == Choice::resume) {
      m_hint = false;
      m_stage.settings.show_hint = m_hint_again;
      m_stage.keep_settings();
    }
  } else if (m_display) {
    if (draw_display(m_stage.view_of(m_lesson).parts(), m_styles) || m_stage.window.keys().back) m_display = false;
  } else if (m_views) {
    if (draw_layout_panel(m_stage.settings.views, m_panes) || m_stage.window.keys().back) {
      m_views = false;
      m_stage.keep_settings();
    }
  } else if (m_paused) {
    choice =
        m_pause_menu.draw({m_why_paused, m_log.attempt().recording, counts(), !counts()}, m_stage.window.keys().back);
  } else if (m_rack) {
    draw_the_rack(now);
  }
  if (choice == Choice::resume) m_paused = false, m_why_paused.clear();
  if (choice == Choice::display) m_display = true;
  if (choice == Choice::views) m_views = true;
  if (choice == Choice::settings) m_stage.open(TrainerWindow::Overlay::settings);
  if (choice == Choice::help) m_stage.open(TrainerWindow::Overlay::help);
  if (choice == Choice::watch) m_watch = true;
  if (choice == Choice::report) m_stage.reports.open(m_stage.options.store, m_log.attempt().uuid, m_name_on_report);
}

void AttemptWindow::draw_the_rack(const attempt::Snapshot& now) {
  const Window& window = m_stage.window;
  const float picture = float(window.width()) - panel_width(float(window.width()), window.scale());
  const RackChoice c = draw_rack(m_lesson.model, now.state, m_pilot->both(), picture);
  if (c.hand != -2) m_pilot->choose(c.hand);
  if (c.instrument >= 0) m_pilot->take(c.instrument);
  if (c.panel_keys != 0) m_pilot->press(c.panel_keys);
  if (c.insert) m_pilot->insert();
  if (c.ratchet) m_pilot->toggle_ratchet();
  if (c.fine) m_pilot->toggle_fine();
  if (c.exchange) m_pilot->exchange();
  if (c.both) m_pilot->lead_both(!m_pilot->both().on);
  keep_mode();
  if (c.pause) hold("");
  if (c.close || c.instrument >= 0 || c.insert || c.ratchet || c.fine || c.exchange || c.both) m_rack = false;
}

void AttemptWindow::end(attempt::Live& live, Ending ending) {
  live.stop();
  tell(live);
  // Practice has no goal, so closing the window is its proper end.
  // So is closing it in the moment between the last step and the result.
  const bool left = ending == Ending::left && m_session.monitor() && !m_session.monitor()->finished();
  m_result = m_session.result(left);
  if (ending == Ending::finished_early && m_session.monitor() && !m_session.monitor()->finished()) {
    m_result["finished_early"] = true;
    if (m_result["passed"].is_boolean()) m_result["passed"] = false;
  }
  m_result["input"] = m_plan.input;
  m_result["slow_motion_share"] = live.slow_share();
  m_result.update(m_crew.source().describe());
  if (m_crew.team()) m_crew.team()->end(attempt::message::kFinished);
  if (m_age.known()) m_result["hand_to_picture_ms"] = {{"mean", 1000 * m_age.mean()}, {"most", 1000 * m_age.most()}};
  m_log.end(m_result, left ? AttemptState::aborted : AttemptState::finished);
  summarise_result();
  m_stage.log.event("end", {{"interrupted", left}, {"passed", m_result["passed"]}, {"ticks", m_result["ticks"]}});
  if (ending == Ending::came_to_its_end) m_stage.sound.play(Tone::finished);
  if (!m_log.attempt().recording.empty()) core::log::info("recording: {}", m_log.attempt().recording);
  m_over = true;
  m_rack = m_paused = m_hint = false;
}

/// The attempt's recording, from its start; then the result again.
void AttemptWindow::watch() {
  std::string failure;
  play_recording(m_stage, m_lesson, m_log.attempt().recording, false, failure);
  m_watch_failure = failure.empty() ? "" : tr("The recording cannot be shown: {}", failure);
  m_stage.window.set_title(window_title(m_lesson));
}

/// For the window that follows: with this person's earlier attempts, and what comes next.
void AttemptWindow::summarise_result() {
  training::Standing standing;
  if (m_stage.options.store && counts())
    standing = training::read_standing(*m_stage.options.store, m_log.attempt().trainee, m_lesson.name);
  m_summary = summarise(m_result, standing);
  if (!counts()) {  // a demonstration or practice: nobody passes or fails
    if (m_summary.verdict != ResultSummary::Verdict::simulation_failed)
      m_summary.verdict = ResultSummary::Verdict::no_score;
    m_summary.advice.clear();
    return;
  }
  const bool passed = m_summary.verdict == ResultSummary::Verdict::passed;
  m_summary.next = next_training(attempt::list_exercises(attempt::scenes_folder()), m_lesson.name, passed);
}

}  // namespace trocar::app
