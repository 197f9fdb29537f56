// Keys, as editors of shapes have them.
#include <algorithm>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/scene/json/json_text.hpp>

#include "modeller/modeller_parts.hpp"

namespace trocar::app {

/// Is a dialogue open? Then keys and clicks belong to it.
bool Modeller::asks() const {
  return m_scan.asks() || m_files.is_open() || m_question != Question::none || m_help || m_faults ||
         m_import.is_open() || m_checks || !m_adding.empty() || m_trainer_status.has_value();
}

/// Esc closes the dialogue on top. False: none is open.
bool Modeller::close_top() {
  if (m_scan.asks())
    m_scan.end_choice();
  else if (m_files.is_open())
    m_files.close(), m_file_for = FileFor::none, m_after = After::none;
  else if (m_question != Question::none)
    m_question = Question::none, m_after = After::none;
  else if (m_help)
    m_help = false;
  else if (m_trainer_status)
    m_trainer_status.reset();
  else if (m_checks)
    m_checks = false, tell("");
  else if (m_import.is_open())
    m_import.close();
  else if (!m_adding.empty())
    m_adding.clear();
  else if (m_faults)
    m_faults = false;
  else
    return false;
  return true;
}

void Modeller::take_dropped(const std::string& path) {
  const std::string ending = fs::path(path).extension().string();
  if (ending == ".json") {
    m_to_open = path;
    m_after = After::open;
    return leave();
  }
  if (!m_document) begin_scene();
  if (!m_document) return;
  if (std::find(kBodyFiles.begin(), kBodyFiles.end(), ending) != kBodyFiles.end())
    return ask_for_body("from_file", path);
  m_scan.open(path);
  m_scan_shown = true;
}

void Modeller::listen() {
  if (m_window.keys().help && (m_help || !asks())) m_help = !m_help;
  for (const std::string& path : m_window.dropped()) guarded([&] { take_dropped(path); });
  const bool escape = std::any_of(m_window.typed().begin(), m_window.typed().end(),
                                  [](const TypedKey& k) { return k.key == GLFW_KEY_ESCAPE; });
  if (asks()) {
    if (escape || m_window.keys().back) close_top();
    return;
  }
  if (ImGui::GetIO().WantTextInput) return;
  for (const TypedKey& k : m_window.typed()) {
    if (m_gesture)
      obey_key_of_gesture(k.key);
    else
      obey_key(k.key, k.mods);
  }
}

void Modeller::obey_key_of_gesture(int key) {
  Gesture& g = *m_gesture;
  if (key == GLFW_KEY_ESCAPE) return end_gesture(false);
  if (key == GLFW_KEY_ENTER || key == GLFW_KEY_KP_ENTER) {
    preview_gesture();  // digits typed since the last picture count
    return end_gesture(true);
  }
  if (key >= GLFW_KEY_X && key <= GLFW_KEY_Z) g.axis = g.axis == key - GLFW_KEY_X ? -1 : key - GLFW_KEY_X;
  if (key >= GLFW_KEY_0 && key <= GLFW_KEY_9) g.typed += char('0' + key - GLFW_KEY_0);
  if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9) g.typed += char('0' + key - GLFW_KEY_KP_0);
  if (key == GLFW_KEY_PERIOD || key == GLFW_KEY_KP_DECIMAL) g.typed += '.';
  if ((key == GLFW_KEY_MINUS || key == GLFW_KEY_KP_SUBTRACT) && g.typed.empty()) g.typed += '-';
  if (key == GLFW_KEY_BACKSPACE && !g.typed.empty()) g.typed.pop_back();
  if (key == GLFW_KEY_O) m_soft = !m_soft;
}

