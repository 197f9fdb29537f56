// What stands around the views: menus, the list of things, what is told, questions, help.
#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <imgui.h>

#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/json/json_text.hpp>

#include "modeller/modeller_parts.hpp"

namespace trocar::app {
namespace {

bool item(const char* label, const char* keys = nullptr, bool on = false, bool enabled = true) {
  const bool pressed = ImGui::MenuItem(label, keys, on, enabled);
  ui::note_widget(label);
  return pressed;
}

bool menu(const char* label) {
  const bool open = ImGui::BeginMenu(label);
  ui::note_widget(std::string("menu ") + label);
  return open;
}

void begin_panel(const char* name, const Area& area) {
  ImGui::SetNextWindowPos({area.x, area.y});
  ImGui::SetNextWindowSize({area.width, area.height});
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoBringToFrontOnFocus);
}

constexpr const char* kHelp[][2] = {
    {"click", "choose a body, or take a point of the chosen one and drag it"},
    {"right drag, middle drag, wheel", "turn, shift, come closer"},
    {"1 3 7 5", "from the feet, from the side, from the front, from before and above"},
    {"F or .", "all of what is chosen in the picture"},
    {"Ctrl-Alt-Q", "four views, or one"},
    {"G R S", "move, rotate, scale; then X Y Z for one axis, digits for exactly so much"},
    {"Enter or click; Esc or right click", "keep it; take it back"},
    {"Ctrl, Shift while moving", "in whole steps; ten times finer"},
    {"O, then the wheel while moving", "points near by go along; how far"},
    {"I", "a point more behind the one that was taken"},
    {"K", "the chosen body is held where the pointer is"},
    {"B", "paint on the chosen body: what holds it, stiffness, bonds; Shift rubs out"},
    {"Shift-Tab", "snap: what is moved goes onto the body under the pointer"},
    {"H, Alt-H", "hide the chosen one; show all again"},
    {"Shift-D", "a copy, which then moves"},
    {"X or Delete", "take away the point or the thing that is chosen"},
    {"M", "measure: click from place to place"},
    {"T", "test drive: take bodies with the mouse and pull"},
    {"F5", "operate: the trainer opens on what is saved"},
    {"Ctrl-Z, Ctrl-Shift-Z", "undo, redo, without end"},
    {"Ctrl-S, Ctrl-Shift-S, Ctrl-O", "save, save as, open; or drop a file onto the window"},
    {"F1", "this"}};

}  // namespace

