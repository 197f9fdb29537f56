// Dialogues: what an operation needs to know, questions, faults, help.
#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <imgui.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/modeller/document/plain_words.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/json/json_text.hpp>

#include "modeller/chooser.hpp"
#include "modeller/modeller_parts.hpp"

namespace trocar::app {
namespace {

constexpr const char* kHelp[][2] = {
    {"Click", "Choose a body, or take a point of the chosen body and drag it"},
    {"Right drag, middle drag, wheel", "Turn, shift, zoom the view"},
    {"1 3 7 5", "View from the feet, from the side, from the front, from above the feet"},
    {"F or .", "Show all of the chosen body"},
    {"Ctrl-Alt-Q", "Four views, or one"},
    {"G R S", "Move, rotate, scale; then X Y Z for one axis, digits for an exact amount"},
    {"Enter or click; Esc or right click", "Keep it; take it back"},
    {"Ctrl, Shift while moving", "In whole steps; ten times finer"},
    {"O, then the wheel while moving", "Soft move: points near by move along; the wheel sets the radius"},
    {"I", "Insert a point after the one that was taken"},
    {"K", "Attach the chosen body where the pointer is"},
    {"B", "Paint on the chosen body: attachment, stiffness, bonds; Shift erases"},
    {"Shift-Tab", "Snap: what you move goes onto the body under the pointer"},
    {"H, Alt-H", "Hide the chosen body; show all"},
    {"Shift-D", "Duplicate, then move the copy"},
    {"X or Delete", "Delete the chosen point or body"},
    {"M", "Measure: click from place to place"},
    {"T", "Test drive: grasp bodies with the mouse and pull"},
    {"F5", "Operate: open the trainer on this scene"},
    {"Ctrl-Z, Ctrl-Shift-Z", "Undo, redo"},
    {"Ctrl-S, Ctrl-Shift-S, Ctrl-O", "Save, save as, open; or drop a file onto the window"},
    {"Esc", "Close the dialogue on top; end what is under way"},
    {"F1", "This list"}};

struct Title {
  const char *operation, *words;
};
constexpr Title kTitles[] = {{"ellipsoid", "Ball or ellipsoid"},
                             {"revolved", "Body of revolution"},
                             {"loft", "Body along a line"},
                             {"cord", "Tube or cord"},
                             {"vessel_tree", "Tree of vessels"},
                             {"branch", "Branch of a vessel"},
                             {"fold", "Membrane between a cord and an organ"},
                             {"bond_facing", "Bond a hollow organ to an organ"},
                             {"to_spline", "Convert to a NURBS surface"},
                             {"insert_knot", "Insert a knot"},
                             {"fit_spline", "Fit a NURBS surface to a file"},
                             {"hold", "Attach"},
                             {"fibres", "Fibres"},
                             {"port", "Port"},
                             {"tool", "Instrument"},
                             {"scope", "Endoscope"},
                             {"mark", "Mark"},
                             {"tilt", "Position of the patient"},
                             {"vary", "Patient variation"}};

std::string title_of(const std::string& operation) {
  for (const Title& t : kTitles)
    if (operation == t.operation) return tr(t.words);
  return modeller::label_of_key(operation);
}

/// Values that fields begin with.
struct Usual {
  const char *operation, *key, *value;  ///< operation "": any
};
constexpr Usual kUsual[] = {{"", "centre_mm", "0, -150, -110"},
                            {"", "half_mm", "18, 25, 18"},
                            {"hold", "radius_mm", "10"},
                            {"cord", "radius_mm", "2"},
                            {"", "radius_mm", "1.2"},
                            {"", "radii_mm", "6"},
                            {"", "flow_mL_min", "60"},
                            {"", "vessel", "trunk"},
                            {"vessel_tree", "file", "arteries.json"},
                            {"", "way", "along"},
                            {"", "at", "0.5"},
                            {"fibres", "ratio", "1.5"}};

std::string usual_value(const std::string& operation, const std::string& key) {
  for (const Usual& u : kUsual)
    if ((u.operation[0] == 0 || operation == u.operation) && key == u.key) return u.value;
  return {};
}

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

/// Every fault with its place; a press chooses the body that it is in.
void Modeller::draw_faults() {
  if (!m_built || m_built->built.faults.empty()) {
    m_faults = false;
    return;
  }
  ui::begin_middle("faults", 860);
  ui::title(tr("{} faults in the document", m_built->built.faults.size()));
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
  if (ui::button(tr("Close"), {.width = 120, .primary = true})) m_faults = false;
  ImGui::End();
}

void Modeller::draw_help() {
  ui::begin_middle("help", 760);
  ui::title(tr("Keys and mouse"));
  for (const auto& [keys, what] : kHelp) {
    ui::text(tr(keys), ui::kBlue);
    ImGui::SameLine(290 * ui::scale());
    ui::text(tr(what));
  }
  if (ui::button(tr("Close"), {.width = 120, .primary = true})) m_help = false;
  ImGui::End();
}

void Modeller::draw_questions() {
  if (m_question == Question::unsaved && m_document) ask_to_save();
  if (m_question == Question::save_and_operate && m_document) {
    ui::begin_middle("save and operate", 520);
    ui::title(tr("Save before you operate?"));
    ui::text(tr("The trainer opens the saved file."), ui::kGrey);
    const bool yes = ui::button(tr("Save and operate"), {.width = 190, .primary = true});
    ImGui::SameLine();
    if (ui::button(tr("Cancel"), {.width = 150})) m_question = Question::none, tell("");
    ImGui::End();
    if (yes) {
      m_question = Question::none;
      save();
      if (m_document->unsaved().empty()) start_trainer();
    }
  }
  if (m_question == Question::recover && !m_lost.empty()) ask_to_recover();
}

void Modeller::ask_to_save() {
  ui::begin_middle("unsaved", 520);
  ui::title(tr("Save your changes?"));
  if (m_untitled)
    ui::text(tr("This document has no name yet."), ui::kGrey);
  else
    for (const fs::path& file : m_document->unsaved()) ui::text(file.generic_string(), ui::kGrey);
  if (ui::button(tr("Save"), {.width = 150, .primary = true})) {
    m_question = Question::none;
    save();  // an untitled one asks for its name, and leaves after that
    if (!m_untitled && m_document->unsaved().empty() && m_after != After::none) leave();
  }
  ImGui::SameLine();
  if (ui::button(tr("Do not save"), {.width = 150})) {
    m_question = Question::none;
    m_drop_changes = true;
    leave();
  }
  ImGui::SameLine();
  if (ui::button(tr("Cancel"), {.width = 150})) m_question = Question::none, m_after = After::none;
  ImGui::End();
}

void Modeller::ask_to_recover() {
  ui::begin_middle("recover", 560);
  ui::title(tr("Recover unsaved work?"));
  ui::text(tr("The modeller ended before this was saved:"), ui::kGrey);
  ui::text(m_lost.front().root.generic_string(), ui::kGrey);
  const bool take = ui::button(tr("Recover"), {.width = 170, .primary = true});
  ImGui::SameLine();
  const bool drop = ui::button(tr("Discard"), {.width = 170});
  ImGui::SameLine();
  if (ui::button(tr("Later"), {.width = 120})) m_question = Question::none;
  ImGui::End();
  if (take) {
    const modeller::Lost lost = m_lost.front();
    m_question = Question::none;
    guarded([&] { recover(lost); });
  }
  if (drop) {
    std::error_code ignored;
    fs::remove(m_lost.front().file, ignored);
    m_lost.erase(m_lost.begin());
    if (m_lost.empty()) m_question = Question::none;
  }
}

void Modeller::recover(const modeller::Lost& lost) {
  this->take(std::make_unique<modeller::Document>(modeller::recovered(lost)));
  m_recovery = std::make_unique<modeller::Recovery>(lost.file.parent_path(), lost.root);
  m_is_recovered = true;
  tell(tr("Recovered. Save it to keep it."));
  m_log.event("recovered", {{"file", lost.root.generic_string()}});
}

/// A field for each of an operation's parameters.
void Modeller::draw_fields_of(const modeller::Operation& operation) {
  for (const scene::Key& key : operation.parameters.keys) {
    if (key.name == "file" && !key.required) continue;  // of the document: the scene's own
    std::string& value = m_asked[key.name];
    if (value.empty() && m_asked.count(key.name + "?") == 0) {  // what it usually is, once
      m_asked[key.name + "?"] = "1";
      value = usual_value(m_adding, key.name);
      const bool place = m_adding == "port" || m_adding == "mark";
      if (key.name == "name")
        value = free_name(place || m_adding == "cord" ? m_adding : m_adding == "branch" ? "vessel" : "organ");
      if (key.name == "tissue") value = "uterus";
      if (key.name == "of" && !m_selected.empty()) value = m_selected.substr(m_selected.find(':') + 1);
    }
    ui::text(modeller::label_of_key(key.name), key.required ? ui::kWhite : ui::kGrey);
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("%s", ui::wrapped(tr(key.meaning.c_str()), 400 * ui::scale()).c_str());
    ImGui::SameLine(230 * ui::scale());
    ImGui::SetNextItemWidth(-1);
    const std::string id = "##" + key.name;
    if (key.name == "tissue") {
      draw_tissue_list("##ask tissue", tissues(), value);
    } else if (key.name == "look") {
      draw_material_list("##ask look", value);
    } else if (key.type == scene::Key::Type::flag) {
      bool on = value == "yes";
      if (ImGui::Checkbox(id.c_str(), &on)) value = on ? "yes" : "";
    } else if (!key.choices.empty()) {
      if (ImGui::BeginCombo(id.c_str(), value.empty() ? tr("automatic") : value.c_str())) {
        for (const std::string& choice : key.choices)
          if (ImGui::Selectable(choice.c_str(), choice == value)) value = choice;
        ImGui::EndCombo();
      }
    } else {
      char text[512];
      std::snprintf(text, sizeof text, "%s", value.c_str());
      if (ImGui::InputTextWithHint(id.c_str(), key.required ? "" : tr("automatic"), text, sizeof text)) value = text;
    }
    ui::note_widget("ask " + key.name);
  }
}

/// Asks for an operation's parameters, and does it.
void Modeller::draw_adding() {
  const modeller::Operation* operation = modeller::find_operation(m_adding);
  if (!operation) return m_adding.clear();
  ui::begin_middle("adding", 640);
  ui::title(title_of(m_adding));
  ui::text(tr(operation->parameters.meaning.c_str()), ui::kGrey);
  draw_fields_of(*operation);
  ui::text(m_is_error ? m_message : " ", ui::kOrange);  // its place is always there: buttons do not move
  const bool done = ui::button(tr("Add"), {.width = 140, .primary = true});
  ImGui::SameLine();
  if (ui::button(tr("Cancel"), {.width = 140})) m_adding.clear();
  ImGui::End();
  if (done && !m_adding.empty()) do_adding(*operation);
}

void Modeller::do_adding(const modeller::Operation& operation) {
  scene::JsonValue s = scene::json_object();
  scene::put(s, "do", scene::json_text(m_adding));
  for (const scene::Key& key : operation.parameters.keys)
    if (const std::string& value = m_asked[key.name]; !value.empty()) scene::put(s, key.name, typed_value(key, value));
  tell("");
  if (!step(std::move(s))) return;
  const std::string name = m_asked["name"];
  m_things = modeller::outline(*m_document);
  m_things_of = m_document->version();
  for (const modeller::Thing& t : m_things)
    if (t.name == name && t.kind != "tissue") select(t.kind + ":" + t.name);
  if (m_message.empty()) tell(name.empty() ? tr("Done: {}", title_of(m_adding)) : tr("Added: {}", name));
  m_adding.clear();
}

}  // namespace trocar::app