void Modeller::obey_key(int key, int mods) {
  if (key == GLFW_KEY_TAB && !(mods & GLFW_MOD_SHIFT) && m_scan.shows()) m_scan_shown = !m_scan_shown;
  if (m_scan.shows() && scan_shown() && m_scan.obey_key(key, mods)) return;
  if (!m_draw_for.empty()) {
    if (key == GLFW_KEY_ENTER || key == GLFW_KEY_KP_ENTER) end_drawing(true);
    if (key == GLFW_KEY_ESCAPE) end_drawing(false);
    if (key == GLFW_KEY_BACKSPACE && !m_drawn.empty()) m_drawn.pop_back();
    return;
  }
  const bool control = mods & GLFW_MOD_CONTROL, shift = mods & GLFW_MOD_SHIFT, alt = mods & GLFW_MOD_ALT;
  if (!m_document) return;
  if (control) {
    if (alt && key == GLFW_KEY_Q) m_four = !m_four, ++m_picture;
    if (key == GLFW_KEY_Z) shift ? redo() : undo();
    if (key == GLFW_KEY_Y) redo();
    if (key == GLFW_KEY_S && !shift) save();
    if (key == GLFW_KEY_S && shift) ask_for_file(FileFor::save_as);
    if (key == GLFW_KEY_O) ask_for_file(FileFor::open);
    if (key == GLFW_KEY_Q && !alt) m_after = After::quit, leave();
    return;
  }
  if (scan_shown()) return;
  if (key == GLFW_KEY_T) toggle_drive();
  if (key == GLFW_KEY_ESCAPE) {
    if (m_brush.on)
      toggle_brush();
    else if (m_drive)
      toggle_drive();
    else if (m_measuring)
      m_measuring = false, m_measured.clear();
    else if (m_handle)
      m_handle.reset();
    else
      select("");
  }
  if (key == GLFW_KEY_F5) operate();
  if (key == GLFW_KEY_KP_1 || key == GLFW_KEY_1) look_from(1);
  if (key == GLFW_KEY_KP_3 || key == GLFW_KEY_3) look_from(2);
  if (key == GLFW_KEY_KP_7 || key == GLFW_KEY_7) look_from(3);
  if (key == GLFW_KEY_KP_5 || key == GLFW_KEY_5) look_from(0);
  if (key == GLFW_KEY_PERIOD || key == GLFW_KEY_KP_DECIMAL || key == GLFW_KEY_F) frame_selected();
  if (key == GLFW_KEY_M) m_measuring = !m_measuring, m_measured.clear();
  if (m_drive) return;
  if (key == GLFW_KEY_K) hold_here();
  if (key == GLFW_KEY_B) toggle_brush();
  if (key == GLFW_KEY_TAB && shift)
    m_snap = !m_snap,
    tell(m_snap ? tr("Snap on: what you move goes onto the body under the pointer.") : tr("Snap off."));
  if (key == GLFW_KEY_H && alt) m_hidden.clear(), ++m_picture;
  if (key == GLFW_KEY_H && !alt)
    if (const std::optional<modeller::Thing> chosen = selected()) m_hidden.insert(chosen->name), ++m_picture;
  if (key == GLFW_KEY_G) begin_gesture(Gesture::Kind::move);
  if (key == GLFW_KEY_R) begin_gesture(Gesture::Kind::rotate);
  if (key == GLFW_KEY_S) begin_gesture(Gesture::Kind::scale);
  if (key == GLFW_KEY_O)
    m_soft = !m_soft, tell(m_soft ? tr("Soft move on: points near by move along.") : tr("Soft move off."));
  const std::optional<modeller::Thing> thing = selected();
  if ((key == GLFW_KEY_X || key == GLFW_KEY_DELETE) && thing) {
    scene::JsonValue s = scene::json_object();
    const bool one = m_handle.has_value();
    scene::put(s, "do", scene::json_text(one ? "remove_point" : "delete"));
    scene::put(s, "of", one ? scene::json_text(m_selected) : scene::json_array({scene::json_text(m_selected)}));
    if (one) scene::put(s, "key", scene::json_text(m_handle->list.substr(1)));
    if (one) scene::put(s, "item", scene::json_number(double(m_handle->item)));
    if (step(std::move(s))) {
      tell(one ? std::string(tr("Point removed.")) : tr("Deleted: {}", thing->name));
      if (!one) m_selected.clear();
      m_handle.reset();
    }
  }
  if (key == GLFW_KEY_D && shift && thing) {
    scene::JsonValue s = scene::json_object();
    const std::string name = free_name(thing->name + "_copy");
    scene::put(s, "do", scene::json_text("duplicate"));
    scene::put(s, "of", scene::json_text(m_selected));
    scene::put(s, "as", scene::json_text(name));
    if (step(std::move(s))) {
      m_things = modeller::outline(*m_document);
      m_things_of = m_document->version();
      select(thing->kind + ":" + name);
      begin_gesture(Gesture::Kind::move);
    }
  }
  if (key == GLFW_KEY_I && m_handle) {  // a point more before the one that was taken
    scene::JsonValue s = scene::json_object();
    scene::put(s, "do", scene::json_text("insert_point"));
    scene::put(s, "of", scene::json_text(m_selected));
    scene::put(s, "key", scene::json_text(m_handle->list.substr(1)));
    scene::put(s, "before", scene::json_number(double(m_handle->item + 1)));
    if (step(std::move(s))) tell(tr("Point inserted."));
  }
}

}  // namespace trocar::app