void Modeller::draw_menu_bar() {
  if (!ImGui::BeginMainMenuBar()) return;
  if (menu("File")) {
    if (item("New scene ...")) {
      m_file_for = FileFor::new_scene;
      m_files.open("Where the new scene is kept", "Create", m_document->root().parent_path(), {".json"});
    }
    if (item("New organ ...")) {
      m_file_for = FileFor::new_organ;
      m_files.open("Where the new organ is kept", "Create", m_document->root().parent_path(), {".json"});
    }
    if (item("Open ...", "Ctrl-O")) {
      m_file_for = FileFor::open;
      m_files.open("Open a scene or an organ", "Open", m_document->root().parent_path(), {".json"});
    }
    if (item("Save", "Ctrl-S", false, !m_document->unsaved().empty())) save();
    if (item("Save as ...", "Ctrl-Shift-S")) {
      m_file_for = FileFor::save_as;
      m_files.open("Save as", "Save", m_document->root(), {".json"});
    }
    ImGui::Separator();
    if (item("Start screen")) m_after = After::start, leave();
    if (item("Quit", "Ctrl-Q")) m_after = After::quit, leave();
    ImGui::EndMenu();
  }
  if (menu("Edit")) {
    const std::size_t done = m_document->done();
    const std::string last = done > 0 ? "Undo " + m_document->history()[done - 1].name : "Undo";
    if (ImGui::MenuItem(last.c_str(), "Ctrl-Z", false, done > 0)) undo();
    ui::note_widget("Undo");
    if (item("Redo", "Ctrl-Shift-Z", false, done < m_document->history().size())) redo();
    if (item("History", nullptr, m_history)) m_history = !m_history;
    ImGui::Separator();
    if (item("Soft", "O", m_soft)) m_soft = !m_soft;
    if (item("Both sides", nullptr, m_symmetric)) m_symmetric = !m_symmetric;
    if (item("Snap to bodies", "Shift-Tab", m_snap)) m_snap = !m_snap;
    if (item("Paint on the chosen one", "B", m_brush.on)) toggle_brush();
    if (item("Measure", "M", m_measuring)) m_measuring = !m_measuring, m_measured.clear();
    ImGui::EndMenu();
  }
  if (menu("Add")) {
    static constexpr std::pair<const char*, const char*> kDrawn[] = {{"Draw a tube or cord", "cord"},
                                                                     {"Draw a body along a line", "loft"},
                                                                     {"Draw a tree of vessels", "vessel_tree"},
                                                                     {"Draw a branch of the chosen vessel", "branch"},
                                                                     {"Draw fibres on the chosen one", "fibres"}};
    for (const auto& [label, operation] : kDrawn)
      if (item(label)) {
        m_draw_for = operation;
        m_drawn.clear();
        tell("click from place to place: on bodies, or in the air; Enter when that is it, Esc for none");
      }
    ImGui::Separator();
    static constexpr std::pair<const char*, const char*> kAsked[] = {
        {"Ball or ellipsoid ...", "ellipsoid"},
        {"Body of revolution ...", "revolved"},
        {"Fold from a cord to an organ ...", "fold"},
        {"Bonds of a pouch ...", "bond_facing"},
        {"Make a NURBS of the chosen one ...", "to_spline"},
        {"Knot into the chosen one ...", "insert_knot"},
        {"Hold the chosen one ...", "hold"},
        {"Fibres of the chosen one ...", "fibres"}};
    for (const auto& [label, operation] : kAsked)
      if (item(label)) m_adding = operation, m_asked.clear();
    ImGui::Separator();
    for (const auto& [label, operation] :
         {std::pair{"Body from a file ...", "from_file"}, std::pair{"Fit to a mesh from a file ...", "fit_spline"}})
      if (item(label)) {
        m_file_for = FileFor::body;
        m_draw_for.clear();
        m_body_by = operation;
        m_files.open(operation == std::string("from_file") ? "A body from a file" : "A mesh to fit a NURBS to", "Take",
                     m_document->root().parent_path(), {kBodyFiles.begin(), kBodyFiles.end()});
      }
    ImGui::EndMenu();
  }
  if (menu("Scene")) {
    static constexpr std::pair<const char*, const char*> kPlaced[] = {{"Port here ...", "port"},
                                                                      {"Instrument with its tip here ...", "tool"},
                                                                      {"Scope with its tip here ...", "scope"},
                                                                      {"Mark here ...", "mark"}};
    for (const auto& [label, operation] : kPlaced)
      if (item(label)) {
        m_draw_for = operation;
        m_drawn.clear();
        tell("click where: on a body, or in the air; Esc for nowhere");
      }
    ImGui::Separator();
    if (item("How the patient lies ...")) m_adding = "tilt", m_asked.clear();
    if (item("What another patient has otherwise ...")) m_adding = "vary", m_asked.clear();
    ImGui::EndMenu();
  }
  if (menu("Scan")) {
    draw_scan_menu();
    ImGui::EndMenu();
  }
  if (menu("View")) {
    if (item("All of it", "F")) frame_selected();
    if (item("From the feet", "1")) look_from(1);
    if (item("From the side", "3")) look_from(2);
    if (item("From the front", "7")) look_from(3);
    if (item("From before and above", "5")) look_from(0);
    if (item("Hide the chosen one", "H", false, !m_selected.empty()))
      if (const std::optional<modeller::Thing> chosen = selected()) m_hidden.insert(chosen->name), ++m_picture;
    if (item("Show all", "Alt-H", false, !m_hidden.empty())) m_hidden.clear(), ++m_picture;
    if (item("Instruments", nullptr, m_instruments)) m_instruments = !m_instruments, ++m_picture;
    if (item("Four views", "Ctrl-Alt-Q", m_four)) m_four = !m_four, ++m_picture;
    ImGui::EndMenu();
  }
  if (menu("Help")) {
    if (item("Keys", "F1")) m_help = true;
    ImGui::EndMenu();
  }
  ImGui::SetCursorPosX(ImGui::GetWindowWidth() - 330 * ui::scale());
  if (ImGui::SmallButton(m_drive ? "End test drive (T)" : "Test drive (T)")) toggle_drive();
  ui::note_widget("Test drive");
  ImGui::SameLine(0, 12 * ui::scale());
  ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(0.10f, 0.40f, 0.58f, 1));
  if (ImGui::SmallButton("Operate (F5)")) operate();
  ImGui::PopStyleColor();
  ui::note_widget("Operate");
  m_bar = ImGui::GetWindowHeight();
  ImGui::EndMainMenuBar();
}

