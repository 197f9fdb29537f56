#include "modeller/modeller.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <unistd.h>

#include <trocar/attempt/interrupt.hpp>
#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/text.hpp>
#include <trocar/modeller/document/home.hpp>
#include <trocar/scene/json/json_text.hpp>

#include "modeller/modeller_parts.hpp"
#include "shell/open_window.hpp"
#include "shell/panes.hpp"
#include "shell/settings.hpp"

namespace trocar::app {
namespace {

constexpr double kBusyRate = 62, kCalmRate = 30;  // [pictures/s] at most
constexpr float kLeft = 220, kRight = 340, kBottom = 58;
constexpr std::size_t kRecent = 10;

fs::path modeller_folder() { return attempt::data_folder() / "modeller"; }
fs::path unsaved_folder() { return modeller_folder() / "unsaved"; }
fs::path segments_folder() { return modeller_folder() / "segments"; }
fs::path untitled_folder() { return modeller_folder() / "untitled"; }

std::vector<fs::path> read_recent() {
  std::vector<fs::path> out;
  std::vector<core::Fault> ignored;
  const scene::JsonDocument read = scene::load_json(modeller_folder() / "recent.json", ignored);
  for (const scene::JsonValue& v : read.root.items)
    if (v.kind == scene::JsonValue::Kind::string && out.size() < kRecent) out.emplace_back(v.text);
  return out;
}

}  // namespace

Modeller::Modeller(Window& window, const ModellerOptions& options, EventLog& log)
    : m_window(window),
      m_options(options),
      m_log(log),
      m_context(render::GlContext::adopt_current()),
      m_backend(render::make_gl_backend(*m_context)),
      m_governor(render::Governor::Limits{}, render::first_level(m_context->draws_on_processors())),
      m_recent(read_recent()) {
  const char* names[] = {"free", "front", "side", "top"};
  for (std::size_t i = 0; i < m_views.size(); ++i) m_views[i].name = names[i];
  m_lost = modeller::lost_in(unsaved_folder());
  if (!m_lost.empty()) m_question = Question::recover;
  m_files.set_recent(m_recent);
  m_lost_segments = lost_segments(segments_folder());
}

void Modeller::open(const fs::path& file) {
  take(std::make_unique<modeller::Document>(modeller::Document::open(file)));
  remember_file(m_document->root());
  m_log.event("opened", {{"file", m_document->root().generic_string()}});
}

/// Takes it in place of the one that is open.
void Modeller::take(std::unique_ptr<modeller::Document> document) {
  if (m_drive) toggle_drive();
  forget_untitled();
  m_document = std::move(document);
  m_untitled = m_document->root().parent_path().parent_path() == modeller::whole_path(untitled_folder());
  m_recovery = std::make_unique<modeller::Recovery>(unsaved_folder(), m_document->root());
  m_builder.forget();
  m_selected.clear();
  m_handle.reset();
  m_things_of = m_handles_of = m_findings_of = m_tissues_of = ~0ull;
  m_built.reset();
  m_view.reset();
  m_shown.reset();
  m_state.reset();
  m_places.clear();
  m_wants_operate = m_checks = m_scan_shown = m_is_recovered = false;
  m_window.set_title(m_untitled ? std::string(tr("Trocar: untitled"))
                                : tr("Trocar: {}", m_document->root().filename().string()));
  tell("");
}

/// A new document: named when it is saved for the first time.
void Modeller::begin(modeller::Document document) {
  m_to_begin = std::make_unique<modeller::Document>(std::move(document));
  m_after = After::begin;
  leave();
}

/// Where a document without a name is until it has one: what it imports lies beside it.
fs::path Modeller::untitled_file() const {
  for (int i = 1;; ++i) {
    const fs::path folder = untitled_folder() / fmt::format("{}-{}", getpid(), i);
    std::error_code error;
    if (!fs::exists(folder, error)) {
      fs::create_directories(folder, error);
      return folder / "untitled.json";
    }
  }
}

void Modeller::forget_untitled() {
  if (!m_document || !m_untitled) return;
  std::error_code ignored;
  fs::remove_all(m_document->root().parent_path(), ignored);
  m_untitled = false;
}

bool Modeller::needs_saving() const {
  if (!m_document || m_drop_changes) return false;
  return m_untitled ? m_document->done() > 0 || m_is_recovered : !m_document->unsaved().empty();
}

void Modeller::remember_file(const fs::path& file) {
  m_recent.erase(std::remove(m_recent.begin(), m_recent.end(), file), m_recent.end());
  m_recent.insert(m_recent.begin(), file);
  if (m_recent.size() > kRecent) m_recent.resize(kRecent);
  std::vector<scene::JsonValue> items;
  for (const fs::path& f : m_recent) items.push_back(scene::json_text(f.generic_string()));
  const std::string text = scene::to_text(scene::json_array(std::move(items)));
  std::error_code ignored;
  fs::create_directories(modeller_folder(), ignored);
  core::write_file(modeller_folder() / "recent.json", text.data(), text.size(), 0600);
  m_files.set_recent(m_recent);
}

void Modeller::run() {
  while (!m_quit && !attempt::interrupted()) {
    if (m_window.wants_to_close()) {
      m_window.stay_open();
      m_after = After::quit;
      leave();
      if (m_quit) break;
    }
    picture();
  }
  if (needs_saving() && m_recovery) m_recovery->keep(*m_document);  // an interrupt loses nothing
}

/// What was wanted after the document, once nothing is lost by it.
void Modeller::leave() {
  if (needs_saving()) {
    m_question = Question::unsaved;
    return;
  }
  m_drop_changes = false;
  if (m_recovery) m_recovery->forget();
  const After after = std::exchange(m_after, After::none);
  if (after == After::quit) {
    ScanDesk::forget(segments_folder());
    forget_untitled();
    m_quit = true;
  }
  if (after == After::start) {
    forget_untitled();
    m_view.reset();
    m_shown.reset();
    m_recovery.reset();
    m_document.reset();
  }
  if (after == After::open) guarded([this] { open(m_to_open); });
  if (after == After::begin && m_to_begin) {
    take(std::move(m_to_begin));
    m_log.event("begun", {{"file", m_document->root().generic_string()}});
  }
}

void Modeller::lay_out() {
  const float scale = m_window.scale(), width = float(m_window.width()), height = float(m_window.height());
  const float left = std::floor(std::min(kLeft * scale, 0.3f * width)),
              right = std::floor(std::min(kRight * scale, 0.4f * width));
  const float bottom = std::floor(kBottom * scale);
  m_left = {0, m_bar, left, height - m_bar - bottom};
  m_right = {width - right, m_bar, right, height - m_bar - bottom};
  m_middle = {left, m_bar, std::max(1.0f, width - left - right), std::max(1.0f, height - m_bar - bottom)};
  m_bottom = {0, height - bottom, width, bottom};
  const float w = std::floor(m_middle.width / 2), h = std::floor(m_middle.height / 2);
  for (std::size_t i = 0; i < m_views.size(); ++i) {
    Area& a = m_views[i].area;
    if (m_four)  // top | free / front | side
      a = {m_middle.x + (i == 0 || i == 2 ? w : 0), m_middle.y + (i == 1 || i == 2 ? h : 0), w, h};
    else
      a = int(i) == m_active ? m_middle : Area{};
  }
}

void Modeller::take_what_is_built() {
  if (!m_document) return;
  if (!m_gesture || !m_gesture->dragged || !m_builder.busy()) m_builder.want(*m_document);
  std::unique_ptr<BuiltDocument> built = m_builder.poll();
  if (!built) return;
  m_findings = built->built.findings;
  m_findings_of = built->built.version;
  m_log.event("built", {{"good", built->built.good()},
                        {"seconds", built->built.seconds},
                        {"faults", built->built.faults.size()},
                        {"bodies", built->read_outs.size()}});
  if (built->built.good() && !m_drive) {
    const bool first = m_places.empty();  // the first bodies are looked at
    m_view.reset();
    m_shown = std::move(built);
    m_view = std::make_unique<view::SceneView>(*m_shown->built.model, *m_backend);
    m_state = sim::initial_state(*m_shown->built.model);
    m_places = modeller::places_of(*m_shown->built.model, *m_state);
    ++m_picture;
    m_built.reset();
    if (!first && std::exchange(m_frame_when_built, false)) frame_selected();
    if (first) {
      m_frame_when_built = false;
      frame_selected();
      for (int i = 0; i < 4; ++i) m_active = i, look_from(i);
      m_active = 0;
    }
  } else {
    m_built = std::move(built);
  }
}

/// At most a second after a change it lies where a crash leaves it.
void Modeller::keep_unsaved() {
  m_scan.keep(segments_folder());
  const auto now = std::chrono::steady_clock::now();
  if (!needs_saving() || !m_recovery || now - m_kept < std::chrono::seconds(1)) return;
  m_kept = now;
  const std::string said = m_recovery->keep(*m_document);
  if (!said.empty()) warn(tr("Changes that are not saved would be lost in a crash: {}", said));
}

void Modeller::picture() {
  const bool busy = m_drive || m_gesture || ImGui::IsAnyMouseDown();
  m_window.set_picture_rate(busy ? kBusyRate : kCalmRate);
  m_window.begin_picture();
  try {
    draw_all();
  } catch (const std::exception& failed) {  // nothing that is done in the window ends it
    ImGui::ErrorCheckEndFrameRecover(nullptr);
    recover_from(failed.what());
  }
  m_window.draw_panels();
  m_window.show();
  log_widgets();
}

/// Something failed that nobody had thought of: the document is kept, and what was under way is given up.
void Modeller::recover_from(const std::string& why) {
  m_gesture.reset();
  m_previewed = false;
  m_draw_for.clear();
  m_drawn.clear();
  m_brush = {};
  warn(tr("This could not be done: {}", why));
  m_log.event("failed", {{"said", why}});
}

void Modeller::draw_all() {
  lay_out();
  take_what_is_built();
  listen();
  if (m_drive) drive_on();
  watch_trainer();
  if (m_document) {
    if (m_things_of != m_document->version()) {
      m_things = modeller::outline(*m_document);
      m_things_of = m_document->version();
    }
    continue_operating();
    if (scan_shown()) {
      draw_scan();
    } else {
      draw_views();
      if (!asks()) point();
      draw_properties();
      draw_over_views();
    }
    draw_menu_bar();
    if (m_document) {
      draw_outline();
      draw_status();
    }
  } else {
    draw_start();
  }
  draw_dialogues();
  keep_unsaved();
}

void Modeller::draw_dialogues() {
  if (m_document) {
    if (m_faults) draw_faults();
    if (!m_adding.empty()) draw_adding();
    if (m_import.is_open()) draw_import();
    draw_brush_panel();
    if (m_checks) draw_checks();
  }
  if (m_trainer_status) draw_trainer_report();
  if (m_help) draw_help();
  m_scan.draw_choice();
  draw_questions();
  fs::path chosen;
  if (!m_files.is_open()) return;
  if (m_files.draw(chosen))
    take_file(chosen);
  else if (!m_files.is_open())  // cancelled, and what was to follow with it
    m_after = After::none;
}

void Modeller::log_widgets() {
  const std::vector<ui::Widget> widgets = ui::take_widgets();
  if (!m_log.on()) return;
  Json points = Json::array();
  for (const modeller::Handle& h : m_handles.points)
    if (const std::optional<modeller::Spot> s = m_views[std::size_t(m_active)].spot(h.at))
      points.push_back({int(s->x), int(s->y)});
  if (widgets == m_widgets && points == m_logged_points) return;
  m_widgets = widgets;
  m_logged_points = points;
  Json gizmo = Json::object();
  for (const auto& [word, spot] : gizmo_spots(m_gizmo, m_views[std::size_t(m_active)])) gizmo[word] = {spot.x, spot.y};
  Json places = Json::object();
  for (const ui::Widget& w : widgets) places[w.id] = {w.x, w.y};
  const Area& a = m_views[std::size_t(m_active)].area;
  m_log.event("screen", {{"name", !m_document    ? "start"
                                  : scan_shown() ? "scan"
                                                 : "modeller"},
                         {"view", {a.x, a.y, a.width, a.height}},
                         {"selected", m_selected},
                         {"points", points},
                         {"gizmo", gizmo},
                         {"widgets", places}});
}

bool Modeller::step(scene::JsonValue step) {
  return guarded([&] {
    const scene::JsonMember* name = step.find("do");
    const modeller::Operation* operation = name ? modeller::find_operation(name->value.text) : nullptr;
    if (!operation) throw std::invalid_argument(tr("There is no such operation."));
    scene::JsonValue parameters = step;
    parameters.members.erase(parameters.members.begin());
    const std::string said = modeller::apply(*operation, parameters, "here", *m_document);
    if (!said.empty()) tell(said);
    if (m_log.on() && !m_previewed) m_log.event("step", {{"do", operation->parameters.name}});
  });
}

bool Modeller::set_key(const std::string& path, const scene::JsonValue& value) {
  scene::JsonValue s = scene::json_object();
  scene::put(s, "do", scene::json_text("set"));
  if (!m_selected.empty()) scene::put(s, "of", scene::json_text(m_selected));
  scene::put(s, "key", scene::json_text(path));
  scene::put(s, "value", value);
  return step(std::move(s));
}

void Modeller::select(const std::string& thing) {
  if (m_selected == thing) return;
  m_selected = thing;
  m_handle.reset();
  m_handles_of = ~0ull;
}

std::optional<modeller::Thing> Modeller::selected() const {
  for (const modeller::Thing& t : m_things)
    if (t.kind + ":" + t.name == m_selected) return t;
  return std::nullopt;
}

void Modeller::undo() {
  const std::size_t done = m_document->done();
  if (m_document->undo())
    tell(tr("Undone: {}", m_document->history()[done - 1].name));
  else
    tell(tr("There is nothing to undo."));
}
void Modeller::redo() {
  const std::size_t done = m_document->done();
  if (m_document->redo())
    tell(tr("Done again: {}", m_document->history()[done].name));
  else
    tell(tr("There is nothing to redo."));
}

std::string Modeller::free_name(const std::string& stem) const {
  for (int i = 1;; ++i) {
    const std::string name = i == 1 ? stem : fmt::format("{}_{}", stem, i);
    if (std::none_of(m_things.begin(), m_things.end(), [&](const modeller::Thing& t) { return t.name == name; }))
      return name;
  }
}

void Modeller::toggle_drive() {
  if (m_drive) {
    m_drive.reset();
    m_taking = false;
    if (m_shown) m_state = sim::initial_state(*m_shown->built.model);
    if (m_shown) m_places = modeller::places_of(*m_shown->built.model, *m_state);
    ++m_picture;
    tell("");
    return;
  }
  if (!m_shown) return warn(tr("There is nothing to try yet. Add an organ first (Add, or File > Import)."));
  m_drive = std::make_unique<modeller::TestDrive>(*m_shown->built.model);
  m_drive_debt = 0;
  tell(m_drive->hand() < 0 ? tr("Test drive without a grasper: this scene has none. Press T to end it.")
                           : tr("Test drive: press on a body and pull. Press T to end it."));
}

/// So many ticks as time has passed, as far as the machine gets: slow motion where it is too slow.
void Modeller::drive_on() {
  using Clock = std::chrono::steady_clock;
  constexpr double kMost = 0.02;  // [s] of a picture's time
  m_drive_debt = std::min(m_drive_debt + m_window.picture_time(), 0.1);
  const Clock::time_point until = Clock::now() + std::chrono::microseconds(int(1e6 * kMost));
  while (m_drive_debt >= sim::kTick && Clock::now() < until) {
    m_drive->tick();
    m_drive_debt -= sim::kTick;
  }
  m_state = m_drive->state();
  ++m_picture;
  if (m_drive->holds() != m_held) {
    m_held = m_drive->holds();
    m_log.event("drive", {{"holds", m_held}});
  }
}

void run_modeller(const ModellerOptions& options) {
  std::vector<core::Fault> ignored;
  const Settings settings = read_settings(settings_file(), ignored);
  if (!options.file.empty()) modeller::Document::open(options.file);  // a wrong name is reported before a window opens
  Window window = open_window(tr("Trocar: modeller"), options.size,
                              tr("The modeller without a window: trocar model --script FILE"));
  window.set_text_size(settings.text_size);
  EventLog log(EventLog::path_of(options.log));
  attempt::catch_interrupts();
  Modeller modeller(window, options, log);
  if (!options.file.empty()) modeller.open(options.file);
  modeller.run();
  if (!log.failure().empty()) throw core::EnvironmentLacks(log.failure());
}

}  // namespace trocar::app
