// Keys, as editors of shapes have them.
#include <algorithm>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <trocar/core/error.hpp>
#include <trocar/scene/json/json_text.hpp>

#include "modeller/modeller_parts.hpp"

namespace trocar::app {

void Modeller::listen() {
  if (m_window.keys().help) m_help = !m_help;
  for (const std::string& path : m_window.dropped()) {
    const std::string ending = fs::path(path).extension().string();
    if (m_document && std::find(kBodyFiles.begin(), kBodyFiles.end(), ending) != kBodyFiles.end()) {
      ask_for_body("from_file", path);
      continue;
    }
    if (m_document && ending != ".json") {
      m_scan.open(path);
      m_scan_shown = true;
      continue;
    }
    m_to_open = path;
    m_after = After::open;
    leave();
  }
  const bool typing = ImGui::GetIO().WantTextInput;
  if (typing || m_files.is_open() || m_question != Question::none || !m_adding.empty()) {
    if (m_window.keys().back) m_files.close(), m_adding.clear();
    return;
  }
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
    if (key == GLFW_KEY_S && shift) {
      m_file_for = FileFor::save_as;
      m_files.open("Save as", "Save", m_document->root(), {".json"});
    }
    if (key == GLFW_KEY_O) {
      m_file_for = FileFor::open;
      m_files.open("Open a scene or an organ", "Open", m_document->root().parent_path(), {".json"});
    }
    if (key == GLFW_KEY_Q && !alt) m_after = After::quit, leave();
    return;
  }
  if (scan_shown()) return;
  if (key == GLFW_KEY_T) toggle_drive();
  if (key == GLFW_KEY_ESCAPE) {
    if (m_help)
      m_help = false;
    else if (m_brush.on)
      toggle_brush();
    else if (m_drive)
      toggle_drive();
    else if (m_measuring)
      m_measuring = false, m_measured.clear();
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
    m_snap = !m_snap, tell(m_snap ? "snap: onto the body under the pointer" : "snap is off");
  if (key == GLFW_KEY_H && alt) m_hidden.clear(), ++m_picture;
  if (key == GLFW_KEY_H && !alt)
    if (const std::optional<modeller::Thing> chosen = selected()) m_hidden.insert(chosen->name), ++m_picture;
  if (key == GLFW_KEY_G) begin_gesture(Gesture::Kind::move);
  if (key == GLFW_KEY_R) begin_gesture(Gesture::Kind::rotate);
  if (key == GLFW_KEY_S) begin_gesture(Gesture::Kind::scale);
  if (key == GLFW_KEY_O) m_soft = !m_soft, tell(m_soft ? "soft: points near by go along" : "soft is off");
  const std::optional<modeller::Thing> thing = selected();
  if ((key == GLFW_KEY_X || key == GLFW_KEY_DELETE) && thing) {
    scene::JsonValue s = scene::json_object();
    const bool one = m_handle.has_value();
    put(s, "do", scene::json_text(one ? "remove_point" : "delete"));
    put(s, "of", one ? scene::json_text(m_selected) : scene::json_array({scene::json_text(m_selected)}));
    if (one) put(s, "key", scene::json_text(m_handle->list.substr(1)));
    if (one) put(s, "item", scene::json_number(double(m_handle->item)));
    if (step(std::move(s))) {
      tell(one ? "point removed" : "deleted " + thing->name);
      if (!one) m_selected.clear();
      m_handle.reset();
    }
  }
  if (key == GLFW_KEY_D && shift && thing) {
    scene::JsonValue s = scene::json_object();
    const std::string name = free_name(thing->name + "_copy");
    put(s, "do", scene::json_text("duplicate"));
    put(s, "of", scene::json_text(m_selected));
    put(s, "as", scene::json_text(name));
    if (step(std::move(s))) {
      m_things = modeller::outline(*m_document);
      m_things_of = m_document->version();
      select(thing->kind + ":" + name);
      begin_gesture(Gesture::Kind::move);
    }
  }
  if (key == GLFW_KEY_I && m_handle) {  // a point more before the one that was taken
    scene::JsonValue s = scene::json_object();
    put(s, "do", scene::json_text("insert_point"));
    put(s, "of", scene::json_text(m_selected));
    put(s, "key", scene::json_text(m_handle->list.substr(1)));
    put(s, "before", scene::json_number(double(m_handle->item + 1)));
    if (step(std::move(s))) tell("point put in");
  }
}

}  // namespace trocar::app