void Modeller::draw_outline() {
  begin_panel("things", m_left);
  std::string kind;
  for (const modeller::Thing& t : m_things) {
    if (t.kind == "tissue" || t.kind == "instrument") continue;
    if (t.kind != kind) ui::heading(t.kind + "s");
    kind = t.kind;
    const std::string id = t.kind + ":" + t.name;
    if (ImGui::Selectable((t.name + "##" + id).c_str(), id == m_selected)) select(id);
    ui::note_widget(id);
  }
  if (m_things.empty()) ui::text("Nothing yet. Add: a ball, a tube, a vessel ...", ui::kGrey);
  if (m_history) {
    ui::heading("history");
    for (std::size_t i = 0; i < m_document->history().size(); ++i) {
      const bool past = i < m_document->done();
      const std::string label = fmt::format("{}##h{}", m_document->history()[i].name, i);
      if (ImGui::Selectable(label.c_str(), i + 1 == m_document->done())) {
        while (m_document->done() > i + 1) m_document->undo();
        while (m_document->done() < i + 1) m_document->redo();
      }
      if (!past) {
        ImGui::SameLine();
        ui::text("(undone)", ui::kGrey);
      }
    }
  }
  ImGui::End();
}

void Modeller::draw_status() {
  begin_panel("status", m_bottom);
  const std::size_t unsaved = m_document->unsaved().size();
  std::string line = m_message;
  if (line.empty())
    line = "click: choose   right drag: turn   G R S: move, rotate, scale   T: test drive   F1: all keys";
  ui::text(ui::shortened(line, m_bottom.width - 20));
  std::string state = m_document->root().filename().string();
  if (unsaved > 0) state += " (not saved)";
  if (m_builder.busy()) state += "   compiling ...";
  const std::vector<core::Fault>* faults = m_built ? &m_built->built.faults : nullptr;
  if (faults && !faults->empty()) {
    ui::mark(ui::Mark::error);
    const core::Fault& f = faults->front();
    ui::text(ui::shortened(fmt::format("{}:{}: {}{}", fs::path(f.at.file).filename().string(), f.at.line, f.message,
                                       faults->size() > 1 ? fmt::format("  (and {} more)", faults->size() - 1) : ""),
                           m_bottom.width - 160),
             ui::kOrange);
    ImGui::SameLine(m_bottom.width - 110 * ui::scale());
    if (ImGui::SmallButton("All of them")) m_faults = true;
    ui::note_widget("All of them");
  } else if (m_shown && !m_shown->built.notes.empty()) {
    ui::mark(ui::Mark::warning);
    ui::text(m_shown->built.notes.front(), ui::kOrange);
  } else {
    ui::text(state, ui::kGrey);
  }
  ImGui::End();
}

/// Every fault with its place; a press chooses the thing that it is in.
void Modeller::draw_faults() {
  if (!m_built || m_built->built.faults.empty()) {
    m_faults = false;
    return;
  }
  ui::begin_middle("faults", 860);
  ui::title(fmt::format("{} faults", m_built->built.faults.size()));
  ImGui::BeginChild("faults", {0, 380 * ui::scale()}, true);
  for (std::size_t i = 0; i < m_built->built.faults.size(); ++i) {
    const core::Fault& f = m_built->built.faults[i];
    const std::string text = ui::wrapped(core::to_string(f), 800 * ui::scale());
    if (!ImGui::Selectable(fmt::format("{}##f{}", text, i).c_str())) continue;
    for (const modeller::Thing& t : m_things)  // the last one that begins before it
      if (t.file == modeller::whole_path(f.at.file) && t.line <= f.at.line) select(t.kind + ":" + t.name);
    m_faults = false;
  }
  ImGui::EndChild();
  if (ui::button("Close", {.width = 120, .primary = true})) m_faults = false;
  ImGui::End();
}

void Modeller::draw_start() {
  ui::begin_screen("start");
  ui::title("Trocar: modeller");
  ui::text("Shape an organ, or open a scene, and operate on it a minute later.", ui::kGrey);
  ImGui::Spacing();
  std::error_code ignored;
  if (ui::button("New scene", {.width = 220, .primary = true})) {
    m_file_for = FileFor::new_scene;
    m_files.open("Where the new scene is kept", "Create", fs::current_path(ignored) / "my_scene.json", {".json"});
  }
  ImGui::SameLine();
  if (ui::button("New organ", {.width = 220})) {
    m_file_for = FileFor::new_organ;
    m_files.open("Where the new organ is kept", "Create", fs::current_path(ignored) / "my_organ.json", {".json"});
  }
  ImGui::SameLine();
  if (ui::button("Open ...", {.width = 220})) {
    m_file_for = FileFor::open;
    m_files.open("Open a scene or an organ", "Open", attempt::scenes_folder(), {".json"});
  }
  if (!m_message.empty()) ui::text(m_message, ui::kOrange);
  ImGui::Spacing();
  if (!m_recent.empty()) ui::heading("recent");
  fs::path wanted;
  for (const fs::path& file : m_recent)
    if (ImGui::Selectable(file.generic_string().c_str())) wanted = file;
  ui::heading("scenes that come with it");
  for (const scene::SceneEntry& s : scene::list_scenes(attempt::scenes_folder())) {
    if (ImGui::Selectable((s.name + "   " + s.title).c_str())) wanted = s.path;
    ui::note_widget("scene " + s.name);
  }
  ImGui::End();
  if (wanted.empty()) return;
  m_to_open = wanted;
  m_after = After::open;
  leave();
}

void Modeller::draw_help() {
  ui::begin_middle("help", 760);
  ui::title("Keys and mouse");
  for (const auto& [keys, what] : kHelp) {
    ui::text(keys, ui::kBlue);
    ImGui::SameLine(290 * ui::scale());
    ui::text(what);
  }
  if (ui::button("Close", {.width = 120, .primary = true})) m_help = false;
  ImGui::End();
}

void Modeller::draw_questions() {
  if (m_question == Question::unsaved) {
    ui::begin_middle("unsaved", 520);
    ui::title("Some changes are not saved");
    for (const fs::path& file : m_document->unsaved()) ui::text(file.generic_string(), ui::kGrey);
    if (ui::button("Save", {.width = 150, .primary = true})) {
      m_question = Question::none;
      save();
      if (m_document->unsaved().empty()) leave();
    }
    ImGui::SameLine();
    if (ui::button("Do not save", {.width = 150})) {
      m_question = Question::none;
      while (m_document->undo()) {
      }
      leave();
    }
    ImGui::SameLine();
    if (ui::button("Cancel", {.width = 150})) m_question = Question::none, m_after = After::none;
    ImGui::End();
  }
  if (m_question == Question::recover && !m_lost.empty()) {
    ui::begin_middle("recover", 560);
    ui::title("Something was not saved when the modeller ended");
    ui::text(m_lost.front().root.generic_string(), ui::kGrey);
    const bool take = ui::button("Recover it", {.width = 170, .primary = true});
    ImGui::SameLine();
    const bool drop = ui::button("Throw it away", {.width = 170});
    ImGui::SameLine();
    if (ui::button("Later", {.width = 120})) m_question = Question::none;
    ImGui::End();
    if (take) {
      const modeller::Lost lost = m_lost.front();
      try {
        std::error_code error;
        if (fs::is_regular_file(lost.root, error)) open(lost.root);
        m_document = std::make_unique<modeller::Document>(modeller::recovered(lost));
        m_builder.forget();
        m_things_of = m_handles_of = ~0ull;
        m_recovery = std::make_unique<modeller::Recovery>(lost.file.parent_path(), lost.root);
        tell("recovered: save it to keep it");
        m_log.event("recovered", {{"file", lost.root.generic_string()}});
      } catch (const core::BadInput& bad) {
        tell(bad.what());
      }
      m_question = Question::none;
    }
    if (drop) {
      std::error_code ignored;
      fs::remove(m_lost.front().file, ignored);
      m_lost.erase(m_lost.begin());
      if (m_lost.empty()) m_question = Question::none;
    }
  }
}

namespace {

/// What was typed, as the file would say it: numbers and lists as they are, all else a text.
scene::JsonValue typed_value(const scene::Key& key, const std::string& text) {
  using Type = scene::Key::Type;
  if (key.type == Type::text || key.type == Type::name) return scene::json_text(text);
  if (key.type == Type::flag) return scene::json_flag(text == "yes");
  std::vector<core::Fault> faults;
  const bool list = key.type == Type::vec3 || key.type == Type::texts || key.type == Type::points;
  const bool bare = list && text.find('[') == std::string::npos;
  std::string json = bare ? "[" + text + "]" : text;
  if (key.type == Type::texts && bare) {
    json = "[";
    std::istringstream words(text);
    for (std::string word; std::getline(words, word, ',');) {
      word.erase(0, word.find_first_not_of(' '));
      json += (json.size() > 1 ? ", \"" : "\"") + word + "\"";
    }
    json += "]";
  }
  scene::JsonDocument read = scene::parse_json(json, "here", faults);
  return faults.empty() ? std::move(read.root) : scene::json_text(text);
}

}  // namespace

/// Asks for an operation's parameters, and does it.
void Modeller::draw_adding() {
  const modeller::Operation* operation = modeller::find_operation(m_adding);
  if (!operation) return m_adding.clear();
  ui::begin_middle("adding", 620);
  ui::title(operation->parameters.meaning);
  for (const scene::Key& key : operation->parameters.keys) {
    if (key.name == "file" && !key.required) continue;  // of the document: the scene's own
    std::string& value = m_asked[key.name];
    if (value.empty() && m_asked.count(key.name + "?") == 0) {  // what it usually is, once
      m_asked[key.name + "?"] = "1";
      if (key.name == "name")
        value = free_name(m_adding == "cord" ? "cord" : m_adding == "branch" ? "vessel" : "organ");
      if (m_adding == "port" && key.name == "name") value = free_name("port");
      if (m_adding == "mark" && key.name == "name") value = free_name("mark");
      if (m_adding == "fibres" && key.name == "ratio") value = "1.5";
      if (key.name == "tissue") value = "uterus";
      if (key.name == "centre_mm") value = "0, -150, -110";
      if (key.name == "half_mm") value = "15, 25, 15";
      if (key.name == "radius_mm") value = m_adding == "hold" ? "10" : m_adding == "cord" ? "2" : "1.2";
      if (key.name == "radii_mm") value = "6";
      if (key.name == "flow_mL_min") value = "60";
      if (key.name == "vessel") value = "trunk";
      if (key.name == "file" && m_adding == "vessel_tree") value = "arteries.json";
      if (key.name == "way") value = "along";
      if (key.name == "at") value = "0.5";
      if (key.name == "of" && !m_selected.empty()) value = m_selected.substr(m_selected.find(':') + 1);
    }
    ui::text(key.name + (key.required ? "" : " (may be left out)"), key.required ? ui::kWhite : ui::kGrey);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", key.meaning.c_str());
    ImGui::SameLine(230 * ui::scale());
    ImGui::SetNextItemWidth(-1);
    if (key.type == scene::Key::Type::flag) {
      bool on = value == "yes";
      if (ImGui::Checkbox(("##" + key.name).c_str(), &on)) value = on ? "yes" : "";
    } else {
      char text[512];
      std::snprintf(text, sizeof text, "%s", value.c_str());
      if (ImGui::InputTextWithHint(("##" + key.name).c_str(), key.meaning.c_str(), text, sizeof text)) value = text;
    }
    ui::note_widget("ask " + key.name);
  }
  if (!m_message.empty()) ui::text(m_message, ui::kOrange);
  const bool done = ui::button("Add", {.width = 140, .primary = true});
  ImGui::SameLine();
  if (ui::button("Cancel", {.width = 140})) m_adding.clear();
  ImGui::End();
  if (!done || m_adding.empty()) return;
  scene::JsonValue s = scene::json_object();
  put(s, "do", scene::json_text(m_adding));
  for (const scene::Key& key : operation->parameters.keys)
    if (const std::string& value = m_asked[key.name]; !value.empty()) put(s, key.name, typed_value(key, value));
  m_message.clear();
  if (!step(std::move(s))) return;
  const std::string name = m_asked["name"];
  m_things = modeller::outline(*m_document);
  m_things_of = m_document->version();
  for (const modeller::Thing& t : m_things)
    if (t.name == name && t.kind != "tissue") select(t.kind + ":" + t.name);
  if (m_message.empty()) tell(m_adding + " " + name);
  m_adding.clear();
}

}  // namespace trocar::app
